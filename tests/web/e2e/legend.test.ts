import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { facesStep } from '../faces_step';
import { directoryOfFile, openFile, scene, settled, studioOfFile } from './page';
import { pixels, quantile, raise, setDisplay } from './pixels';

const studio = studioOfFile({ width: 1100, height: 720 });
const directory = directoryOfFile();

const legend = () => studio.page.locator('.legend-card');
const ticks = () => legend().locator('.legend-ticks span').allTextContents();
const colour = (name: string) => studio.page.locator('select[aria-label="Colour by"]').selectOption(name);
/** What the test reads of a frame. */
interface Shown {
  late: boolean;
  range: { upper: number } | null;
}
const number = (text: string) => Number(text.replace('−', '-'));

describe('the range of colours', () => {
  it('is dragged at the ends of the legend, follows again at a double click, and says what lies beyond', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await raise(page, 11, 25);
    await colour('deviation');
    await settled(page);
    expect(number((await ticks())[4]!)).toBeGreaterThanOrEqual(10.5); // the bump as it came out
    expect(await legend().locator('.legend-beyond').innerText()).toBe('');
    const before = number((await ticks())[4]!);
    const bar = (await legend().locator('.legend-bar').boundingBox())!;
    const handle = legend().getByRole('slider', { name: 'Upper end of the colours' });
    const box = (await handle.boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(bar.x + 0.75 * bar.width, box.y + 5, { steps: 4 });
    await page.mouse.up();
    await settled(page);
    const dragged = await ticks();
    expect(Math.abs(number(dragged[4]!) / before - 0.5)).toBeLessThan(0.05);
    expect(number(dragged[0]!)).toBe(-number(dragged[4]!));
    expect(await legend().locator('.legend-beyond').innerText()).toMatch(/^up to 1\d(\.\d+)? ▸$/);
    await handle.press('ArrowRight');
    await settled(page);
    expect(number((await ticks())[4]!)).toBeGreaterThan(number(dragged[4]!));
    await legend().locator('.legend-track').dblclick({ position: { x: 60, y: 5 } });
    await settled(page);
    expect(number((await ticks())[4]!)).toBe(before);
    expect(await legend().locator('button', { hasText: 'Auto' }).isVisible()).toBe(false);
  });

  it('of the mean curvature shows a bump whose edge is sharper than the rest', async () => {
    const { page } = studio;
    await colour('mean');
    await setDisplay(page, { isocurves: false });
    await settled(page);
    // Colour is the distance from grey: over the bump it is plain.
    const strong = (await pixels(page)).filter(({ r }) => r < 20).map(({ rgb }) => Math.max(...rgb) - Math.min(...rgb));
    expect(strong.reduce((sum, x) => sum + x, 0) / strong.length).toBeGreaterThan(60);
  });
});

it('deviations within the tolerance are grey, those beyond it are not', async () => {
  const { page } = studio;
  await colour('deviation');
  await settled(page);
  await page.locator('input[aria-label="Tolerance"]').fill('4');
  await page.keyboard.press('Enter');
  await setDisplay(page, { isocurves: false });
  await settled(page);
  const all = (await pixels(page)).filter(({ r }) => r < 90);
  const colourful = ({ rgb }: { rgb: number[] }) => Math.max(...rgb) - Math.min(...rgb);
  const within = all.filter(({ z }) => z < 3.8).map(colourful);
  const beyond = all.filter(({ z }) => z > 4.3).map(colourful);
  expect(within.length).toBeGreaterThan(100);
  expect(beyond.length).toBeGreaterThan(100);
  // But for points whose pixel lies on the other side of the edge.
  expect(quantile(within, 0.99)).toBeLessThan(8);
  expect(quantile(beyond, 0.01)).toBeGreaterThan(40);
});

it('the thickness is the distance to the face behind, and the legend says so', async () => {
  const { page } = studio;
  const path = join(directory, 'thick.step'); // a disc 4 above a grey square
  writeFileSync(path, facesStep());
  await openFile(page, path);
  await colour('thickness');
  await settled(page);
  await expect.poll(async () => number((await ticks()).at(-1)!)).toBe(4);
  // While something moves the colours are those before; at rest those of the new shape: all of it a millimetre higher.
  // Every frame is looked at, since rest comes a quarter of a second after the command, whoever asks.
  const seen = await page.evaluateHandle(async () => {
    const { studio } = window as never as { studio: { client: { onFrame(f: Shown): void }; execute(c: object[]): Promise<unknown> } };
    const shown: { late: boolean; upper: number }[] = [];
    const show = studio.client.onFrame;
    studio.client.onFrame = (frame) => {
      shown.push({ late: frame.late, upper: frame.range!.upper });
      show(frame);
    };
    await studio.execute([{ do: 'release' }, { do: 'points', rows_u: [0, 1, 2, 3, 4], by: [0, 0, 1] }]);
    return shown;
  });
  await expect.poll(async () => number((await ticks()).at(-1)!)).toBe(5);
  const frames = await seen.jsonValue();
  expect(frames.map(({ late }) => late)).toEqual(frames.map((_, k) => k < frames.length - 1));
  expect(frames.length).toBeGreaterThan(1);
  for (const { late, upper } of frames) expect(upper).toBeCloseTo(late ? 4 : 5, 9);
});
