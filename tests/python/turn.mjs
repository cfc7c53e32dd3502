// Opens a page in Chromium without network and drags over each model in it:  node turn.mjs WEB PAGE
// WEB is the folder of the studio, which has playwright-core. Prints, as JSON, what the page asked the network for, and of
// each model its pixels: all, drawn, changed while nothing was done, and changed by dragging.
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [web, file] = process.argv.slice(2);
const { chromium } = createRequire(pathToFileURL(`${web}/package.json`))('playwright-core');
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--no-first-run'],
});
const context = await browser.newContext({ viewport: { width: 900, height: 700 } });
await context.setOffline(true);
const page = await context.newPage();
const asked = [], errors = [];
page.on('request', (request) => asked.push(request.url()));
page.on('pageerror', (error) => errors.push(String(error)));
await page.goto(pathToFileURL(file).href);

const picture = (frame) => frame.evaluate(() => {
  const canvas = document.querySelector('canvas'), copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const flat = copy.getContext('2d');
  flat.drawImage(canvas, 0, 0);
  return [...new Uint32Array(flat.getImageData(0, 0, copy.width, copy.height).data.buffer)];
});
const changed = (a, b) => a.reduce((count, pixel, k) => count + (pixel !== b[k] ? 1 : 0), 0);
const models = [];
for (const element of await page.locator('iframe').elementHandles()) {
  await element.scrollIntoViewIfNeeded();
  const frame = await element.contentFrame(), box = await element.boundingBox();
  const first = await picture(frame), same = await picture(frame);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 40, { steps: 6 });
  await page.mouse.up();
  const turned = await picture(frame);
  models.push({ pixels: first.length, drawn: first.filter((pixel) => pixel !== 0xffffffff).length, restless: changed(first, same),
    turned: changed(first, turned) });
}
await browser.close();
console.log(JSON.stringify({ asked: asked.filter((url) => !/^(file|data|about|blob):/.test(url)), errors, models }));
