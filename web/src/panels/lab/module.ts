import { KneadError, uncoded } from '../../engine/session_types';
import { start } from '@knead/wasi';

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  lab_input(count: number): number;
  lab_text(): number;
  lab_text_size(): number;
  lab_knots(degree: number): number;
  lab_curves(order: number, pixels: number): number;
  lab_probe(order: number, u: number): number;
  lab_jumps(i: number): number;
  lab_gramians(a: number, b: number): number;
  lab_times(a: number, b: number, budget: number): number;
  lab_buffer(which: number): number;
  lab_buffer_size(which: number): number;
}

/** What is known about a knot vector immediately. */
export interface Basis {
  count: number;
  domain: [number, number];
  clamped: [boolean, boolean];
  /** Per function: its Greville abscissa, and its integral over the line. */
  greville: number[];
  integrals: number[];
}

/** All functions, or derivatives or integrals of them, as bindings/wasm/lab_curves.hpp describes it. */
export interface Curves {
  lowest: number;
  highest: number;
  /** The largest weight of an impulse. */
  weight: number;
  /** Order 0: the largest |Σ N_i − 1|. */
  unity: number;
  points: Float64Array;
  offsets: Int32Array;
  /** Four numbers each: function, knot, k of δ^(k), weight. */
  impulses: Float64Array;
}

export interface Jumps {
  knot: number;
  multiplicity: number;
  lowest: number;
  jumps: number[];
}

export const methods = ['gauss', 'analytic', 'recurrence'] as const;
export type Method = (typeof methods)[number];
/** Differences, in the order of the module's tables: which minus which. */
export const pairs: readonly (readonly [Method, Method])[] = [['gauss', 'recurrence'], ['analytic', 'recurrence'], ['analytic', 'gauss']];

/** Per pair; rows and columns are −1 if nothing differs. A number is null if it is not finite. */
export interface Worst {
  absolute: number | null;
  absoluteAt: [number, number];
  relative: number | null;
  relativeAt: [number, number];
}

/** One Gramian by every method. Tables are bands: entry (i, j) at i (2p + 1) + j − i + p. */
export interface Gramians {
  size: number;
  bandwidth: number;
  /** The methods actually used for gauss, analytic and recurrence. */
  used: string[];
  worst: Worst[];
  values: Float64Array[];
  /** ∫|N_i^(a) N_j^(b)| */
  absolute: Float64Array;
  differences: Float64Array[];
  relative: Float64Array[];
}

/** The functions and Gramians of one knot vector, computed by the C++ library in a module of its own. */
export class LabModule {
  private constructor(private readonly wasm: Exports) {}

  static async load(bytes: BufferSource | Promise<Response>): Promise<LabModule> {
    return new LabModule(await start<Exports>(bytes));
  }

  get memorySize(): number {
    return this.wasm.memory.buffer.byteLength;
  }

  /** Sets the knots for all other calls. Throws, and keeps the previous knots, if these are not a knot vector. */
  setKnots(degree: number, knots: readonly number[]): Basis {
    const at = this.wasm.lab_input(knots.length);
    new Float64Array(this.wasm.memory.buffer, at, knots.length).set(knots);
    return this.json<Basis>(this.wasm.lab_knots(degree));
  }

  /** Derivatives of an order, or for negative orders repeated integrals. */
  curves(order: number, pixels: number): Curves {
    const head = this.json<Pick<Curves, 'lowest' | 'highest' | 'weight' | 'unity'>>(this.wasm.lab_curves(order, pixels));
    return { ...head, points: this.doubles(0), offsets: new Int32Array(this.bytes(1)), impulses: this.doubles(2) };
  }

  /** Values of all functions at u, and their sum. */
  probe(order: number, u: number): { values: Float64Array; sum: number } {
    const { sum } = this.json<{ sum: number }>(this.wasm.lab_probe(order, u));
    return { values: this.doubles(3), sum };
  }

  jumps(i: number): Jumps[] {
    return this.json<Jumps[]>(this.wasm.lab_jumps(i));
  }

  gramians(a: number, b: number): Gramians {
    const head = this.json<Pick<Gramians, 'size' | 'bandwidth' | 'used' | 'worst'>>(this.wasm.lab_gramians(a, b));
    const three = (first: number) => [0, 1, 2].map((k) => this.doubles(first + k));
    return { ...head, values: three(4), absolute: this.doubles(7), differences: three(8), relative: three(11) };
  }

  /** Seconds per Gramian and method, measured for `budget` seconds each. */
  times(a: number, b: number, budget: number): number[] {
    return this.json<number[]>(this.wasm.lab_times(a, b, budget));
  }

  private bytes(which: number): ArrayBuffer {
    const at = this.wasm.lab_buffer(which);
    return this.wasm.memory.buffer.slice(at, at + this.wasm.lab_buffer_size(which)) as ArrayBuffer;
  }

  private doubles(which: number): Float64Array {
    return new Float64Array(this.bytes(which));
  }

  private json<T>(succeeded: number): T {
    const at = this.wasm.lab_text();
    const bytes = new Uint8Array(this.wasm.memory.buffer, at, this.wasm.lab_text_size()).slice();
    const value = JSON.parse(new TextDecoder().decode(bytes)) as unknown;
    if (succeeded === 0) throw new KneadError({ ...uncoded, ...(value as { error: KneadError['info'] }).error });
    return value as T;
  }
}
