import { defineCommands, defineQueries, type Working } from './commands.js';
import { packedAs, packedLike, unpackedName } from './compressed.js';
import { Engine } from './engine.js';
import { KneadError, kneadError } from './errors.js';
import {
  type AnyCommand, type BodyInfo, type BucklingInfo, type CommandMethods, type DisplayInfo, fileFormats, type FixInfo, type NoteInfo, type Picture, type PictureRequest, type QueryMethods,
  type SessionInfo, type StepInfo, type SurfaceInfo, type VibrationInfo,
} from './generated.js';

/** What commands have made of a document, as `knead sculpt --report` writes it. Lengths in file units, times in seconds. */
export interface Report {
  steps: Omit<StepInfo, 'surface'>[];
  time: number;
  energy_before: number | null;
  energy_after: number | null;
  residual: number;
  largest_displacement: number;
  control_points_moved: number;
  /** Of each surface that moved: its edges, how they are held, and how far it is from them. */
  edges: Record<string, unknown>[];
  places: { surface: string; part: string; places: number }[];
  seams: { a: string; b: string; continuity: string; gap: number; reason: string }[];
  notes: string[];
  coded_notes?: NoteInfo[];
  modes?: VibrationInfo[];
  buckling?: BucklingInfo[];
  /** Readings of `measure`, in the lists that it names. */
  [list: string]: unknown;
}

/** A document at one moment, with its file and its history: plain data, which can be stored and posted. */
export interface Snapshot {
  name: string;
  unit: string;
  file: Uint8Array | null;
  /** The file as it was compressed. */
  packed: Uint8Array | null;
  opening: number;
  session: Uint8Array;
}

/** A script's text or object, a list of commands, or one of an error's fixes. */
export type Script = string | { knead: number; commands: readonly AnyCommand[] } | readonly AnyCommand[] | FixInfo;

/** How a file of another format is written. */
export interface FileOptions {
  schema?: 'ap214' | 'ap242';
  /** Of triangles from faces, file units; 0 or left out: a two-thousandth of the model's diagonal. */
  tolerance?: number;
  /** Of triangles of files without faces: lines per direction of each surface. */
  detail?: number;
}

/** The numbers of a surface at one moment. Control point (i, j) is number i net[1] + j, three numbers each. */
export interface SurfaceShape {
  degree: [number, number];
  net: [number, number];
  knots: [Float64Array, Float64Array];
  /** null: all are 1. */
  weights: Float64Array | null;
  controlPoints: Float64Array;
}

/** How a surface is drawn (`doc.displays` names the displays). */
export type PictureOptions = Omit<PictureRequest, 'surface'>;

const historyBytes = 1e9;

/** A surface of a document: what it returns is of the moment in which it is asked. */
export class Surface {
  constructor(private readonly document: Document, readonly id: string, readonly label: string, readonly unit: string) {}

  private get number(): number {
    const found = this.document.state.surfaces.findIndex(({ id }) => id === this.id);
    if (found < 0) throw kneadError('input', 'it is not in the document any more', 'see doc.surfaces', this.id);
    return found;
  }

  get info(): SurfaceInfo {
    return this.document.state.surfaces[this.number]!;
  }

  /** Three numbers each, in the order of `net`. */
  get controlPoints(): Float64Array {
    return this.document.ask((engine) => engine.query('control_points', { surface: this.number }));
  }

  get shape(): SurfaceShape {
    const { degree, net, knots_u, knots_v, weights, points } = this.document.ask((engine) => engine.query('surface', { surface: this.number }));
    return { degree, net, knots: [knots_u, knots_v], weights: weights.length > 0 ? weights : null, controlPoints: points };
  }

  /** A grid of points to draw, with normals, knot lines and the values of a display, as buffers. */
  picture(options: PictureOptions = {}): Picture {
    return this.document.ask((engine) => engine.query('picture', { surface: this.number, ...options }));
  }
}

/** Where a document comes from. */
export type Beginning = { file: Uint8Array; packed: Uint8Array | null; name: string } | { name: string; unit?: string } | Snapshot;

/**
 * A document: made by `open`, `create` or `restore`. Its commands are methods, which return it. Each takes full effect, or throws
 * a `KneadError` and changes nothing. Its memory is given back when nothing refers to it any more.
 */
export class Document {
  private engine: Engine;
  private file: Uint8Array | null = null;
  private packed: Uint8Array | null = null;
  private fileUnit = 'mm';
  private opening = 0;
  private busy = false;

  private constructor(engine: Engine) {
    this.engine = engine;
  }

  static async begin(module: WebAssembly.Module, from: Beginning): Promise<Document> {
    const document = new Document(await Engine.load(module));
    document.ask((engine) => document.start(engine, from));
    return document;
  }

  private start(engine: Engine, from: Beginning): void {
    const { name } = from;
    this.file = 'file' in from ? from.file : null;
    this.packed = 'packed' in from ? from.packed : null;
    this.fileUnit = ('unit' in from && from.unit) || 'mm';
    if ('session' in from) {
      engine.query('restore', { ...(this.file ? { source: this.file } : {}), name, unit: this.fileUnit, snapshot: from.session });
      this.opening = engine.query('begin_history', { commands: from.opening });
      return;
    }
    if (this.file) engine.query('open', { file: this.file, name });
    else engine.query('fresh', { name, unit: this.fileUnit });
    engine.query('execute', { commands: engine.query('script_opening') }); // as scripts begin; it cannot be undone
    this.opening = engine.query('begin_history');
  }

  /** @internal Asks the engine for anything that it answers. An engine that has stopped half-way is not asked again. */
  ask<T>(question: (engine: Engine) => T): T {
    if (this.busy) throw kneadError('usage', 'the document is at work', 'do not use it in a function that its command calls');
    try {
      return question(this.engine);
    } catch (error) {
      if (error instanceof KneadError) throw error;
      const gone = kneadError('internal', `the engine has stopped (${String(error)})`, 'open the document again, or a snapshot of it');
      this.engine = { query: () => { throw gone; } } as unknown as Engine;
      throw gone;
    }
  }

  /** @internal Carries something out that can be watched; `stops` is asked within its steps. */
  work(act: (engine: Engine) => void, { progress, signal }: Working, stops: () => boolean = () => false): this {
    signal?.throwIfAborted();
    const thrown: unknown[] = [];
    let stopped = false;
    this.ask((engine) => {
      engine.onProgress = (done, total) => {
        try {
          stopped = progress?.(done, total) === false;
        } catch (error) {
          thrown.push(error);
        }
        stopped ||= thrown.length > 0 || Boolean(signal?.aborted) || stops();
        return !stopped;
      };
      engine.stops = () => (stopped ||= stops());
      this.busy = true;
      try {
        act(engine);
      } catch (error) {
        if (!stopped || !(error instanceof KneadError)) throw error; // else it was stopped before its first step was whole
      } finally {
        this.busy = false;
        engine.onProgress = () => undefined;
        engine.stops = () => false;
      }
    });
    if (thrown.length > 0) throw thrown[0];
    signal?.throwIfAborted();
    return this;
  }

  /** Carries out a script. If a command fails none of them has had an effect, and the error's `where` begins with its place. */
  run(script: Script, { name, ...working }: Working & { name?: string } = {}): this {
    return this.runUntil(script, name, working);
  }

  /** @internal */
  runUntil(script: Script, name: string | undefined, working: Working, stops?: () => boolean): this {
    return this.work((engine) => engine.query('run', { ...scriptOf(script), ...(name === undefined ? {} : { name }) }), working, stops);
  }

  get name(): string {
    return this.state.name;
  }

  /** The script that makes this document of its file: the session is the script. */
  get script(): string {
    return this.ask((engine) => engine.query('script'));
  }

  /** In the order of the file. */
  get surfaces(): Surface[] {
    return this.state.surfaces.map(({ id, name, unit }) => new Surface(this, id, name, unit));
  }

  /** Curves and volumes. */
  get bodies(): BodyInfo[] {
    return this.state.bodies;
  }

  /** The surface of that id, or of that label if only one has it. */
  surface(key: string): Surface {
    const all = this.surfaces;
    const byId = all.filter(({ id }) => id === key);
    const found = byId.length > 0 ? byId : all.filter(({ label }) => label === key);
    if (found.length === 1) return found[0]!;
    const ids = (found.length > 0 ? found : all).map(({ id }) => id).slice(0, 6).join(', ') || 'none';
    throw kneadError('input', found.length > 0 ? `"${key}" is the label of several` : `there is no surface "${key}"`, `the ids are: ${ids}`);
  }

  /** What the studio shows of the session: surfaces, tools, settings, notes, the last step. */
  get state(): SessionInfo {
    return this.ask((engine) => engine.query('state'));
  }

  /** Cost: an evaluation of the energy, and of every moved shape. */
  get report(): Report {
    return JSON.parse(this.ask((engine) => engine.query('report'))) as Report;
  }

  /** What can colour pictures. */
  get displays(): DisplayInfo[] {
    return this.ask((engine) => engine.query('displays'));
  }

  /**
   * The document as a file: its own with the present surfaces and everything else as it was, or a new one of the format that the
   * ending of a name says; without a file STEP. What a new file would lose is an error.
   */
  save(name?: string, { schema }: Pick<FileOptions, 'schema'> = {}): Uint8Array {
    if (name === undefined) return this.ask((engine) => engine.query('save').file);
    const ending = `.${name.toLowerCase().split('.').at(-1)}`;
    const triangles = fileFormats.some(({ content, endings }) => content === 'triangles' && (endings as readonly string[]).includes(ending));
    if (triangles) throw kneadError('input', `${ending} holds triangles, which lose the surfaces`, 'use export', name);
    const { file, leftOut } = this.export(name, { schema });
    if (leftOut.length > 0) throw kneadError('input', `the new file would lose something: ${leftOut.join('; ')}`, 'let export leave this out', name);
    return file;
  }

  /**
   * What `save` writes, compressed: by gzip or as the entry of a ZIP archive, as the ending of the name says (.step.gz, .stpZ); without
   * a name as the file that was opened is, with its names and dates.
   */
  async saveCompressed(name?: string, options: Pick<FileOptions, 'schema'> = {}): Promise<Uint8Array> {
    if (name !== undefined) {
      const inside = unpackedName(name);
      if (inside === name) throw kneadError('input', `the ending of ${name} tells of no compression`, 'use .gz or .stpZ, or save', name);
      return packedAs(this.save(inside, options), name);
    }
    if (this.packed === null) throw kneadError('input', 'the file that was opened is not compressed', 'give a name that ends in .gz or .stpZ, or use save', this.name);
    return packedLike(this.save(), this.packed);
  }

  /** A file of any format, triangles too, and what it leaves out, a sentence each. */
  export(name: string, options: FileOptions = {}): { file: Uint8Array; leftOut: string[] } {
    const { file, left_out } = this.ask((engine) => engine.query('file', { name, ...options }));
    return { file, leftOut: left_out };
  }

  /** All of it, with undo and redo. */
  snapshot(): Snapshot {
    const session = this.ask((engine) => engine.query('snapshot', { history_bytes: historyBytes }));
    return { name: this.name, unit: this.fileUnit, file: this.file, packed: this.packed, opening: this.opening, session };
  }
}

// eslint-disable-next-line @typescript-eslint/no-unsafe-declaration-merging
export interface Document extends CommandMethods<Document, Working>, QueryMethods {}
defineCommands(Document.prototype, (document: Document, command, working) => document.work((engine) => engine.query('execute', { commands: [command] }), working));
defineQueries(Document.prototype, (document: Document, name, request) => document.ask((engine) => engine.query(name, request)));

/** What the query `run` is given of a script. */
export function scriptOf(script: Script): { script: Uint8Array; list: boolean } {
  const bytes = (text: string) => new TextEncoder().encode(text);
  if (typeof script === 'string') return { script: bytes(script), list: false };
  const list = Array.isArray(script) || !('knead' in script);
  return { script: bytes(JSON.stringify(Array.isArray(script) ? script : list ? (script as FixInfo).commands : script)), list };
}
