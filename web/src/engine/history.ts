import type { Engine } from './engine';
import { type Command, EngineError, type SessionInfo } from './session_types';

/** Goes through the history instead of adding to it: nothing can be joined with it. */
const travels = (command: Command) => command.do === 'undo' || command.do === 'redo';

/** What may leave everything as it was; all that these can change is in a `Mark`. */
function mayChangeNothing(command: Command): boolean {
  if (command.do === 'material') return !command.region && !command.coefficient;
  return ['step', 'evolve', 'load', 'hold', 'select', 'limit', 'seams'].includes(command.do);
}

/** The session as far as settings and steps can change it. */
interface Mark {
  settings: string;
  points: Float64Array[];
}

const equal = (a: Mark, b: Mark): boolean =>
  a.settings === b.settings && a.points.length === b.points.length &&
  a.points.every((p, k) => p.length === b.points[k]!.length && p.every((x, i) => Object.is(x, b.points[k]![i])));

/**
 * The session's history as a user sees it. Undo goes no further back than the opened document, acts that change nothing are
 * no entries, and an act that fails half-way leaves nothing behind.
 */
export class History {
  /** Commands that belong to the opened document. */
  opened = 0;
  private undoable = 0; // entries since the opening
  private redoable = 0;

  constructor(private readonly engine: Engine) {}

  /** The document is opened: what stands now cannot be undone. */
  begin(): void {
    this.opened = this.count();
    this.undoable = this.redoable = 0;
  }

  /** Finds its place in a restored session. `opened`: how many of its commands belong to the opened document. */
  resume(opened: number): void {
    const ahead = this.travel('redo', Infinity);
    this.travel('undo', ahead);
    const behind = this.travel('undo', Infinity);
    let floor = 0;
    while (floor < behind && this.count() < opened) floor += this.travel('redo', 1);
    this.opened = this.count();
    this.undoable = this.travel('redo', behind - floor);
    this.redoable = ahead;
  }

  state(): SessionInfo {
    return { ...this.engine.state(), undo: this.undoable > 0, redo: this.redoable > 0 };
  }

  /**
   * One act: with `join` it also belongs to the entry before. Without, a failure takes all of it back. With `keep` it is an
   * entry even if it changes nothing.
   */
  execute(commands: readonly Command[], join = false, keep = false): void {
    const depth = this.undoable;
    const before = !join && !keep && commands.length > 0 && commands.every(mayChangeNothing) ? this.mark() : null;
    try {
      for (const [k, command] of commands.entries()) this.one(command, k === 0 ? join : !travels(commands[k - 1]!));
    } catch (error) {
      if (!join && error instanceof EngineError) this.dropTo(depth);
      throw error;
    }
    if (before) this.dropUnchanged(before);
  }

  /** Takes the last entry away if the session is as it was at the mark. */
  dropUnchanged(before: Mark): void {
    if (this.undoable > 0 && equal(before, this.mark())) this.dropTo(this.undoable - 1);
  }

  mark(): Mark {
    // What a step or the history itself writes down is no change.
    const { steps: _, last: _last, undo: _undo, redo: _redo, notes: _notes, ...settings } = this.engine.state();
    return { settings: JSON.stringify(settings), points: settings.selection.map((k) => this.engine.controlPoints(k)) };
  }

  private one(command: Command, join: boolean): void {
    if (command.do === 'undo' && this.undoable === 0) throw nothingTo('undo');
    if (command.do === 'redo' && this.redoable === 0) throw nothingTo('redo');
    const joined = join && !travels(command) && this.undoable > 0; // never with the opened document
    this.engine.execute(command, joined);
    const by = command.do === 'undo' ? -1 : command.do === 'redo' || !joined ? 1 : 0;
    this.undoable += by;
    this.redoable = travels(command) ? this.redoable - by : 0;
  }

  /** The engine could do again what is dropped; the user cannot. */
  private dropTo(depth: number): void {
    while (this.undoable > depth) {
      this.engine.execute({ do: 'undo' });
      --this.undoable;
      this.redoable = 0;
    }
  }

  /** Up to `most` steps through the engine's history; gives back how many there were. */
  private travel(way: 'undo' | 'redo', most: number): number {
    for (let k = 0; k < most; ++k) {
      try {
        this.engine.execute({ do: way });
      } catch (error) {
        if (error instanceof EngineError) return k;
        throw error;
      }
    }
    return most;
  }

  private count(): number {
    return (JSON.parse(this.engine.journal()) as { commands: unknown[] }).commands.length;
  }
}

function nothingTo(way: 'undo' | 'redo'): EngineError {
  const what = `there is nothing to ${way}`;
  return new EngineError({ kind: 'input', what, where: '', remedy: '', message: what });
}
