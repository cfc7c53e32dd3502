// Writes the TypeScript types of what the session says and of its commands, as the engine describes them (bindings/wasm/types.cpp).
// Beside them a module with the help of each command's fields, which the types have as comments: `stepHelp`, by field.
// node types.mjs MODULE TYPES HELP; files are left alone where they say so already.
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';

const [source, types, helpTarget] = process.argv.slice(2);
const module = await WebAssembly.compile(await readFile(source));
const imports = {};
for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = () => 52; // not supported
const { exports } = await WebAssembly.instantiate(module, imports);
exports._initialize();
exports.knead_types();
const bytes = new Uint8Array(exports.memory.buffer, exports.knead_text(), exports.knead_text_size());
const text = new TextDecoder().decode(bytes);

const camel = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
const helps = {};
for (const [, name, fields] of text.matchAll(/^export type \w+ = \{\n {2}do: '(\w+)';\n([^]*?)^\};/gm)) { // of some there are several
  const each = [...fields.matchAll(/^ {2}\/\*\* (.*) \*\/\n {2}(\w+)\??:/gm)].map(([, about, field]) => [field, about.replace(/ \(length\)$/, '')]);
  helps[name] = { ...Object.fromEntries(each), ...helps[name] };
}
const help = Object.entries(helps).map(([name, fields]) => `export const ${camel(name)}Help = ${JSON.stringify(fields, null, 2)} as const;\n`).join('\n');

for (const [target, content] of [[types, text], [helpTarget, help]]) {
  await mkdir(dirname(target), { recursive: true });
  if (content !== (await readFile(target, 'utf8').catch(() => ''))) await writeFile(target, content);
}
