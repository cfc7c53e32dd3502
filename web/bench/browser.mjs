// The built page (dist/) in headless Chromium:  node bench/browser.mjs [directory ...]
// How soon it shows something and is ready, in windows with nothing kept; then the same stroke as in steps.mjs.
// Worker: commands and pictures of a frame, as the page shows them. Round trip: from the request until the page has drawn.
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

import { serve } from '../serve.mjs';
import { accuracies, chromiumOptions, least, median, ms, nets, places, sheet, worst } from './stroke.mjs';

const directories = process.argv.length > 2 ? process.argv.slice(2) : [fileURLToPath(new URL('../dist', import.meta.url))];
const browser = await chromium.launch(chromiumOptions);

/** Milliseconds from the request of the page until something is drawn, and until it can be sculpted. */
async function start(url, page) {
  const begin = performance.now();
  await page.goto(url, { waitUntil: 'commit' });
  await page.waitForSelector('html[data-ready]', { state: 'attached', timeout: 60_000 });
  const ready = performance.now() - begin;
  // It is told some time after.
  const painted = () => page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
  let paint = await painted();
  while (paint === undefined) paint = await painted();
  return { paint, ready };
}

const pages = [];
for (const directory of directories) {
  const server = await serve(directory);
  const page = await browser.newPage({ viewport: { width: 640, height: 420 } });
  const { ready } = await start(server.url, page);
  pages.push({ directory, server, page, ready });
}

console.log('start with an empty cache, milliseconds, 9 times in turn');
console.log('first paint: median    worst   ready: median    worst  directory');
const starts = pages.map(() => []);
for (let k = 0; k < 9; ++k) {
  for (const [at, { server }] of pages.entries()) {
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
    starts[at].push(await start(server.url, await context.newPage()));
    await context.close();
  }
}
for (const [at, { directory }] of pages.entries()) {
  const of = (name) => starts[at].map((s) => s[name]);
  console.log(`          ${ms(median(of('paint')))}${ms(worst(of('paint')))}        ${ms(median(of('ready')))}${ms(worst(of('ready')))}  ${directory}`);
}

for (const [net, accuracy] of nets.flatMap((n) => accuracies.map((a) => [n, a]))) {
  console.log(`${accuracy} steps, ${net} x ${net} control points, milliseconds`);
  console.log('worker: median    least    worst   round trip  of the first  long tasks  ready  directory');
  for (const { directory, page, ready } of pages) {
    await page.bringToFront();
    const times = await page.evaluate(
      async ([commands, strokes]) => {
        const { studio } = window;
        await studio.documents.startFresh('bench', commands);
        const worker = [], trip = [], first = [];
        const long = [];
        const observer = new PerformanceObserver((list) => long.push(...list.getEntries().map((e) => e.duration)));
        observer.observe({ type: 'longtask' });
        for (const measured of [false, true]) {
          for (const [k, stroke] of strokes.entries()) {
            const begin = performance.now();
            const drawn = new Promise((resolve) => requestAnimationFrame(() => resolve()));
            await studio.client.execute(stroke, k > 0);
            await drawn;
            const { computeTime, pictureTime } = studio.frame;
            if (measured) {
              worker.push(computeTime + pictureTime);
              trip.push(performance.now() - begin);
            } else first.push(computeTime + pictureTime);
          }
          await studio.client.execute([{ do: 'undo' }]);
        }
        observer.disconnect();
        return { worker, trip, first, long };
      },
      [sheet(net, accuracy), places],
    );
    console.log(
      `     ${ms(median(times.worker))}${ms(least(times.worker))}${ms(worst(times.worker))}    ${ms(median(times.trip))}     ${ms(worst(times.first))}` +
        `    ${String(times.long.length).padStart(8)}  ${ready.toFixed(0).padStart(5)}  ${directory}`,
    );
  }
}
await browser.close();
for (const { server } of pages) await server.close();
