/** What a library calls beside the system, by module and name. */
type Imports = Record<string, Record<string, (...numbers: number[]) => number | void>>;

/** Functions that are in a module of their own: what stands in for each, named by its place, until that has started. */
export interface SecondModule {
  standIn(place: string): (...numbers: (number | bigint)[]) => unknown;
  /** What it belongs to, once that has started. */
  join(core: WebAssembly.Exports): void;
}

/**
 * The few system calls that the compiled C++ library may make. There are no file system and no arguments; calls not
 * listed here return "not supported" (52).
 */
function wasiImports(module: WebAssembly.Module, memory: () => WebAssembly.Memory, own: Imports, rest?: SecondModule): WebAssembly.Imports {
  const view = () => new DataView(memory().buffer);
  const known: Record<string, (...args: never[]) => number> = {
    clock_time_get: (_id: number, _precision: bigint, out: number) => {
      view().setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    random_get: (out: number, size: number) => {
      const bytes = new Uint8Array(memory().buffer, out, size);
      for (let k = 0; k < size; ++k) bytes[k] = 256 * Math.random(); // Node 18 has no `crypto`; seeds of hash tables
      return 0;
    },
    fd_write: (_fd: number, vectors: number, count: number, out: number) => {
      let written = 0;
      let text = '';
      for (let k = 0; k < count; ++k) {
        const at = view().getUint32(vectors + 8 * k, true);
        const size = view().getUint32(vectors + 8 * k + 4, true);
        text += new TextDecoder().decode(new Uint8Array(memory().buffer, at, size).slice());
        written += size;
      }
      if (text.trim() !== '') console.error(text);
      view().setUint32(out, written, true);
      return 0;
    },
    proc_exit: (code: number) => {
      throw new Error(`the engine stopped with code ${code}`);
    },
  };
  const imports: WebAssembly.Imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    const standIn = from === 'rest' ? rest?.standIn(name) : undefined;
    (imports[from] ??= {})[name] = standIn ?? own[from]?.[name] ?? (known[name] as ((...args: unknown[]) => number) | undefined) ?? (() => 52);
  }
  return imports;
}

/** Starts a compiled C++ library, of its module or its bytes or as it arrives, and returns its exports. `rest`: what was split from it. */
export async function start<Exports extends { memory: WebAssembly.Memory; _initialize(): void }>(
  library: WebAssembly.Module | BufferSource | Promise<Response>, own: Imports = {}, rest?: SecondModule,
): Promise<Exports> {
  const module =
    library instanceof WebAssembly.Module ? library : library instanceof Promise ? await WebAssembly.compileStreaming(library) : await WebAssembly.compile(library);
  let wasm: Exports | undefined;
  const instance = await WebAssembly.instantiate(module, wasiImports(module, () => wasm!.memory, own, rest));
  wasm = instance.exports as unknown as Exports;
  rest?.join(instance.exports);
  wasm._initialize();
  return wasm;
}
