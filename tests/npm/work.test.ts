import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import type { Browser, BrowserContext } from 'playwright-core';

import { launch, serve, type Site, visit } from './pages';
import { directory, installed } from './support';

// Long work and memory in a page.

type Package = typeof import('../../bindings/npm/src/worker'); // whose calls are those of the others with promises
declare global {
  var knead: Package; // eslint-disable-line no-var
}

let browser: Browser, site: Site, context: BrowserContext;
beforeAll(async () => {
  const where = directory('work');
  execFileSync('cp', ['-r', installed(), join(where, 'knead-cad')]);
  writeFileSync(join(where, 'index.html'), '<!doctype html>');
  [browser, site] = await Promise.all([launch(), serve(where)]);
});
afterAll(() => Promise.all([browser.close(), site.close()]));
beforeEach(async () => {
  context = await browser.newContext();
});
afterEach(() => context.close());

async function pageWith(entry: string, isolated = false) {
  const isolation: Record<string, string> = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' };
  site.headers = () => (isolated ? isolation : {});
  const { page } = await visit(context, `${site.url}/index.html`);
  await page.addScriptTag({ type: 'module', content: `import * as knead from '/knead-cad/dist/${entry}.js'; globalThis.knead = knead;` });
  await page.waitForFunction(() => 'knead' in globalThis);
  return page;
}

it.each([[true, 'whole steps stay'], [false, 'all of the command is taken back']])('a signal ends a command in a worker; isolated: %s, %s', async (isolated) => {
  const page = await pageWith('worker', isolated);
  const told = await page.evaluate(async () => {
    const doc = await knead.create();
    await doc.new({ size: [100, 100], net: [30, 30] }).hold(2).tool({ name: 'ball', radius: 20, position: [50, 50, 10] }).step(2);
    const abort = new AbortController();
    let told = 0, stopped = 0, name = '';
    try {
      await doc.step(100_000, { signal: abort.signal, progress: (done) => {
        told = done;
        if (done === 3) {
          abort.abort();
          stopped = performance.now();
        }
      } });
    } catch (error) {
      name = (error as Error).name;
    }
    const time = performance.now() - stopped;
    const { steps } = await doc.state;
    await doc.step(1).undo();
    return { isolated: globalThis.crossOriginIsolated, name, told, steps, time, after: (await doc.state).steps, surfaces: (await doc.surfaces).length };
  });
  expect(told).toMatchObject({ isolated, name: 'AbortError', surfaces: 1 });
  expect(told.steps === 2).toBe(!isolated);
  expect(told.steps).toBeGreaterThanOrEqual(2);
  expect(told.after).toBe(told.steps);
  expect(told.time).toBeLessThan(isolated ? 300 : 2000);
});

it('what progress throws in a page ends the command in the worker', async () => {
  const page = await pageWith('worker', true);
  const told = await page.evaluate(async () => {
    const doc = await knead.create();
    await doc.new({ size: [100, 100], net: [12, 12] }).hold(2).tool({ name: 'ball', radius: 20, position: [50, 50, 10] });
    const error = await doc.step(100_000, { progress: () => { throw new RangeError('mine'); } }).then(() => null, String);
    const stopped = (await doc.state).steps;
    await doc.step(100_000, { progress: (done) => done < 3 });
    return { error, few: stopped < 1000, fewer: (await doc.state).steps - stopped < 1000 };
  });
  expect(told).toEqual({ error: 'RangeError: mine', few: true, fewer: true });
});

it('arrays come over from a worker by themselves, and an error is the same error', async () => {
  const page = await pageWith('worker');
  const told = await page.evaluate(async () => {
    const doc = await knead.create();
    await doc.new({ size: [100, 100], net: [30, 30] });
    const [sheet] = await doc.surfaces;
    const { positions } = await sheet!.picture({ detail: 16 });
    const error = (await doc.step(-1).then(() => null, (e: unknown) => e)) as InstanceType<Package['KneadError']>;
    const late = await doc.step(-1).select('#1').then(() => 'done', () => 'refused');
    return { points: (await sheet!.controlPoints).length, positions: positions.constructor.name, knots: (await sheet!.shape).knots[1].constructor.name,
      known: error instanceof knead.KneadError, where: error.where, code: error.code, late, checked: (await doc.check({ gap: 0.1 })).passed,
      packed: (await doc.saveCompressed('sheet.stpZ')).constructor.name };
  });
  expect(told).toEqual({ points: 2700, positions: 'Float32Array', knots: 'Float64Array', known: true, where: 'count', code: 'out_of_range', late: 'refused', checked: true, packed: 'Uint8Array' });
});

/** Bytes of the process that runs the page. */
async function resident(): Promise<number> {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const sizes = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, 'utf8'))![1]) * 1024);
  return sizes.reduce((sum, size) => sum + size, 0);
}

it.each(['index', 'worker'])('%s: a hundred documents made and dropped leave no memory behind', async (entry) => {
  const page = await pageWith(entry);
  const collector = await context.newCDPSession(page);
  const sizes: number[] = [];
  const make = async (count: number) => {
    await page.evaluate(async (times) => {
      for (let k = 0; k < times; ++k) {
        const doc = await knead.create();
        await doc.new({ size: [100, 100], net: [24, 24] }).hold(2).tool({ name: 'ball', radius: 20, position: [50, 50, 10] }).step(1);
      }
    }, count);
    sizes.push(await resident());
  };
  const rest = async (): Promise<number> => {
    for (let k = 0; k < 3; ++k) {
      await collector.send('HeapProfiler.collectGarbage');
      await page.evaluate(() => new Promise((later) => setTimeout(later, 200)));
    }
    return resident();
  };
  await make(entry === 'worker' ? 40 : 5); // threads have pools of memory, which are filled once: three hundred leave no more than a hundred
  const before = await rest();
  for (let k = 0; k < 5; ++k) await make(20);
  const after = await rest();
  const mebibytes = (size: number) => (size / 2 ** 20).toFixed(0);
  console.log(`${entry}: ${mebibytes(before)} MiB before, ${mebibytes(after)} after, ${sizes.map(mebibytes).join(', ')} meanwhile`);
  expect(after).toBeLessThan(before + 80 * 2 ** 20);
  expect(Math.max(...sizes)).toBeLessThan(1.5 * 2 ** 30);
});
