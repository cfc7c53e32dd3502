// Splits the studio's engine into the functions that a typical session calls, which the page loads first, and the rest:
//   node scripts/split.mjs WHOLE.wasm CORE.wasm REST.wasm
// wasm-split (binaryen) counts calls in an instrumented copy of the engine while a session (session.mjs) runs in node.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { createServer } from 'vite';

import { session } from './session.mjs';

const [whole, core, rest] = process.argv.slice(2);
const web = fileURLToPath(new URL('..', import.meta.url));
const features = ['--enable-simd', '--enable-bulk-memory', '--enable-sign-ext', '--enable-mutable-globals', '--enable-nontrapping-float-to-int', '--enable-reference-types', '--enable-multivalue'];
const split = (...options) => execFileSync('wasm-split', [...options, ...features], { stdio: ['ignore', 'inherit', 'inherit'] });

/** Writes where the instrumented engine has counted its calls. */
function profileOf(engine) {
  const { wasm } = engine;
  const size = wasm.__write_profile(0, 0), at = wasm.knead_input(size);
  wasm.__write_profile(at, size);
  return new Uint8Array(wasm.memory.buffer, at, size).slice();
}

const directory = mkdtempSync(join(tmpdir(), 'knead-split-'));
const server = await createServer({ root: web, configFile: join(web, 'vite.config.ts'), logLevel: 'error', appType: 'custom', server: { middlewareMode: true, ws: false }, optimizeDeps: { noDiscovery: true, include: [] } });
try {
  const instrumented = join(directory, 'instrumented.wasm'), profile = join(directory, 'profile');
  split('--instrument', whole, '-o', instrumented);
  const { Engine } = await server.ssrLoadModule('@knead/engine');
  const { scenes } = await server.ssrLoadModule('/src/document/scenes.ts');
  const engine = await Engine.load(readFileSync(instrumented));
  session(engine, scenes.filter(({ name }) => !/^(Fig\.|Fine)/.test(name)), new Uint8Array(readFileSync(join(web, '../samples/bonnet.step'))));
  writeFileSync(profile, profileOf(engine));
  split('--split', whole, '--profile', profile, '--import-namespace', 'core', '--placeholder-namespace', 'rest', '-o1', core, '-o2', rest);
} finally {
  await server.close();
  rmSync(directory, { recursive: true });
}
