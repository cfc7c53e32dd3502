// Takes the pictures of docs/ from the real page:  node pictures.mjs
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

import { drawGallery, openScene } from './gallery_pictures.mjs';
import { serve } from './serve.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const server = await serve(here('dist'));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--no-first-run'],
});
const page = await browser.newPage({ viewport: { width: 1180, height: 720 } });
await page.addInitScript(() => localStorage.setItem('knead-tour', '1'));
await page.goto(server.url);
await page.waitForSelector('html[data-ready]', { state: 'attached' });

const box = await page.locator('.view-perspective').boundingBox();
const at = ([x, y]) => [box.x + box.width * x, box.y + box.height * y];
const pause = (milliseconds = 700) => page.waitForTimeout(milliseconds);
const scene = (name) => openScene(page, name);
const stroke = async (...places) => {
  await page.mouse.move(...at(places[0]));
  await page.mouse.down();
  for (const place of places) {
    await page.mouse.move(...at(place), { steps: 4 });
    await pause(100);
  }
  await page.mouse.up();
  await pause(400);
};
const picture = async (name) => {
  await page.mouse.move(...at([0.02, 0.02]));
  await pause();
  await page.screenshot({ path: here(`../docs/pictures/${name}.png`) });
};
const theme = async (wanted) => {
  if ((await page.locator('html').getAttribute('data-theme')) !== wanted) await page.locator('button[aria-label="Light or dark"]').click();
};

await theme('dark');
await scene('Bonnet');
await page.keyboard.press('b');
await page.locator('input[aria-label="Brush radius in units"]').fill('90');
await page.keyboard.press('Enter');
await stroke([0.42, 0.56], [0.5, 0.51], [0.58, 0.48]);
await page.keyboard.press('u');
await stroke([0.57, 0.57], [0.64, 0.53]);
await picture('studio');

await page.locator('select[aria-label="Colour by"]').selectOption('deviation');
await picture('studio-deviation');
await page.locator('select[aria-label="Colour by"]').selectOption('none');
await page.keyboard.press('z');
await picture('studio-zebra');
await page.keyboard.press('z');

// A scan of the bonnet bent upwards: random points of its triangles.
await scene('Bonnet');
const obj = await page.evaluate(async () => new TextDecoder().decode((await window.studio.client.query('file', { name: 'mesh.obj', tolerance: 0.5 })).file));
const rows = (word) => obj.split('\n').filter((line) => line.startsWith(`${word} `)).map((line) => line.split(/\s+/).slice(1).map(parseFloat));
const corners = rows('v');
let seed = 1;
const random = () => ((seed = (16807 * seed) % 2147483647), seed / 2147483647);
const points = rows('f').flatMap((face) => {
  const [a, b, c] = face.map((k) => corners[k - 1]);
  const p = b.map((x, d) => x - a[d]), q = c.map((x, d) => x - a[d]);
  const area = Math.hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]) / 2;
  return Array.from({ length: Math.floor(area / 150 + random()) }, () => {
    const s = Math.sqrt(random()), t = random();
    const [x, y, z] = a.map((at, d) => at + s * (1 - t) * p[d] + s * t * q[d]);
    return [x, y, z + 8 * Math.sin(x / 400) * Math.cos(y / 300)].join(' ');
  });
});
const follow = page.locator('.panel[data-panel="Follow data"]');
await follow.locator('summary').click();
await follow.locator('input[type=file]').setInputFiles({ name: 'scan.xyz', mimeType: 'text/plain', buffer: Buffer.from(points.join('\n')) });
await follow.locator('.verdict[data-state=compared]').waitFor({ timeout: 60_000 });
await picture('studio-follow');
await follow.locator('summary').click();

// A knot drawn onto its neighbour: the functions are less smooth there.
await page.locator('button[aria-label^="Basis functions"]').click();
await page.waitForSelector('.lab[data-drawn]');
const knot = async (k) => {
  const dot = await page.locator('.lab-knot').nth(k).locator('circle').first().boundingBox();
  return [dot.x + dot.width / 2, dot.y + dot.height / 2];
};
await page.mouse.move(...(await knot(4)));
await page.mouse.down();
await page.mouse.move(...(await knot(5)), { steps: 5 });
await page.mouse.up();
await pause(1200);
const map = await page.locator('.lab-map').first().boundingBox();
await page.mouse.move(map.x + (map.width * 6.5) / 14, map.y + (map.height * 5.5) / 14);
await pause();
await page.screenshot({ path: here('../docs/pictures/studio-lab.png') });
await page.locator('button[aria-label="Close the panel"]').click();

await theme('light');
await scene('Ball on a membrane');
for (let k = 0; k < 4; ++k) {
  await page.keyboard.press('.');
  await pause(150);
}
await page.keyboard.press('v');
await page.locator('.panel[data-panel=Tools] .item').click();
await page.keyboard.press('4');
await pause();
await page.keyboard.press('f');
await picture('studio-four-views');

// The bonnet as a sheet of steel, held at its edges, under a load of 100 N.
await theme('light');
await scene('Bonnet');
await page.evaluate(() => window.studio.execute([
  { do: 'refine', region: [[0, 1], [0, 1]] },
  { do: 'refine', region: [[0.1, 0.7], [0.2, 0.8]] },
  { do: 'material', model: 'shell', young: 210000, poisson: 0.3, thickness: 0.8, density: 7.85e-9 },
  { do: 'force', kind: 'dead', at: [0.4, 0.5], vector: [0, 0, -100] },
  { do: 'evolve', mode: 'static' }]));
await page.locator('select[aria-label="Colour by"]').selectOption('von_mises');
await pause();
await picture('analysis-stress');

await theme('dark');
await drawGallery(page, here('../docs/pictures/gallery'));

// What `make examples` draws of the analysis scripts.
for (const [drawn, name] of [['drape_in_folds', 'analysis-drape-in-folds'], ['drape_linear', 'analysis-drape-linear'],
  ['free_plate', 'analysis-plate'], ['buckling_can', 'analysis-can']]) {
  await page.setViewportSize({ width: 700, height: 500 });
  await page.goto(`file://${here(`../out/examples/${drawn}.svg`)}`);
  await page.locator('svg').screenshot({ path: here(`../docs/pictures/${name}.png`) });
}

await browser.close();
await server.close();
