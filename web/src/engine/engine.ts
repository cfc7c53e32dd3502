import type { Trim } from './context';
import {
  type Command, EngineError, type Field, fields, type FileFormat, type MeshFormat, type Picture, type SessionInfo, type StepInfo,
  type SurfaceNumbers,
} from './session_types';
import { start } from './wasi';

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
  knead_execute(join: number): number;
  knead_state(): number;
  knead_steps(first: number): number;
  knead_journal(): number;
  knead_save(): number;
  knead_origin(axis: number): number;
  knead_paint(surface: number, detail: number, field: number, opened: number): number;
  knead_buffer(which: number): number;
  knead_buffer_size(which: number): number;
  knead_control_points(surface: number): number;
  knead_surface(surface: number): number;
  knead_formats(): number;
  knead_mesh(format: number, detail: number): number;
  knead_context(): number;
  knead_trims(surface: number): number;
}

/** The C++ session behind its C interface. Runs wherever WebAssembly does: in the worker, and in node for the tests. */
export class Engine {
  private constructor(private readonly wasm: Exports) {}

  static async load(bytes: BufferSource | Promise<Response>): Promise<Engine> {
    return new Engine(await start<Exports>(bytes));
  }

  /** Bytes of linear memory: it grows, and never shrinks. */
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

  execute(command: Command, join = false): void {
    this.give(new TextEncoder().encode(JSON.stringify(command)));
    this.json(this.wasm.knead_execute(join ? 1 : 0));
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

  /** The script of everything that stands, one command per line. */
  journal(): string {
    return new TextDecoder().decode(this.bytes(this.wasm.knead_journal()));
  }

  save(): Uint8Array {
    return this.bytes(this.wasm.knead_save());
  }

  controlPoints(surface: number): Float64Array {
    return new Float64Array(this.bytes(this.wasm.knead_control_points(surface)).buffer as ArrayBuffer);
  }

  /** Bytes for `readContext`. */
  context(): Uint8Array {
    return this.bytes(this.wasm.knead_context());
  }

  trims(surface: number): Trim {
    return this.json(this.wasm.knead_trims(surface)) as Trim;
  }

  /** All numbers of a surface as it is now, in full precision. */
  surface(surface: number): SurfaceNumbers {
    return this.json(this.wasm.knead_surface(surface)) as SurfaceNumbers;
  }

  /** The formats that the library opens and writes. */
  formats(): FileFormat[] {
    return this.json(this.wasm.knead_formats()) as FileFormat[];
  }

  /** All surfaces as one mesh file, with about `detail` grid lines per direction. */
  mesh(format: MeshFormat, detail: number): Uint8Array {
    return this.bytes(this.wasm.knead_mesh(this.formats().findIndex(({ id }) => id === format), detail));
  }

  paint(surface: number, detail: number, field: Field, opened = false): Picture {
    const { counts } = this.json(this.wasm.knead_paint(surface, detail, fields.indexOf(field), opened ? 1 : 0)) as {
      counts: [number, number];
    };
    const copy = (which: number): ArrayBuffer => {
      const at = this.wasm.knead_buffer(which);
      return this.wasm.memory.buffer.slice(at, at + this.wasm.knead_buffer_size(which)) as ArrayBuffer;
    };
    return {
      surface,
      counts,
      positions: new Float32Array(copy(0)),
      normals: new Float32Array(copy(1)),
      values: new Float32Array(copy(2)),
      s: new Float32Array(copy(3)),
      t: new Float32Array(copy(4)),
      linesU: new Uint32Array(copy(5)),
      linesV: new Uint32Array(copy(6)),
      net: new Float32Array(copy(7)),
      held: new Uint8Array(copy(8)),
    };
  }

  private give(bytes: Uint8Array): void {
    const at = this.wasm.knead_input(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
  }

  /** A copy of the text of the last call; throws what the call said went wrong. */
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
