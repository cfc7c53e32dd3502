import { openStudio, ready, scene, settled, type Studio } from './page';

let studio: Studio;
beforeAll(async () => {
  studio = await openStudio({ width: 1100, height: 720 });
});
afterAll(() => studio.close());
afterEach(() => {
  expect(studio.problems).toEqual([]);
  expect(studio.foreign).toEqual([]);
});

interface App {
  frame: { origin: number[]; pictures: { positions: Float32Array; net: Float32Array }[] };
  viewer: { picture(): Promise<Blob>; main: { projectAll(points: ArrayLike<number>): Float32Array }; element: HTMLElement };
  display: Record<string, unknown>;
  theme: 'light' | 'dark';
  execute(commands: unknown[]): Promise<unknown>;
  setDisplay(change: Record<string, unknown>): void;
  setTheme(theme: 'light' | 'dark'): void;
}

const setDisplay = (change: Record<string, unknown>) =>
  studio.page.evaluate((c) => (window as never as { studio: App }).studio.setDisplay(c), change);
const setTheme = (theme: 'light' | 'dark') => studio.page.evaluate((t) => (window as never as { studio: App }).studio.setTheme(t), theme);

/** Raises the middle of the sheet by h exp(−r²/2σ²), millimetres. */
const raise = (height: number, sigma: number) => studio.page.evaluate(async ([h, s]) => {
  const { studio: app } = window as never as { studio: App };
  const { net } = app.frame.pictures[0]!;
  const which: number[] = [];
  const to: number[][] = [];
  for (let k = 0; 3 * k < net.length; ++k) {
    const p = [0, 1, 2].map((d) => net[3 * k + d]! + app.frame.origin[d]!);
    const r = Math.hypot(p[0]! - 100, p[1]! - 100);
    if (r > 80) continue;
    which.push(k);
    to.push([p[0]!, p[1]!, h! * Math.exp((-r * r) / (2 * s! * s!))]);
  }
  await app.execute([{ do: 'points', which, to }]);
}, [height, sigma]);

/** The lightness L* (CIE 1976) of the picture at each point of the surface's grid, and the point's distance from the middle. */
const lightness = () => studio.page.evaluate(async () => {
  const { studio: app } = window as never as { studio: App };
  const { origin, pictures: [{ positions }] } = app.frame as never as { origin: number[]; pictures: [{ positions: Float32Array }] };
  const image = await createImageBitmap(await app.viewer.picture());
  const canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext('2d')!;
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  const box = app.viewer.element.getBoundingClientRect();
  const places = app.viewer.main.projectAll(positions);
  const linear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  return Array.from({ length: positions.length / 3 }, (_, k) => {
    const at = 4 * (Math.round(places[2 * k + 1]! - box.top) * image.width + Math.round(places[2 * k]! - box.left));
    const y = [0.2126, 0.7152, 0.0722].reduce((sum, w, c) => sum + w * linear(data[at + c]! / 255), 0);
    return { rgb: [data[at]!, data[at + 1]!, data[at + 2]!], r: Math.hypot(positions[3 * k]! + origin[0]! - 100, positions[3 * k + 1]! + origin[1]! - 100), l: y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y };
  });
});

const quantile = (list: number[], share: number): number => [...list].sort((a, b) => a - b)[Math.round(share * (list.length - 1))]!;
const spread = (list: number[]) => quantile(list, 0.95) - quantile(list, 0.05);

describe('light', () => {
  it('makes a bump of 11 mm on a sheet of 200 mm plain to see from the first view', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await raise(11, 25);
    await settled(page);
    await setDisplay({ isocurves: false, grid: false });
    for (const theme of ['dark', 'light'] as const) {
      await setTheme(theme);
      await settled(page);
      const found = await lightness();
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
  const near = (await lightness()).filter(({ r }) => r < 30);
  const sums = [0, 1, 2].map((c) => near.reduce((sum, { rgb }) => sum + rgb[c]!, 0));
  const all = sums[0]! + sums[1]! + sums[2]!;
  return sums.map((x) => x / all);
};

describe('looks', () => {
  const choose = (look: string) => studio.page.locator('select[aria-label="Look of surfaces"]').selectOption(look);

  it('are clay, red wax and chrome beside the studio\'s light, and zebra; the chosen one is remembered', async () => {
    const { page } = studio;
    await setDisplay({ isocurves: false });
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
    const striped = (await lightness()).filter(({ r }) => r < 50).map(({ l }) => l);
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
    await setDisplay({ isocurves });
    await page.evaluate((k) => {
      const { viewer } = (window as never as { studio: { viewer: { bounds(): { radius: number }; fit(b: unknown): void } } }).studio;
      const bounds = viewer.bounds();
      viewer.fit({ ...bounds, radius: k * bounds.radius });
    }, times);
    await settled(page);
    const inner = (await lightness()).filter(({ r }) => r < 60);
    return inner.reduce((sum, { l }) => sum + l, 0) / inner.length;
  };
  const cost = async (times: number) => (await mean(false, times)) - (await mean(true, times));
  expect(await cost(1)).toBeGreaterThan(1);
  expect(await cost(14)).toBeLessThan(0.5);
});
