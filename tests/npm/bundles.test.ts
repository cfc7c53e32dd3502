import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { build as bundle } from 'esbuild';
import type { Browser } from 'playwright-core';
import { build, createServer } from 'vite';

import { done, launch, program, result, serve, visit } from './pages';
import { directory, installed, root, run } from './support';

// The same lines by every way into a page, without any configuration.

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

/** A page of one module in a directory of its own. */
function page(name: string, script: string, module = 'page.js'): string {
  const where = directory(name);
  writeFileSync(join(where, module), script);
  writeFileSync(join(where, 'index.html'), `<!doctype html><script type="module" src="./${module}"></script>`);
  return where;
}

async function runs(where: string, path = '/index.html'): Promise<void> {
  const site = await serve(where);
  const context = await browser.newContext();
  try {
    const { page: shown, foreign } = await visit(context, site.url + path);
    expect(await result(shown)).toEqual(done);
    expect(foreign).toEqual([]);
  } finally {
    await context.close();
    await site.close();
  }
}

const entries = ['knead-cad', 'knead-cad/worker'];

it.each(['index', 'worker'])('a static page imports dist/%s.js', async (entry) => {
  const where = page(`static-${entry}`, program(`./knead-cad/dist/${entry}.js`));
  execFileSync('cp', ['-r', installed(), join(where, 'knead-cad')]);
  await runs(where);
});

it('a module worker', async () => {
  const where = page('module-worker', `const worker = new Worker('./work.js', { type: 'module' });
worker.onmessage = ({ data }) => { globalThis.result = data; };`);
  execFileSync('cp', ['-r', installed(), join(where, 'knead-cad')]);
  writeFileSync(join(where, 'work.js'), `${program('./knead-cad/dist/index.js')}\npostMessage(globalThis.result);`);
  await runs(where);
});

it.each(entries)('esbuild bundles %s', async (entry) => {
  const where = page(`esbuild-${entry.replace('/', '-')}`, program(entry), 'source.js');
  await bundle({ absWorkingDir: where, entryPoints: ['source.js'], outfile: join(where, 'page.js'), bundle: true, format: 'esm', logLevel: 'error' });
  expect(readFileSync(join(where, 'page.js'), 'utf8')).not.toMatch(/["']node:/);
  writeFileSync(join(where, 'index.html'), '<!doctype html><script type="module" src="./page.js"></script>');
  await runs(where);
});

it('Vite builds and serves it', async () => {
  const where = page('vite', entries.map((entry, k) => program(entry).replaceAll('globalThis.result', `globalThis.result${k}`).replace('open, KneadError', `open as open${k}, KneadError as KneadError${k}`)
    .replaceAll('await open(', `await open${k}(`).replaceAll('instanceof KneadError', `instanceof KneadError${k}`)).join('') +
    `globalThis.result = JSON.stringify(result0) === JSON.stringify(result1) ? result0 : { result0, result1 };\n`);
  await build({ root: where, configFile: false, logLevel: 'error', build: { target: 'es2022', chunkSizeWarningLimit: 4000 } });
  expect(readdirSync(join(where, 'dist/assets')).length).toBeGreaterThan(0);
  await runs(join(where, 'dist'));
  mkdirSync(join(where, 'public'), { recursive: true });
  copyFileSync(join(root, 'samples/bonnet.step'), join(where, 'public/bonnet.step'));
  const server = await createServer({ root: where, configFile: false, logLevel: 'error', server: { host: '127.0.0.1', port: 0 }, cacheDir: join(where, '.vite') });
  await server.listen();
  const context = await browser.newContext();
  try {
    const { page: shown } = await visit(context, server.resolvedUrls!.local[0]!);
    expect(await result(shown)).toEqual(done);
  } finally {
    await context.close();
    await server.close();
  }
});

it('the template for Vite is built', async () => {
  const where = directory('template');
  for (const file of ['index.html', 'page.ts', 'package.json']) copyFileSync(join(root, 'examples/npm', file), join(where, file));
  await build({ root: where, configFile: false, logLevel: 'error', build: { chunkSizeWarningLimit: 4000 } });
  const site = await serve(join(where, 'dist'));
  const context = await browser.newContext();
  try {
    const { page: shown } = await visit(context, `${site.url}/index.html`);
    await shown.setInputFiles('#file', join(root, 'samples/bonnet.step'));
    await shown.waitForSelector('#result:not([hidden])', { timeout: 60_000 });
    expect(await shown.textContent('#message')).toMatch(/^bonnet skin moved by up to \d/);
  } finally {
    await context.close();
    await site.close();
  }
});

// What the registry must give for this.
describe.runIf(process.env.KNEAD_LONG)('with the registry of npm', () => {
  it('webpack bundles it', async () => {
    const where = page('webpack', program('knead-cad'), 'source.js');
    writeFileSync(join(where, 'package.json'), '{ "private": true, "type": "module" }');
    await run(where, 'npm', 'install', '--no-audit', '--no-fund', '--silent', 'webpack@5', 'webpack-cli@5');
    await run(where, 'npx', 'webpack', './source.js', '--mode', 'production', '--output-path', '.', '--output-filename', 'page.js');
    writeFileSync(join(where, 'index.html'), '<!doctype html><script type="module" src="./page.js"></script>');
    await runs(where);
  }, 300_000);

  it.each(['18', '20'])('Node %s runs it', async (version) => {
    const where = directory(`node-${version}`);
    writeFileSync(join(where, 'package.json'), '{ "private": true, "type": "module" }');
    await run(where, 'npm', 'install', '--no-audit', '--no-fund', '--silent', `node@${version}`);
    const node = join(where, 'node_modules/node/bin/node');
    expect(await run(where, node, '--version')).toMatch(new RegExp(`^v${version}\\.`));
    for (const entry of entries) {
      writeFileSync(join(where, 'six.mjs'), program(entry).replace("await (await fetch('/bonnet.step')).arrayBuffer()", `(await import('node:fs')).readFileSync('${join(root, 'samples/bonnet.step')}')`)
        + 'console.log(JSON.stringify(globalThis.result));\n');
      expect(JSON.parse(await run(where, node, 'six.mjs'))).toEqual(done);
    }
  }, 300_000);
});
