import type { Request } from './protocol';
import type { Command } from './session_types';

/** Commands that the engine has been given at once. */
export type Act = Extract<Request, { kind: 'execute' }>;

/**
 * Commands after which every shape, and what is saved of it, is as before. Not among them: what holds or frees edges of faces,
 * which decides whether they go along; `evolve`, which may run; `remove`, after which a plastic shape yields.
 */
const shapeless = new Set<Command['do']>(['select', 'lock', 'material', 'pin', 'freeze', 'load', 'limit', 'measure', 'move', 'turn', 'scale', 'edit_tool']);

/**
 * What the engine has done since the last copy of the session: an engine that goes on from that copy does it again. Steps of
 * playing are not among it: they end what can be repeated.
 */
export class Acts {
  /** Counts everything that can be in a copy. */
  mark = 0;
  /** Counts what may have changed a shape. */
  shapes = 0;
  /** Something was done that may have changed a shape; it was drawn before. */
  readonly onShapes: (() => void)[] = [];
  private since: { mark: number; act: Act | null }[] = [];
  private lost: typeof this.since | null = null;

  /** A request was answered; what failed has changed nothing, and fails again. */
  settled(request: Request, done: boolean): void {
    const shaping = request.kind === 'execute' && request.commands.some((c) => !shapeless.has(c.do));
    if (shaping) ++this.shapes;
    if (request.kind === 'execute') this.since.push({ mark: ++this.mark, act: request });
    else if (done && ['open', 'fresh', 'restore'].includes(request.kind)) this.since = []; // another session
    if (shaping) for (const tell of this.onShapes) tell();
  }

  gap(): void {
    ++this.shapes;
    if (this.since.at(-1)?.act !== null) this.since.push({ mark: ++this.mark, act: null });
    else this.since.at(-1)!.mark = ++this.mark;
  }

  /** A copy with everything up to this mark is safe. */
  kept(mark: number): void {
    const later = (all: typeof this.since) => all.filter((each) => each.mark > mark);
    this.since = later(this.since);
    this.lost &&= later(this.lost);
  }

  /** The engine is gone. Where that happens while another one repeats, nothing is repeated any more. */
  lose(): void {
    this.lost = this.lost ? [{ mark: ++this.mark, act: null }] : this.since;
    this.since = [];
  }

  /** What is to be done again after the last copy, and whether that is all. */
  get toRepeat(): { acts: Act[]; all: boolean } {
    const lost = this.lost ?? [];
    const end = lost.findIndex(({ act }) => act === null);
    return { acts: lost.slice(0, end < 0 ? lost.length : end).flatMap(({ act }) => act ?? []), all: end < 0 };
  }

  /** It has been done again. */
  repeated(): void {
    this.lost = null;
  }
}
