// Writes the package: node build.mjs ENGINE.wasm DIRECTORY
// ENGINE.wasm is the studio's engine, whole; types and commands are those of src/generated.ts (scripts/studio.sh).
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { constants, gzipSync } from 'node:zlib';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const tools = createRequire(here('../../web/package.json')); // esbuild comes with Vite
const { build } = createRequire(tools.resolve('vite'))('esbuild');

const [wasm, directory] = process.argv.slice(2).map((path) => resolve(path));
const dist = join(directory, 'dist');
rmSync(directory, { recursive: true, force: true });
mkdirSync(dist, { recursive: true });

const common = { bundle: true, target: 'es2022', legalComments: 'none', logLevel: 'warning', absWorkingDir: here('src') };
const text = (contents) => ({ contents, loader: 'text' });
const engine = { name: 'engine', setup(of) {
  of.onResolve({ filter: /^packed:/ }, ({ path }) => ({ path, namespace: 'packed' }));
  of.onLoad({ filter: /:engine$/, namespace: 'packed' }, () => text(gzipSync(readFileSync(wasm), { level: constants.Z_BEST_COMPRESSION, memLevel: 9 }).toString('base64')));
  of.onLoad({ filter: /:thread$/, namespace: 'packed' }, () => text(readFileSync(join(dist, 'thread.js'), 'utf8')));
} };

await build({ ...common, entryPoints: ['thread.ts'], outdir: dist, format: 'iife' });
await build({ ...common, entryPoints: ['index.ts', 'lean.ts', 'worker.ts', 'worker_node.ts'], outdir: dist, format: 'esm', splitting: true, chunkNames: 'part-[hash]',
  external: ['node:worker_threads'], plugins: [engine] });
execFileSync(process.execPath, [tools.resolve('typescript/bin/tsc'), '-p', here('tsconfig.json'), '--outDir', dist], { stdio: 'inherit' });

copyFileSync(wasm, join(dist, 'knead.wasm'));
copyFileSync(here('README.md'), join(directory, 'README.md'));
copyFileSync(here('../../LICENSE'), join(directory, 'LICENSE'));
const version = /project\(knead VERSION ([0-9.]+)/.exec(readFileSync(here('../../CMakeLists.txt'), 'utf8'))[1];
writeFileSync(join(directory, 'package.json'), `${JSON.stringify({ ...JSON.parse(readFileSync(here('package.json'), 'utf8')), version }, null, 2)}\n`);
