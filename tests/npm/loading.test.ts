import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import type { Browser } from 'playwright-core';

import { done, launch, program, result, serve, type Site, visit } from './pages';
import { directory, installed, knead } from './support';

// An engine that cannot be had is one sentence: what came instead, and three ways out.

let browser: Browser, site: Site;
beforeAll(async () => {
  const where = directory('loading');
  execFileSync('cp', ['-r', installed(), join(where, 'knead-cad')]);
  writeFileSync(join(where, 'index.html'), '<!doctype html>');
  writeFileSync(join(where, 'page.js'), '');
  [browser, site] = await Promise.all([launch(), serve(where)]);
});
afterAll(() => Promise.all([browser.close(), site.close()]));

/** What a module in a page says, and the milliseconds that it took. The page has this policy. */
async function said<T = { message: string; time: number }>(script: string, policy = '', headers: Site['headers'] = () => ({})): Promise<T> {
  writeFileSync(join(directory('loading'), 'page.js'), script);
  site.headers = (path) => ({ ...(policy && path === '/index.html' ? { 'content-security-policy': policy } : {}), ...headers(path) });
  writeFileSync(join(directory('loading'), 'index.html'), '<!doctype html><script type="module" src="./page.js"></script>');
  const context = await browser.newContext();
  try {
    const { page } = await visit(context, `${site.url}/index.html`);
    return await result<T>(page);
  } finally {
    await context.close();
  }
}

const refused = (entry: string, call: string): string => `import * as knead from './knead-cad/dist/${entry}.js';
const begin = performance.now();
try {
  await knead.${call};
  globalThis.result = { message: 'it was not refused', time: 0 };
} catch (error) {
  globalThis.result = { message: error instanceof knead.KneadError ? error.message : 'not a KneadError: ' + error.stack, time: performance.now() - begin };
}`;

const ways = /; serve the package's file knead\.wasm at wasmUrl, give its bytes as wasmBinary, or import 'knead-cad', which has the engine inside$/;

it.each([
  ['a page that came for it', "create({ wasmUrl: '/assets/knead.wasm' })", /^the engine could not be loaded: \/assets\/knead\.wasm gives a page \("<!doctype html>"\) instead of WebAssembly/],
  ['404', "create({ wasmUrl: '/none/knead.wasm' })", /^the engine could not be fetched: \/none\/knead\.wasm gives 404 Not Found/],
  ['a host that is not there', "create({ wasmUrl: 'http://127.0.0.1:1/knead.wasm' })", /^the engine could not be fetched from http:\/\/127\.0\.0\.1:1\/knead\.wasm \(/],
  ['a script', "create({ wasmUrl: '/knead-cad/dist/index.js' })", /^the engine could not be loaded: \S+ gives text \("/],
  ['half of it', "create({ wasmBinary: (await (await fetch('/knead-cad/dist/knead.wasm')).arrayBuffer()).slice(0, 100000) })", /^the engine could not be loaded: wasmBinary holds WebAssembly that is damaged \(CompileError/],
  ['nothing', 'create({})', /^'knead-cad\/lean' is not told where its engine is/],
])('lean, %s', async (_, call, sentence) => {
  const { message, time } = await said(refused('lean', call));
  expect(message).toMatch(sentence);
  expect(message).toMatch(ways);
  expect(time).toBeLessThan(2000);
});

const strict = "default-src 'self'";
it.each(['index', 'worker'])('%s, a policy without WebAssembly', async (entry) => {
  const { message, time } = await said(refused(entry, 'create()'), `${strict}; worker-src 'self' blob:`);
  expect(message).toMatch(/^the page's content security policy allows no WebAssembly; allow 'wasm-unsafe-eval' .*, use .*, or let [^;]*$/);
  expect(time).toBeLessThan(2000);
});

it('worker, a policy without workers of blobs', async () => {
  const { message, time } = await said(refused('worker', 'create()'), `${strict}; script-src 'self' 'wasm-unsafe-eval'`);
  expect(message).toMatch(/^no worker could be started \([^;]*\); serve .* workerUrl, allow blob: .*, or import [^;]*$/);
  expect(time).toBeLessThan(2000);
});

it('worker, an address that is wrong', async () => {
  const { message, time } = await said(refused('worker', "create({ workerUrl: '/none/thread.js' })"));
  expect(message).toMatch(/^no worker could be started \(\/none\/thread\.js gives none\); serve/);
  expect(time).toBeLessThan(2000);
});

it('under the strictest policy a worker that is served sculpts', async () => {
  const script = program('./knead-cad/dist/worker.js').replace("{ name: 'bonnet.step' }", "{ name: 'bonnet.step', workerUrl: './knead-cad/dist/thread.js' }");
  expect(await said(script, strict)).toEqual(done);
});

it('lean sculpts with the file that is served, by address and by bytes', async () => {
  for (const engine of ["wasmUrl: new URL('./knead-cad/dist/knead.wasm', import.meta.url)", "wasmBinary: await (await fetch('./knead-cad/dist/knead.wasm')).arrayBuffer()"]) {
    expect(await said(program('./knead-cad/dist/lean.js').replace("{ name: 'bonnet.step' }", `{ name: 'bonnet.step', ${engine} }`))).toEqual(done);
  }
});

it('in Node the sentence is the same', async () => {
  const lean = (await knead('lean')) as unknown as typeof import('../../bindings/npm/src/lean');
  await expect(lean.create({ wasmUrl: `${site.url}/assets/knead.wasm` })).rejects.toThrow(ways);
  await expect(lean.create({ wasmUrl: new URL('file:///knead.wasm') })).rejects.toThrow(ways);
  await expect(lean.create({ wasmBinary: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]) })).rejects.toThrow(/holds another WebAssembly than the engine; serve/);
});
