// The first stroke after a page was opened, in headless Chromium:  node bench/first.mjs [directory ...]
// Every time in a browser of its own, with nothing kept and no engine warmed by another page, so long after a sheet of the
// gallery was shown, by what the page sends while a pointer presses and drags. Worker: commands and pictures of a frame.
// Round trip: from the request until the page has drawn.
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

import { serve } from '../serve.mjs';
import { chromiumOptions, firstStroke, median, ms, nets, worst } from './stroke.mjs';

const directories = process.argv.length > 2 ? process.argv.slice(2) : [fileURLToPath(new URL('../dist', import.meta.url))];
const waits = [0, 1000, 3000];
const times = 3;

/** The frames of the stroke, in order. */
async function stroke(url, net, wait) {
  const browser = await chromium.launch(chromiumOptions);
  const page = await browser.newPage({ viewport: { width: 640, height: 420 } });
  await page.goto(url, { waitUntil: 'commit' });
  await page.waitForSelector('html[data-ready]', { state: 'attached', timeout: 60_000 });
  const frames = await page.evaluate(
    async ([sheetOf, requests, before]) => {
      const { studio } = window;
      const { state } = studio;
      if (state.surfaces[0].net[0] !== sheetOf) {
        const commands = await studio.client.query('journal').then(JSON.parse);
        await studio.documents.startFresh('bench', commands.map((c) => (c.do === 'new' ? { ...c, net: [sheetOf, sheetOf] } : c)));
      }
      await new Promise((resolve) => setTimeout(resolve, before));
      const found = [];
      for (const [k, commands] of requests.entries()) {
        const shown = studio.frame, begin = performance.now();
        await studio.client.execute(commands, k > 0);
        while (studio.frame === shown) await new Promise((resolve) => setTimeout(resolve, 0));
        const { computeTime, pictureTime } = studio.frame;
        await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve, 0)));
        found.push({ worker: computeTime + pictureTime, trip: performance.now() - begin });
      }
      return found;
    },
    [net, firstStroke, wait],
  );
  await browser.close();
  return frames;
}

const servers = await Promise.all(directories.map((directory) => serve(directory)));
for (const net of nets) {
  console.log(`first stroke on ${net} x ${net} control points, milliseconds, ${times} times in turn`);
  console.log('after shown   worker: first    worst    10th    above 50   round trip: worst   directory');
  for (const wait of waits) {
    const runs = directories.map(() => []);
    for (let k = 0; k < times; ++k) {
      for (const [at, server] of servers.entries()) runs[at].push(await stroke(server.url, net, wait));
    }
    for (const [at, directory] of directories.entries()) {
      const of = (pick) => runs[at].map(pick);
      const sorted = of((frames) => frames.map((f) => f.worker).sort((a, b) => b - a));
      console.log(`${String(wait).padStart(11)}       ${ms(median(of((f) => f[0].worker)))}${ms(worst(sorted.map((s) => s[0])))}` +
        `${ms(median(sorted.map((s) => s[9])))}    ${sorted.map((s) => s.filter((t) => t > 50).length).join(' ').padStart(8)}` +
        `   ${ms(worst(of((frames) => worst(frames.map((f) => f.trip)))))}            ${directory}`);
    }
  }
}
for (const server of servers) await server.close();
