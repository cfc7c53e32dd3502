import { scene, settled, studioOfFile } from './page';

/** The radius of brushes in the unit of the file, in pixels, or as a share of what is selected. */

const studio = studioOfFile({ width: 1100, height: 700 });

interface App {
  hand: { brush: { settings: { radius: number } }; size: { value: number } };
  viewer: { main: { pixel(): number; placement(): { height: number }; restore(p: object): void } };
}
const now = () => studio.page.evaluate(() => {
  const { hand, viewer } = (window as never as { studio: App }).studio;
  return { radius: hand.brush.settings.radius, value: hand.size.value, pixel: viewer.main.pixel() };
});
const zoom = async (factor: number) => {
  await studio.page.evaluate((by) => {
    const { main } = (window as never as { studio: App }).studio.viewer;
    main.restore({ ...main.placement(), height: main.placement().height / by });
  }, factor);
  await settled(studio.page);
};
const unit = (name: string) => studio.page.locator('select[aria-label="Unit of the brush radius"]').selectOption(name);
const typed = async (text: string) => {
  const input = studio.page.locator('input[aria-label="Brush radius in units"]');
  await input.fill(text);
  await input.press('Enter');
};

it('stays a length, a number of pixels or a share, whatever is looked at', async () => {
  const { page } = studio;
  await scene(page, 'Clay sheet');
  await page.keyboard.press('b');
  await typed('12');
  await zoom(2);
  expect((await now()).radius).toBe(12);
  await unit('screen');
  await typed('40');
  expect((await now()).radius).toBeCloseTo(40 * (await now()).pixel, 6);
  await zoom(3);
  const near = await now();
  expect(near.radius).toBeCloseTo(40 * near.pixel, 6);
  expect(near.value).toBeCloseTo(40, 6);
  expect(await page.locator('input[aria-label="Brush radius in units"]').inputValue()).toBe('40');
  await page.evaluate(() => (document.activeElement as HTMLElement).blur());
  await page.keyboard.press('BracketRight'); // larger by the key, and it stays so
  const larger = (await now()).value;
  expect(larger).toBeGreaterThan(40);
  await zoom(0.5);
  expect((await now()).value).toBeCloseTo(larger, 6);
  await unit('face');
  await typed('5'); // of the sheet of 200 × 200
  expect((await now()).radius).toBeCloseTo(0.05 * 200 * Math.SQRT2, 3);
  await zoom(2);
  expect((await now()).radius).toBeCloseTo(0.05 * 200 * Math.SQRT2, 3);
});
