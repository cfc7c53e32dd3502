import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { directoryOfFile, downloaded, studioOfFile } from './page';
import { writePng16 } from './png16';

const studio = studioOfFile({ width: 820, height: 560 });
const directory = directoryOfFile();

const [size, middle, radius] = [96, [46.3, 49.6] as const, 22.4];

const snakes = () => studio.page.locator('.snakes');
const button = (label: string) => snakes().locator(`button[aria-label^="${label}"]`);
const running = () => snakes().getAttribute('data-running');

/** A disc as PNG, made by the page's canvas, and dropped. */
async function dropDisc(): Promise<void> {
  await studio.page.evaluate(async ([n, x, y, r]) => {
    const canvas = new OffscreenCanvas(n!, n!), context = canvas.getContext('2d')!, image = new ImageData(n!, n!);
    for (let k = 0; k < n! * n!; ++k) {
      const share = Math.min(1, Math.max(0, r! + 0.5 - Math.hypot((k % n!) - x!, Math.floor(k / n!) - y!)));
      const v = Math.round(30 + 200 * share);
      image.data.set([v, v, v, 255], 4 * k);
    }
    context.putImageData(image, 0, 0);
    const data = new DataTransfer();
    data.items.add(new File([await canvas.convertToBlob({ type: 'image/png' })], 'disc.png', { type: 'image/png' }));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [size, ...middle, radius]);
  await snakes().locator('.snakes-status', { hasText: `${size} × ${size} pixels` }).waitFor();
}

/** Where a pixel of the image is on the screen: fitted with 12 pixels of margin. */
async function at([x, y]: readonly [number, number]): Promise<[number, number]> {
  const box = (await snakes().locator('.snakes-view').boundingBox())!;
  const scale = Math.min((box.width - 24) / size, (box.height - 24) / size);
  return [box.x + box.width / 2 + (x - (size - 1) / 2) * scale, box.y + box.height / 2 + (y - (size - 1) / 2) * scale];
}

async function drag(...places: (readonly [number, number])[]): Promise<void> {
  const { mouse } = studio.page;
  await mouse.move(...(await at(places[0]!)));
  await mouse.down();
  for (const place of places.slice(1)) await mouse.move(...(await at(place)), { steps: 2 });
}

async function save(entry: string): Promise<string> {
  await snakes().locator('summary[aria-label^=Save]').click();
  const item = snakes().locator('.menu-item').filter({ has: studio.page.locator(`b:text-is("${entry}")`) });
  const [download] = await Promise.all([studio.page.waitForEvent('download'), item.click()]);
  expect(download.suggestedFilename()).toMatch(/^disc-/);
  return downloaded(download);
}

/** Distances of the saved contours' points from a place. */
async function distances([x, y]: readonly [number, number]): Promise<number[]> {
  const lines = (await save('Contours, CSV')).trim().split('\n').slice(1).map((line) => line.split(',').map(Number));
  return lines.map(([, px, py]) => Math.hypot(px! - x, py! - y));
}

const mean = (all: number[]) => all.reduce((sum, x) => sum + x, 0) / all.length;

async function runToRest(): Promise<void> {
  await button('Run or stop').click();
  await expect.poll(() => snakes().locator('.snakes-status').textContent()).toContain('at rest');
  expect(await running()).toBe('false');
}

it('an image that is dropped is shown, and a snake drawn by hand beside a disc runs onto its edge', async () => {
  await dropDisc();
  const circle = Array.from({ length: 25 }, (_, k) => [40 + 33 * Math.cos((2 * Math.PI * k) / 25), 52 + 33 * Math.sin((2 * Math.PI * k) / 25)] as const);
  await drag(...circle);
  await studio.page.mouse.up();
  await snakes().locator('path.snake').waitFor();
  await runToRest();
  const away = await distances(middle);
  expect(Math.abs(mean(away) - radius)).toBeLessThan(0.1);
  expect(Math.max(...away.map((d) => Math.abs(d - radius)))).toBeLessThan(0.3);
});

it('a control point is dragged, and Again takes the snake back to where it was drawn', async () => {
  await button('Drag control points').click();
  const point = snakes().locator('.snake-point').first();
  const box = (await point.boundingBox())!;
  await studio.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await studio.page.mouse.down();
  await studio.page.mouse.move(...(await at([90, 90])), { steps: 4 });
  await studio.page.mouse.up();
  await expect.poll(async () => Math.max(...(await distances(middle)))).toBeGreaterThan(30);
  await button('All snakes again').click();
  await expect.poll(async () => Math.abs(mean(await distances([40, 52])) - 33)).toBeLessThan(0.6);
  await runToRest();
});

it('a spring of the hand draws the contour while it is held, and lets it go', async () => {
  const right = [middle[0] + radius, middle[1]] as const;
  await snakes().locator('select[aria-label="Kind of energy"]').selectOption('Edges');
  await runToRest();
  await button('Draw a contour').click();
  await drag(right, [80, 50]);
  await expect.poll(() => running()).toBe('true');
  await expect.poll(async () => (await snakes().locator('path.snake').getAttribute('d'))!.match(/-?[\d.]+ /g)!.reduce((most, x) => Math.max(most, Number(x)), 0))
    .toBeGreaterThan((await at([75, 50]))[0] - (await snakes().locator('.snakes-view').boundingBox())!.x);
  expect(await snakes().locator('.spring').count()).toBe(1);
  await studio.page.mouse.up();
  await expect.poll(() => snakes().locator('.snakes-status').textContent()).toContain('at rest');
  expect(await snakes().locator('.spring').count()).toBe(0);
  expect(Math.abs(mean(await distances(middle)) - radius)).toBeLessThan(0.5);
});

it('a second snake and a volcano are in the script, and settings that cannot be are refused with the reason', async () => {
  await button('Draw an ellipse').click();
  await drag([8, 8], [20, 16]);
  await studio.page.mouse.up();
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(2);
  await button('Put a volcano').click();
  const { mouse } = studio.page;
  await mouse.click(...(await at([80, 80])));
  await snakes().locator('button', { hasText: 'Remove the volcano' }).waitFor();
  const stretch = snakes().locator('input[aria-label="Stretch α"]');
  await stretch.fill('-1');
  await stretch.press('Enter');
  await expect.poll(() => snakes().locator('.refusal').textContent()).toMatch(/-1|alpha|range/);
  await stretch.press('Escape');
  const script = JSON.parse(await save('Script')) as { knead: number; image: { edge: number }; settings: { volcanoes: { at: number[] }[] }; snakes: { shape: string; radii?: number[] }[] };
  expect(script).toMatchObject({ knead: 2, image: { edge: 1 }, snakes: [{ shape: 'points' }, { shape: 'ellipse' }] });
  expect(script.settings.volcanoes[0]!.at[0]).toBeCloseTo(80, 0);
  const json = JSON.parse(await save('Contours, JSON')) as { image: string; snakes: { control_points: number[][] }[] };
  expect(json).toMatchObject({ image: 'disc.png', width: size, height: size });
  expect(json.snakes.map((s) => s.control_points.length)).toEqual([43, 43]);
  expect(await save('Contours, SVG')).toContain('<polygon');
  await snakes().locator('summary[aria-label^=Save]').click();
  const [download] = await Promise.all([studio.page.waitForEvent('download'), snakes().locator('.menu-item', { hasText: 'Mask' }).click()]);
  const path = join(directory, 'mask.png');
  await download.saveAs(path);
  expect([...readFileSync(path).subarray(1, 4)].map((c) => String.fromCharCode(c)).join('')).toBe('PNG');
});

const key = (keys: string) => studio.page.keyboard.press(keys);
const shown = () => snakes().locator('.snakes-lines').innerHTML();

it('what was done is taken back step by step, and done again', async () => {
  const undo = button('Undo'), redo = button('Redo'), script = () => save('Script'), contours = () => save('Contours, JSON');
  expect(await undo.isDisabled()).toBe(false);
  expect(await redo.isDisabled()).toBe(true);
  const withAll = await script(), lines = await contours();
  await key('Control+z'); // the volcano
  await expect.poll(() => snakes().locator('.volcano').count()).toBe(0);
  await key('Control+z'); // the ellipse
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(1);
  expect(JSON.parse(await script())).toMatchObject({ snakes: [{ shape: 'points' }] });
  await key('Control+y');
  await key('Control+Shift+z');
  await expect.poll(() => snakes().locator('.volcano').count()).toBe(1);
  expect(await script()).toBe(withAll);
  expect(await contours()).toBe(lines);
  expect(await redo.isDisabled()).toBe(true);
  // A run, from where it began.
  const before = await shown();
  await runToRest();
  expect(await shown()).not.toBe(before);
  const ran = await contours();
  await undo.click();
  await expect.poll(contours).toBe(lines);
  expect(await shown()).toBe(before);
  await redo.click();
  await expect.poll(contours).toBe(ran);
  expect(await snakes().locator('.snakes-status').textContent()).toContain('at rest'); // as it was
  // A drag of a control point, of many moves, is one entry.
  await button('Drag control points').click();
  const box = (await snakes().locator('.snake-point').first().boundingBox())!;
  await studio.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await studio.page.mouse.down();
  await studio.page.mouse.move(box.x + 40, box.y + 30, { steps: 6 });
  await studio.page.mouse.up();
  await expect.poll(contours).not.toBe(ran);
  await key('Control+z');
  await expect.poll(contours).toBe(ran);
  // A setting, and what the history forgets: a new entry ends what was to be done again.
  const motion = snakes().locator('input[aria-label="Bend β"]'), bend = await motion.inputValue();
  await motion.fill('77');
  await motion.press('Enter');
  await expect.poll(async () => (JSON.parse(await script()) as { settings: { beta: number } }).settings.beta).toBe(77);
  expect(await redo.isDisabled()).toBe(true);
  await undo.click();
  await expect.poll(() => motion.inputValue()).toBe(bend);
  expect(await contours()).toBe(ran);
});

it('what was just drawn runs, and is taken back, without a wait', async () => {
  const { mouse } = studio.page;
  await button('Redo').click();
  await expect.poll(() => button('Redo').isDisabled()).toBe(true);
  await key('e');
  await drag([60, 60], [80, 84]);
  await mouse.up();
  await key(' ');
  await key('Control+z');
  await key('Control+z');
  await expect.poll(() => button('Redo').isDisabled()).toBe(false);
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(2);
  expect(await running()).toBe('false');
  expect(await studio.page.locator('.notice', { hasText: 'Draw a snake' }).count()).toBe(0);
});

it('both snakes are removed, by the key and the list, and come back', async () => {
  await snakes().locator('.snakes-view').focus();
  await key('Delete');
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(1);
  await button('Remove snake 1').click();
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(0);
  await key('Control+z');
  await key('Control+z');
  await expect.poll(() => snakes().locator('path.snake').count()).toBe(2);
});

it('what is no image is refused with its name, and the one before stays', async () => {
  const path = join(directory, 'empty.png');
  for (const bytes of [new Uint8Array(), readFileSync(join(directory, 'mask.png')).subarray(0, 60)]) {
    writeFileSync(path, bytes);
    await snakes().locator('input[type=file][aria-label="Image to open"]').setInputFiles(path);
    await studio.page.locator('dialog.question button', { hasText: 'Open it' }).click();
    const refused = studio.page.locator('.notice', { hasText: 'empty.png' });
    await refused.first().waitFor();
    expect(await refused.first().textContent()).toMatch(/no image that the browser can read/);
    await refused.first().locator('button').last().click();
    expect(await snakes().locator('path.snake').count()).toBe(2);
    expect(await snakes().locator('.snakes-status').textContent()).toContain(`${size} × ${size} pixels`);
  }
});

it('of 16 bits a channel it says that they become 8, and closing leads back to the surfaces', async () => {
  const path = join(directory, 'deep.png');
  writePng16(path, 24, 16);
  await snakes().locator('input[type=file][aria-label="Image to open"]').setInputFiles(path);
  await studio.page.locator('dialog.question button', { hasText: 'Open it' }).click();
  await snakes().locator('.notice', { hasText: '16 bits' }).waitFor();
  await button('Close the image').click();
  expect(await snakes().count()).toBe(0);
  expect(await studio.page.locator('.stage > .notices').count()).toBe(1);
  expect(await studio.page.locator('#studio > [inert]').count()).toBe(0);
});
