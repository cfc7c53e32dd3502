import type { SnakeClient } from './client';

/** What the page knows of a moment, and the number under which the worker keeps the snakes of it. */
interface Moment<T> {
  what: T;
  kept: Promise<number>;
}

/** Moments before what was done, each as it is to be again. */
export class Past<T> {
  private undone: Moment<T>[] = [];
  private done: Moment<T>[] = [];
  private last: Promise<unknown> = Promise.resolve();

  /** `now`: what the page knows; `most`: moments that are kept, each with the snakes of it. */
  constructor(private readonly client: SnakeClient, private readonly now: () => T, private readonly most = 50) {}

  get undo(): boolean {
    return this.done.length > 0;
  }

  get redo(): boolean {
    return this.undone.length > 0;
  }

  /** Of another image: the worker has forgotten all. */
  clear(): void {
    this.done = [];
    this.undone = [];
  }

  /** Does something when everything that was asked for before is done. */
  next<R>(act: () => Promise<R>): Promise<R> {
    const done = this.last.then(act);
    this.last = done.catch(() => undefined);
    return done;
  }

  /** Does something that can be taken back, unless it says that it did not happen. */
  entry(act: () => Promise<boolean>): Promise<boolean> {
    const done = this.enter(act);
    this.last = Promise.allSettled([this.last, done]);
    return done;
  }

  private async enter(act: () => Promise<boolean>): Promise<boolean> {
    const moment = this.moment();
    if (!(await act())) {
      this.forget([moment]);
      return false;
    }
    this.done.push(moment);
    this.forget([...this.undone.splice(0), ...this.done.splice(0, this.done.length - this.most)]);
    return true;
  }

  /** One step back, or forth again; null if there is none. Those that are asked for together follow each other. */
  travel(back: boolean, take: (what: T) => Promise<void>): Promise<void> {
    return this.next(async () => {
      const [from, to] = back ? [this.done, this.undone] : [this.undone, this.done];
      const moment = from.pop();
      if (!moment) return;
      const what = this.now(), restored = this.client.ask({ kind: 'restore', kept: await moment.kept });
      to.push({ what, kept: restored.then(({ kept }) => kept!) });
      await restored;
      this.forget([moment]);
      await take(moment.what);
    });
  }

  private moment(): Moment<T> {
    const kept = this.client.ask({ kind: 'keep' }).then((result) => result.kept!);
    kept.catch(() => undefined); // whoever needs it meets the error
    return { what: this.now(), kept };
  }

  private forget(moments: Moment<T>[]): void {
    if (moments.length > 0) void Promise.all(moments.map((m) => m.kept)).then((kept) => this.client.ask({ kind: 'forget', kept })).catch(() => undefined);
  }
}
