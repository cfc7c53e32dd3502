/** Where numbers are in the module's memory, by name: bindings/wasm/buffers.hpp. */
export type BufferTable = Record<string, { type: string; at: number; count: number }>;

const sizes: Record<string, number> = { float32: 4, float64: 8, uint32: 4, uint8: 1 };

/** Copies of the buffers of a call. A missing name, or one of another type, is an error of the binding. */
export class Buffers {
  constructor(private readonly memory: ArrayBuffer, private readonly table: BufferTable) {}

  floats = (name: string): Float32Array => new Float32Array(this.bytes(name, 'float32'));
  doubles = (name: string): Float64Array => new Float64Array(this.bytes(name, 'float64'));
  indices = (name: string): Uint32Array => new Uint32Array(this.bytes(name, 'uint32'));
  flags = (name: string): Uint8Array => new Uint8Array(this.bytes(name, 'uint8'));

  private bytes(name: string, type: string): ArrayBuffer {
    const found = this.table[name];
    if (found?.type !== type) throw new Error(`the engine hands out no ${type} numbers named "${name}"`);
    return this.memory.slice(found.at, found.at + sizes[type]! * found.count);
  }
}
