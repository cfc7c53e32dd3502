import { KneadError } from './errors.js';
import type { AnyCommand, EngineErrorInfo, Queries } from './generated.js';
import { type SecondModule, start } from './wasi.js';

/** The name of a query; what it is and answers is described in bindings/wasm/queries. */
export type Query = keyof Queries;
export type Answer<Q extends Query> = Queries[Q]['answer'];
/** Its request, which may be left out where nothing in it is required. */
export type Asked<Q extends Query> = object extends Queries[Q]['request'] ? [request?: Queries[Q]['request']] : [request: Queries[Q]['request']];

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  knead_input(size: number): number;
  knead_call(jsonSize: number): void;
  knead_text(): number;
  knead_text_size(): number;
}

/** What an answer has in the module's memory: its type, address and number of elements. */
type Place = [type: keyof typeof arrays | 'string', at: number, count: number];
type Reply = { error: EngineErrorInfo; file: string; line: number } | { answer: unknown; memory?: Record<string, Place> };

const arrays = { Float32Array, Float64Array, Uint32Array, Uint8Array };

/** The C++ session behind its one call (bindings/wasm/queries.hpp). Runs wherever WebAssembly does. */
export class Engine {
  /** Called from within a command that takes steps: how many are done, of how many. With false the command stops. Must not throw. */
  onProgress: (done: number, total: number) => boolean | void = () => {};
  /** Asked within steps: whether to stop. Must not throw. */
  stops: () => boolean = () => false;

  private constructor(private readonly wasm: Exports) {}

  /** `rest`: the second module, where the first is the core that was split from it. */
  static async load(library: WebAssembly.Module | BufferSource, rest?: SecondModule): Promise<Engine> {
    let engine: Engine | null = null;
    const progress = (done: number, total: number) => (engine?.onProgress(done, total) === false ? 1 : 0);
    const stops = () => (engine?.stops() ? 1 : 0);
    engine = new Engine(await start<Exports>(library, { studio: { progress, stops } }, rest));
    return engine;
  }

  /** Bytes of linear memory, which grows and never shrinks. */
  get memorySize(): number {
    return this.wasm.memory.buffer.byteLength;
  }

  /** Asks for an answer, whose arrays are copies; throws the error that the engine reports instead. */
  query<Q extends Query>(query: Q, ...[given]: Asked<Q>): Answer<Q> {
    const bytes: Uint8Array[] = [];
    const request = Object.fromEntries(Object.entries(given ?? {}).map(([field, value]: [string, unknown]) => {
      if (!(value instanceof Uint8Array)) return [field, value];
      bytes.push(value);
      return [field, value.length];
    }));
    const json = new TextEncoder().encode(JSON.stringify({ query, request }));
    const all = [...bytes, json];
    let at = this.wasm.knead_input(all.reduce((sum, part) => sum + part.length, 0));
    for (const part of all) {
      new Uint8Array(this.wasm.memory.buffer).set(part, at);
      at += part.length;
    }
    this.wasm.knead_call(json.length);
    const reply = JSON.parse(this.taken(['string', this.wasm.knead_text(), this.wasm.knead_text_size()]) as string) as Reply;
    if ('error' in reply) throw new KneadError(reply.error, reply.file, reply.line);
    const { answer, memory = {} } = reply;
    for (const [field, place] of Object.entries(memory)) {
      if (field === '') return this.taken(place) as Answer<Q>;
      (answer as Record<string, unknown>)[field] = this.taken(place);
    }
    return answer as Answer<Q>;
  }

  private taken([type, at, count]: Place): unknown {
    const { buffer } = this.wasm.memory;
    if (type === 'string') return new TextDecoder().decode(new Uint8Array(buffer, at, count));
    return new arrays[type](buffer.slice(at, at + arrays[type].BYTES_PER_ELEMENT * count) as ArrayBuffer);
  }

  /** One command, an entry of the history whatever it changes. */
  execute(command: AnyCommand, join = false): void {
    this.query('act', { commands: [command], join, keep: true });
  }
}
