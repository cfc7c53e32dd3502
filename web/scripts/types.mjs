// Writes the TypeScript types of what the session says and of its commands, as the engine describes them (bindings/wasm/types.cpp).
// node types.mjs MODULE TARGET; the target is left alone where it says so already.
import { readFile, writeFile } from 'node:fs/promises';

const [source, target] = process.argv.slice(2);
const module = await WebAssembly.compile(await readFile(source));
const imports = {};
for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = () => 52; // not supported
const { exports } = await WebAssembly.instantiate(module, imports);
exports._initialize();
exports.knead_types();
const bytes = new Uint8Array(exports.memory.buffer, exports.knead_text(), exports.knead_text_size());
const text = new TextDecoder().decode(bytes);
if (text !== (await readFile(target, 'utf8').catch(() => ''))) await writeFile(target, text);
