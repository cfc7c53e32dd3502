import { KneadError, uncoded } from '../../engine/session_types';
import { start } from '@knead/wasi';

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  snake_input(count: number): number;
  snake_text(): number;
  snake_text_size(): number;
  snake_image(width: number, height: number): number;
  snake_mask(width: number, height: number): number;
  snake_script(again: number): number;
  snake_advance(iterations: number): number;
  snake_clear(): number;
  snake_keep(): number;
  snake_restore(kept: number): number;
  snake_forget(kept: number): void;
  snake_wake(): number;
  snake_pull(snake: number, at: number, x: number, y: number, strength: number): number;
  snake_move(snake: number, point: number, x: number, y: number): number;
  snake_save(kind: number): number;
  snake_picture(kind: number): number;
  snake_buffer(which: number): number;
  snake_buffer_size(which: number): number;
}

/** Four bytes a pixel, row by row. */
export interface Pixels {
  width: number;
  height: number;
  data: Uint8ClampedArray;
}

export interface SnakeState {
  closed: boolean;
  iterations: number;
  resting: boolean;
}

/** All snakes as they are now, in pixels. */
export interface Snakes {
  states: SnakeState[];
  /** All rest, or have made their iterations. */
  ended: boolean;
  /** Places along the contours, three numbers each: x, y, parameter from 0 to 1. */
  points: Float32Array;
  /** Where each contour begins among them, and the end. */
  offsets: Uint32Array;
  /** x, y of the control points. */
  net: Float32Array;
  netFrom: Uint32Array;
}

/** What the user's hand draws at: a fraction of a snake's parameter, to a place. */
export interface Pull {
  snake: number;
  at: number;
  to: [number, number];
  strength: number;
}

export const contourKinds = ['json', 'csv', 'svg'] as const;
export type ContourKind = (typeof contourKinds)[number];
export const pictureKinds = ['mask', 'energy'] as const;
export type PictureKind = (typeof pictureKinds)[number];

/** Snakes in one image, computed by the C++ library in a module of its own. */
export class SnakeModule {
  private constructor(private readonly wasm: Exports) {}

  static async load(bytes: BufferSource | Promise<Response>): Promise<SnakeModule> {
    return new SnakeModule(await start<Exports>(bytes));
  }

  get memorySize(): number {
    return this.wasm.memory.buffer.byteLength;
  }

  /** Forgets the snakes, the mask and what was kept. */
  setImage({ width, height, data }: Pixels): Snakes {
    this.give(data);
    return this.snakes(this.wasm.snake_image(width, height));
  }

  setMask(mask: Pixels | null): Snakes {
    this.give(mask?.data ?? new Uint8Array());
    return this.snakes(this.wasm.snake_mask(mask?.width ?? 0, mask?.height ?? 0));
  }

  /** Snakes that are there go on from where they are, unless `again`. */
  setScript(script: string, again = false): Snakes {
    this.give(new TextEncoder().encode(script));
    return this.snakes(this.wasm.snake_script(again ? 1 : 0));
  }

  /** No snakes; the mask stays. */
  clear(): Snakes {
    return this.snakes(this.wasm.snake_clear());
  }

  /** Keeps everything but the image as it is: the number to restore it by. */
  keep(): number {
    return this.json<{ kept: number }>(this.wasm.snake_keep()).kept;
  }

  restore(kept: number): Snakes {
    return this.snakes(this.wasm.snake_restore(kept));
  }

  forget(kept: number): void {
    this.wasm.snake_forget(kept);
  }

  advance(iterations: number): Snakes {
    return this.snakes(this.wasm.snake_advance(iterations));
  }

  /** Those that have ended may go on. */
  wake(): Snakes {
    return this.snakes(this.wasm.snake_wake());
  }

  pull(pull: Pull | null): Snakes {
    return this.snakes(pull ? this.wasm.snake_pull(pull.snake, pull.at, ...pull.to, pull.strength) : this.wasm.snake_pull(-1, 0, 0, 0, 0));
  }

  move(snake: number, point: number, [x, y]: [number, number]): Snakes {
    return this.snakes(this.wasm.snake_move(snake, point, x, y));
  }

  contours(kind: ContourKind, image: string): string {
    this.give(new TextEncoder().encode(image));
    const succeeded = this.wasm.snake_save(contourKinds.indexOf(kind));
    if (succeeded === 0) this.json(succeeded);
    return this.text();
  }

  /** One byte a pixel. */
  picture(kind: PictureKind): { width: number; height: number; data: Uint8Array } {
    const size = this.json<{ width: number; height: number }>(this.wasm.snake_picture(pictureKinds.indexOf(kind)));
    return { ...size, data: new Uint8Array(this.bytes(4)) };
  }

  private give(bytes: Uint8Array | Uint8ClampedArray): void {
    const at = this.wasm.snake_input(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
  }

  private snakes(succeeded: number): Snakes {
    const { snakes, ended } = this.json<{ snakes: SnakeState[]; ended: boolean }>(succeeded);
    return {
      states: snakes, ended, points: new Float32Array(this.bytes(0)), offsets: new Uint32Array(this.bytes(1)),
      net: new Float32Array(this.bytes(2)), netFrom: new Uint32Array(this.bytes(3)),
    };
  }

  private bytes(which: number): ArrayBuffer {
    const at = this.wasm.snake_buffer(which);
    return this.wasm.memory.buffer.slice(at, at + this.wasm.snake_buffer_size(which)) as ArrayBuffer;
  }

  private text(): string {
    return new TextDecoder().decode(new Uint8Array(this.wasm.memory.buffer, this.wasm.snake_text(), this.wasm.snake_text_size()).slice());
  }

  private json<T>(succeeded: number): T {
    const value = JSON.parse(this.text()) as unknown;
    if (succeeded === 0) throw new KneadError({ ...uncoded, ...(value as { error: KneadError['info'] }).error });
    return value as T;
  }
}
