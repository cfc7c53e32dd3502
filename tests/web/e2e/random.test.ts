import { drawingErrors, openStudio, positions, settled, spot, type Studio } from './page';

let studio: Studio;
beforeAll(async () => {
  studio = await openStudio({ width: 700, height: 420 }); // software rendering: small is fast
});
afterAll(() => studio.close());

/** The same actions in every run. */
function dice(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const actions = process.env.KNEAD_LONG ? 400 : 100;

it('survives random actions of a user', async () => {
  const { page } = studio;
  const random = dice(20261121);
  const place = () => spot(page, (random() - 0.5) * 260, (random() - 0.5) * 200);
  const keys = ['b', 'u', 's', 'g', 'e', 'i', 'a', 'd', 'v', 't', 'p', 'f', 'z', '.', '1', '2', '3', '0', '4', '[', ']', 'Control+z', 'Control+Shift+z', 'Escape', '?',
    'm', 'n', 'k', 'Delete', 'Space'];
  await page.locator('.panel').evaluateAll((all) => all.forEach((e) => ((e as HTMLDetailsElement).open = true)));
  await page.locator('select[aria-label=Detail]').selectOption('48');
  let memory = 0;
  for (let k = 0; k < actions; ++k) {
    const choice = random();
    if (choice < 0.4) {
      await page.mouse.move(...(await place()));
      await page.mouse.down({ button: random() < 0.8 ? 'left' : 'right' });
      for (let j = 0; j < 3; ++j) await page.mouse.move(...(await place()), { steps: 2 });
      if (random() < 0.2) await page.keyboard.press('Escape');
      await page.mouse.up({ button: 'left' });
      await page.mouse.up({ button: 'right' });
    } else if (choice < 0.75) {
      await page.keyboard.press(keys[Math.floor(random() * keys.length)]!);
    } else if (choice < 0.9) {
      const chips = page.locator('.side .chip');
      const count = await chips.count();
      await chips.nth(Math.floor(random() * count)).click({ timeout: 2000 }).catch(() => {});
    } else {
      await page.mouse.move(...(await place()));
      await page.mouse.wheel(0, random() < 0.5 ? 120 : -120);
    }
    if (k % 10 === 9) expect(await drawingErrors(page)).toBe(0);
    if (k === actions / 2) memory = await page.evaluate(() => (window as never as { studio: { frame: { memory: number } } }).studio.frame.memory);
  }
  if (await page.evaluate(() => (window as never as { studio: { playing(): boolean } }).studio.playing())) await page.keyboard.press('Space');
  await settled(page);
  expect(studio.problems).toEqual([]);
  expect(studio.foreign).toEqual([]);
  expect((await positions(page)).every(Number.isFinite)).toBe(true);
  const after = await page.evaluate(() => (window as never as { studio: { frame: { memory: number } } }).studio.frame.memory);
  expect(after).toBeLessThan(Math.max(4 * memory, 256 * 2 ** 20));
}, 3000 * actions);
