import type { EdgeCheck } from '@knead/generated';
import { type CheckAsked, Checker, type CheckReply } from '@studio/engine/checker';
import { errorOf } from '@studio/engine/session_types';

/** A worker that is answered by the test. */
class Played {
  onmessage: ((event: MessageEvent<CheckReply>) => void) | null = null;
  onerror: ((event: { message: string; preventDefault(): void }) => void) | null = null;
  asked: CheckAsked[] = [];
  ended = false;
  postMessage(message: CheckAsked): void {
    this.asked.push(message);
  }
  terminate(): void {
    this.ended = true;
  }
  reply(answer: { answer: EdgeCheck } | { error: ReturnType<typeof errorOf> }): void {
    this.onmessage!({ data: { id: this.asked.at(-1)!.id, ...answer } } as MessageEvent<CheckReply>);
  }
}

describe('the engine that measures edges', () => {
  const workers: Played[] = [];
  const checker = () => new Checker(() => {
    workers.push(new Played());
    return workers.at(-1) as never as Worker;
  });
  const report = { passed: true } as EdgeCheck;
  const file = new Uint8Array(4), other = new Uint8Array(4);
  beforeEach(() => void (workers.length = 0));

  it('is started once, and is given a file once', async () => {
    const it = checker();
    expect(workers).toEqual([]); // before anything is asked
    const first = it.check(file, 'x.step', {});
    workers[0]!.reply({ answer: report });
    expect(await first).toBe(report);
    void it.check(file, 'x.step', { class: 'a' });
    workers[0]!.reply({ answer: report });
    void it.check(other, 'x.step', {});
    expect(workers[0]!.asked.map((a) => a.file)).toEqual([file, null, other]);
    expect(workers[0]!.asked[1]).toMatchObject({ name: 'x.step', request: { class: 'a' } });
    expect(workers.length).toBe(1);
  });

  it('is given a file again after an error, which may be that of reading it', async () => {
    const it = checker();
    const refused = it.check(file, 'x.step', {});
    workers[0]!.reply({ error: errorOf('input', 'it is no file', '') });
    await expect(refused).rejects.toThrow('it is no file');
    void it.check(file, 'x.step', {});
    expect(workers[0]!.asked.map((a) => a.file)).toEqual([file, file]);
    expect(workers[0]!.ended).toBe(false);
  });

  it('is another one after it has trapped', async () => {
    const it = checker();
    const lost = it.check(file, 'x.step', {});
    workers[0]!.reply({ error: errorOf('internal', 'unreachable', '') });
    await expect(lost).rejects.toThrow('unreachable');
    expect(workers[0]!.ended).toBe(true);
    void it.check(file, 'x.step', {});
    expect(workers[1]!.asked.map((a) => a.file)).toEqual([file]);
  });

  it('refuses what it was asked for when it is ended', async () => {
    const it = checker();
    const waiting = it.check(file, 'x.step', {});
    it.end();
    await expect(waiting).rejects.toThrow('stopped');
    expect(workers[0]!.ended).toBe(true);
    const more = it.check(file, 'x.step', {});
    workers[1]!.onerror!({ message: 'it cannot be loaded', preventDefault: () => undefined });
    await expect(more).rejects.toThrow('it cannot be loaded');
    expect(workers[1]!.asked[0]!.file).toBe(file);
  });
});
