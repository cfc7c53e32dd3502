import { ready, scene, settled, studioOfFile } from './page';
import { pixels, quantile, raise, setDisplay, setTheme, spread } from './pixels';

const studio = studioOfFile({ width: 1100, height: 720 });

describe('light', () => {
  it('makes a bump of 11 mm on a sheet of 200 mm plain to see from the first view', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await raise(page, 11, 25);
    await settled(page);
    await setDisplay(page, { isocurves: false, grid: false });
    for (const theme of ['dark', 'light'] as const) {
      await setTheme(page, theme);
      await settled(page);
      const found = await pixels(page);
      const bump = found.filter(({ r }) => r < 50).map(({ l }) => l);
      const flat = found.filter(({ r }) => r > 85 && r < 96).map(({ l }) => l);
      console.log(`${theme}: L* over the bump ${quantile(bump, 0.05).toFixed(1)} to ${quantile(bump, 0.95).toFixed(1)}, flat ${quantile(flat, 0.05).toFixed(1)} to ${quantile(flat, 0.95).toFixed(1)}`);
      expect(spread(bump), theme).toBeGreaterThan(30);
      expect(spread(flat), theme).toBeLessThan(spread(bump) / 10);
    }
  });
});

/** The mean colour of the middle of the sheet, shares of the sum. */
const hue = async () => {
  const { page } = studio;
  const near = (await pixels(page)).filter(({ r }) => r < 30);
  const sums = [0, 1, 2].map((c) => near.reduce((sum, { rgb }) => sum + rgb[c]!, 0));
  const all = sums[0]! + sums[1]! + sums[2]!;
  return sums.map((x) => x / all);
};

describe('looks', () => {
  const choose = (look: string) => studio.page.locator('select[aria-label="Look of surfaces"]').selectOption(look);

  it('are clay, red wax and chrome beside the studio\'s light, and zebra; the chosen one is remembered', async () => {
    const { page } = studio;
    await setDisplay(page, { isocurves: false });
    const hues: Record<string, number[]> = {};
    for (const look of ['studio', 'clay', 'wax', 'chrome']) {
      await choose(look);
      await settled(page);
      hues[look] = await hue();
    }
    expect(hues.clay![0]! - hues.studio![0]!).toBeGreaterThan(0.08);
    expect(hues.wax![0]!).toBeGreaterThan(0.55);
    expect(hues.chrome![2]! - hues.studio![2]!).toBeGreaterThan(0.02);
    await choose('zebra');
    await settled(page);
    const striped = (await pixels(page)).filter(({ r }) => r < 50).map(({ l }) => l);
    expect(spread(striped)).toBeGreaterThan(60);
    await page.keyboard.press('z');
    expect(await page.locator('select[aria-label="Look of surfaces"]').inputValue()).toBe('chrome');
    await page.reload();
    await ready(page);
    expect(await page.locator('select[aria-label="Look of surfaces"]').inputValue()).toBe('chrome');
    await choose('studio');
  });

  it('leave both sides of a surface alike until their tint is turned on, and it can be turned over', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await settled(page);
    const chip = (name: string) => page.locator('.panel[data-panel=Display] button', { hasText: name }).click();
    const seen = async () => {
      await settled(page);
      return (await hue())[0]!;
    };
    const front = await seen();
    await page.keyboard.press('Shift+Digit3');
    expect(Math.abs((await seen()) - front)).toBeLessThan(0.01);
    await chip('Sides');
    expect((await seen()) - front).toBeGreaterThan(0.03);
    await chip('Flip normals');
    expect(Math.abs((await seen()) - front)).toBeLessThan(0.01);
    await chip('Flip normals');
    await chip('Sides');
    await page.keyboard.press('Digit0');
  });
});

it('isocurves fade where they are dense on the screen', async () => {
  const { page } = studio;
  const mean = async (isocurves: boolean, times: number) => {
    await setDisplay(page, { isocurves });
    await page.evaluate((k) => {
      const { viewer } = (window as never as { studio: { viewer: { bounds(): { radius: number }; fit(b: unknown): void } } }).studio;
      const bounds = viewer.bounds();
      viewer.fit({ ...bounds, radius: k * bounds.radius });
    }, times);
    await settled(page);
    const inner = (await pixels(page)).filter(({ r }) => r < 60);
    return inner.reduce((sum, { l }) => sum + l, 0) / inner.length;
  };
  const cost = async (times: number) => (await mean(false, times)) - (await mean(true, times));
  expect(await cost(1)).toBeGreaterThan(1);
  expect(await cost(14)).toBeLessThan(0.5);
});
