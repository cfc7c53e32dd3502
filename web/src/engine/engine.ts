import { type BufferTable, Buffers } from './buffers';
import type { Assembly, Context, FaceEdge, Trim } from './context';
import { type CheckedEdgeInfo, type EdgesInfo, fileFormats, type ReadingInfo } from './generated';
import { type DisplayChoice, type DisplayInfo, type DisplayRange, plain } from './displays';
import type { Rest } from './rest';
import {
  type BodyPicture, coefficients, type Combs, type Command, EngineError, type LatticeSettings, type MaterialSamples, type MeshFormat, type Picture, type PictureWindow,
  type SectionPlane, type SessionInfo, type StepInfo, type SurfaceNumbers, type ToolPicture, type Vector3,
} from './session_types';
import { start } from './wasi';

const everywhere: PictureWindow = { lower: [0, 0], upper: [1, 1], tolerance: 0 };

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  knead_input(size: number): number;
  knead_text(): number;
  knead_text_size(): number;
  knead_open(nameSize: number): number;
  knead_fresh(): number;
  knead_restore(sourceSize: number, nameSize: number): number;
  knead_snapshot(historyBytes: number): number;
  knead_act(join: number, keep: number): number;
  knead_begin_history(commands: number): number;
  knead_rehearse(): number;
  knead_state(): number;
  knead_steps(first: number): number;
  knead_journal(): number;
  knead_edges(): number;
  knead_room(surface: number): number;
  knead_save(): number;
  knead_origin(axis: number): number;
  knead_displays(): number;
  knead_range(): number;
  knead_body_picture(body: number): number;
  knead_lattice_picture(x: number, y: number, z: number, margin: number, anew: number): number;
  knead_combs(surface: number, alongU: number, alongV: number, teeth: number): number;
  knead_section_combs(surface: number, x: number, y: number, z: number, offset: number): number;
  knead_picture(surface: number, detail: number, opened: number, s0: number, t0: number, s1: number, t1: number, tolerance: number): number;
  knead_tool_picture(tool: number): number;
  knead_material(surface: number, rows: number, columns: number): number;
  knead_control_points(surface: number): number;
  knead_surface(surface: number): number;
  knead_mesh(format: number, detail: number): number;
  knead_context(): number;
  knead_assembly(): number;
  knead_trims(surface: number): number;
  knead_face_edges(surface: number): number;
  knead_checked_edges(surface: number): number;
  knead_reading(surface: number, s: number, t: number): number;
  knead_face_reading(x: number, y: number, z: number): number;
}

/** The C++ session behind its C interface. Runs wherever WebAssembly does: in the worker, and in node for the tests. */
export class Engine {
  /** Called from within a command that takes steps: how many are done, of how many. */
  onProgress: (done: number, total: number) => void = () => {};

  private constructor(private readonly wasm: Exports) {}

  /** `rest`: the second module, where the first is the core that was split from it. */
  static async load(library: WebAssembly.Module | BufferSource, rest?: Rest): Promise<Engine> {
    let engine: Engine | null = null;
    const told = (done: number, total: number) => engine?.onProgress(done, total);
    engine = new Engine(await start<Exports>(library, { studio: { progress: told } }, rest));
    return engine;
  }

  /** Bytes of linear memory, which grows and never shrinks. */
  get memorySize(): number {
    return this.wasm.memory.buffer.byteLength;
  }

  get origin(): [number, number, number] {
    return [this.wasm.knead_origin(0), this.wasm.knead_origin(1), this.wasm.knead_origin(2)];
  }

  openStep(bytes: Uint8Array, name: string): SessionInfo {
    const nameBytes = new TextEncoder().encode(name);
    const all = new Uint8Array(bytes.length + nameBytes.length);
    all.set(bytes);
    all.set(nameBytes, bytes.length);
    this.give(all);
    return this.json(this.wasm.knead_open(nameBytes.length)) as SessionInfo;
  }

  fresh(name: string): SessionInfo {
    this.give(new TextEncoder().encode(name));
    return this.json(this.wasm.knead_fresh()) as SessionInfo;
  }

  /** One command, an entry of the history whatever it changes. */
  execute(command: Command, join = false): void {
    this.act([command], { join, keep: true });
  }

  /**
   * Commands as one act: all or none. With `join` it belongs to the entry of the history before it. Without, and without
   * `keep`, it is no entry if it changes nothing.
   */
  act(commands: readonly Command[], { join = false, keep = false } = {}): void {
    if (commands.length === 0) return;
    this.give(new TextEncoder().encode(commands.map((command) => JSON.stringify(command)).join('\n')));
    this.json(this.wasm.knead_act(join ? 1 : 0, keep ? 1 : 0));
  }

  /** The last entry of the history goes if it is steps and settings that have changed nothing. */
  dropUnchanged(): void {
    this.give(new Uint8Array(0));
    this.json(this.wasm.knead_act(0, 0));
  }

  /**
   * What stands now, or stood after so many `commands` of the journal, belongs to the document: undo ends there. Answers
   * how many commands of the journal that are.
   */
  beginHistory(commands = -1): number {
    return this.json(this.wasm.knead_begin_history(commands)) as number;
  }

  /** Carries out commands and leaves the session as it is; what was made for them is kept, so that they take less time later. */
  rehearse(commands: readonly Command[]): void {
    this.give(new TextEncoder().encode(JSON.stringify(commands)));
    this.json(this.wasm.knead_rehearse());
  }

  state(): SessionInfo {
    return this.json(this.wasm.knead_state()) as SessionInfo;
  }

  steps(first: number): StepInfo[] {
    return this.json(this.wasm.knead_steps(first)) as StepInfo[];
  }

  /** All of the session as bytes: its history goes back as far as `historyBytes` of shapes. */
  snapshot(historyBytes: number): Uint8Array {
    return this.bytes(this.wasm.knead_snapshot(historyBytes));
  }

  /** The session of a snapshot, with undo and redo; nothing is computed. `source`: the STEP file it began with. */
  restore(source: Uint8Array | null, name: string, snapshot: Uint8Array): void {
    const nameBytes = new TextEncoder().encode(name), sourceSize = source?.length ?? 0;
    const all = new Uint8Array(sourceSize + nameBytes.length + snapshot.length);
    if (source) all.set(source);
    all.set(nameBytes, sourceSize);
    all.set(snapshot, sourceSize + nameBytes.length);
    this.give(all);
    this.json(this.wasm.knead_restore(sourceSize, nameBytes.length));
  }

  /** The list of all commands in effect, one per line. */
  journal(): string {
    return new TextDecoder().decode(this.bytes(this.wasm.knead_journal()));
  }

  /** The edges of the faces on every surface of a STEP file that has moved. */
  edges(): EdgesInfo[] {
    return this.json(this.wasm.knead_edges()) as EdgesInfo[];
  }

  /** How far the visible middle of a surface is from the nearest edge of a face; null if no edges are known. */
  room(surface: number): number | null {
    return this.json(this.wasm.knead_room(surface)) as number | null;
  }

  save(): Uint8Array {
    return this.bytes(this.wasm.knead_save());
  }

  controlPoints(surface: number): Float64Array {
    return new Float64Array(this.bytes(this.wasm.knead_control_points(surface)).buffer as ArrayBuffer);
  }

  /** The other faces of the file; null if nothing was opened or all faces are surfaces. */
  context(): Context | null {
    const found = this.json(this.wasm.knead_context()) as { buffers: BufferTable } & Pick<Context, 'faces' | 'skipped'> & { left_out: string[] } | null;
    if (!found) return null;
    const buffers = this.buffers(found.buffers);
    return {
      positions: buffers.floats('positions'), normals: buffers.floats('normals'), indices: buffers.indices('indices'),
      faces: found.faces, skipped: found.skipped, leftOut: found.left_out,
    };
  }

  /** The parts of the file and where they stand; null without assemblies. */
  assembly(): Assembly | null {
    return this.json(this.wasm.knead_assembly()) as Assembly | null;
  }

  trims(surface: number): Trim {
    return this.json(this.wasm.knead_trims(surface)) as Trim;
  }

  /** The edges of the faces of the file on a surface. */
  faceEdges(surface: number): FaceEdge[] {
    return this.json(this.wasm.knead_face_edges(surface)) as FaceEdge[];
  }

  /** How the faces on a surface meet their neighbours. */
  checkedEdges(surface: number): CheckedEdgeInfo[] {
    return this.json(this.wasm.knead_checked_edges(surface)) as CheckedEdgeInfo[];
  }

  /** What is measured at a point of a surface, in fractions of its domain. */
  reading(surface: number, [s, t]: [number, number]): ReadingInfo {
    return this.json(this.wasm.knead_reading(surface, s, t)) as ReadingInfo;
  }

  /** The same on a face that is on no surface of the session, at its point nearest to `near`. */
  faceReading(face: string, near: Vector3): ReadingInfo {
    this.give(new TextEncoder().encode(face));
    return this.json(this.wasm.knead_face_reading(...near)) as ReadingInfo;
  }

  /** All numbers of a surface as it is now, in full precision. */
  surface(surface: number): SurfaceNumbers {
    return this.json(this.wasm.knead_surface(surface)) as SurfaceNumbers;
  }

  /** All surfaces as one mesh file, with about `detail` grid lines per direction. */
  mesh(format: MeshFormat, detail: number): Uint8Array {
    return this.bytes(this.wasm.knead_mesh(fileFormats.findIndex(({ id }) => id === format), detail));
  }

  /** What can colour a surface. */
  displays(): DisplayInfo[] {
    return this.json(this.wasm.knead_displays()) as DisplayInfo[];
  }

  /** A surface, or with `opened` its original shape, with about `detail` grid lines per direction, in a window more. */
  picture(surface: number, detail: number, display: DisplayChoice = plain, opened = false, window: PictureWindow | null = null): Picture {
    this.give(new TextEncoder().encode(JSON.stringify(display)));
    const { lower: [s0, t0], upper: [s1, t1], tolerance } = window ?? everywhere;
    const found = this.json(this.wasm.knead_picture(surface, detail, opened ? 1 : 0, s0, t0, s1, t1, tolerance)) as { counts: [number, number]; buffers: BufferTable };
    const { floats, indices, flags } = this.buffers(found.buffers);
    return {
      surface,
      counts: found.counts,
      positions: floats('positions'),
      normals: floats('normals'),
      values: floats('values'),
      s: floats('fractions_s'),
      t: floats('fractions_t'),
      linesU: indices('lines_u'),
      linesV: indices('lines_v'),
      coarseU: indices('coarse_u'),
      coarseV: indices('coarse_v'),
      window,
      net: floats('net'),
      held: flags('held'),
    };
  }

  /** Of the display of the pictures that were made since that of the first surface; null without one. */
  range(): DisplayRange | null {
    return this.json(this.wasm.knead_range()) as DisplayRange | null;
  }

  /** Curvature combs on as many curves each way, with so many pieces of every knot span. */
  combs(surface: number, [alongU, alongV]: [number, number], teeth: number): Combs {
    return this.combsFrom(this.wasm.knead_combs(surface, alongU, alongV, teeth));
  }

  /** Those of the curves in which a plane of the file cuts it: a unit vector across it, then its offset along that. */
  sectionCombs(surface: number, plane: SectionPlane): Combs {
    return this.combsFrom(this.wasm.knead_section_combs(surface, ...plane));
  }

  private combsFrom(answer: number): Combs {
    const { buffers, largest, at } = this.json(answer) as { buffers: BufferTable; largest: number; at: Combs['at'] };
    const { floats, flags } = this.buffers(buffers);
    return { places: floats('places'), vectors: floats('vectors'), joined: flags('joined'), largest, at };
  }

  /** A curve or a volume, by its place in the list of the state. */
  bodyPicture(body: number): BodyPicture {
    return this.drawnBody(this.wasm.knead_body_picture(body));
  }

  /** The block that the next command `lattice` by hand moves: as it was pulled, or round the selected surfaces. */
  latticePicture({ net, margin, anew }: LatticeSettings): BodyPicture {
    return this.drawnBody(this.wasm.knead_lattice_picture(...net, margin, anew ? 1 : 0));
  }

  private drawnBody(succeeded: number): BodyPicture {
    const { buffers, pulled } = this.json(succeeded) as { buffers: BufferTable; pulled: boolean };
    const { floats } = this.buffers(buffers);
    return { lines: floats('lines'), at: floats('at'), net: floats('net'), points: floats('points'), pulled };
  }

  /** The shape of a tool, by its place in the list of the state. */
  toolPicture(tool: number): ToolPicture {
    const { buffers, open, unbounded } = this.json(this.wasm.knead_tool_picture(tool)) as { buffers: BufferTable; open: boolean; unbounded: boolean };
    const { floats, indices } = this.buffers(buffers);
    return { positions: floats('positions'), normals: floats('normals'), indices: indices('indices'), open, unbounded };
  }

  /** The material of a surface as it is now. */
  material(surface: number, counts: [number, number]): MaterialSamples {
    const { doubles } = this.buffers((this.json(this.wasm.knead_material(surface, ...counts)) as { buffers: BufferTable }).buffers);
    return { counts, values: Object.fromEntries(coefficients.map((c) => [c, doubles(c)])) as MaterialSamples['values'] };
  }

  private buffers(table: BufferTable): Buffers {
    return new Buffers(this.wasm.memory.buffer as ArrayBuffer, table);
  }

  private give(bytes: Uint8Array): void {
    const at = this.wasm.knead_input(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
  }

  /** A copy of the text of the last call; throws the error that the call reported. */
  private bytes(succeeded: number): Uint8Array {
    const at = this.wasm.knead_text();
    const bytes = new Uint8Array(this.wasm.memory.buffer, at, this.wasm.knead_text_size()).slice();
    if (succeeded === 0) throw new EngineError(JSON.parse(new TextDecoder().decode(bytes)).error);
    return bytes;
  }

  private json(succeeded: number): unknown {
    return JSON.parse(new TextDecoder().decode(this.bytes(succeeded)));
  }
}
