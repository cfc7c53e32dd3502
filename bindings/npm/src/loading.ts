import { kneadError, type KneadError } from './errors.js';

/** Where the engine comes from: the file `knead.wasm` of this package. */
export interface EngineSource {
  /** Its address. */
  wasmUrl?: string | URL;
  /** Its bytes, or what was compiled of them. */
  wasmBinary?: BufferSource | WebAssembly.Module;
}

const remedies = "serve the package's file knead.wasm at wasmUrl, give its bytes as wasmBinary, or import 'knead-cad', which has the engine inside";
const wrong = (what: string, helps = remedies): KneadError => kneadError('input', what, helps);

/** What bytes are that are no WebAssembly. */
function looksLike(bytes: Uint8Array): string {
  if (bytes.length === 0) return 'nothing';
  const begin = new TextDecoder().decode(bytes.subarray(0, 200)).trimStart();
  if (/^<(!doctype|html|head|body|\?xml|!--)/i.test(begin)) return `a page (${JSON.stringify(begin.split('\n', 1)[0]!.slice(0, 40))})`;
  if (bytes[0] === 0x1f && bytes[1] === 0x8b) return 'a file compressed by gzip';
  return /^[\x20-\x7e\s]{8}/.test(begin) ? `text (${JSON.stringify(begin.slice(0, 40))})` : `${bytes.length} bytes of something else`;
}

const bytesOf = (source: BufferSource): Uint8Array =>
  ArrayBuffer.isView(source) ? new Uint8Array(source.buffer, source.byteOffset, source.byteLength) : new Uint8Array(source);

/** Whether a content security policy has refused. */
export const isPolicy = (error: unknown): boolean => /content security policy|unsafe-eval|disallowed by embedder|call to WebAssembly/i.test(String(error));

export const policyError = (): KneadError =>
  wrong("the page's content security policy allows no WebAssembly", "allow 'wasm-unsafe-eval' in its script-src, use 'knead-cad/worker' with a workerUrl "
    + 'that is served with a policy of its own, or let a server do the work with Node');

/** The engine of these bytes. `from`: what the sentence about others begins with. */
export async function compiled(source: BufferSource | WebAssembly.Module, from: string): Promise<WebAssembly.Module> {
  if (!(source instanceof WebAssembly.Module)) {
    const bytes = bytesOf(source);
    if (bytes[0] !== 0 || bytes[1] !== 0x61 || bytes[2] !== 0x73 || bytes[3] !== 0x6d) throw wrong(`${from} ${looksLike(bytes)} instead of WebAssembly`);
    source = await WebAssembly.compile(bytes as BufferSource).catch((error: unknown) => {
      throw isPolicy(error) ? policyError() : wrong(`${from} WebAssembly that is damaged (${String(error)})`);
    });
  }
  if (!WebAssembly.Module.exports(source).some(({ name }) => name === 'knead_call')) throw wrong(`${from} another WebAssembly than the engine`);
  return source;
}

async function fetched(url: string): Promise<WebAssembly.Module> {
  let response: Response;
  try {
    response = await fetch(url);
  } catch (error) {
    throw wrong(`the engine could not be fetched from ${url} (${error instanceof Error ? error.message : String(error)})`);
  }
  if (!response.ok) throw wrong(`the engine could not be fetched: ${url} gives ${`${response.status} ${response.statusText}`.trim()}`);
  return compiled(await response.arrayBuffer(), `the engine could not be loaded: ${url} gives`);
}

const byUrl = new Map<string, Promise<WebAssembly.Module>>();

/** The engine from where it is said to be; fetched and compiled once. */
export function moduleFrom({ wasmUrl, wasmBinary }: EngineSource): Promise<WebAssembly.Module> {
  if (wasmBinary) return compiled(wasmBinary, 'the engine could not be loaded: wasmBinary holds');
  if (wasmUrl === undefined) return Promise.reject(wrong("'knead-cad/lean' is not told where its engine is"));
  const url = String(wasmUrl);
  const known = byUrl.get(url) ?? fetched(url);
  byUrl.set(url, known);
  known.catch(() => byUrl.delete(url)); // another try fetches it again
  return known;
}
