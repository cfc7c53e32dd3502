import { scene, settled, studioOfFile } from './page';
import { pixels, quantile, raise, type Seen, setDisplay } from './pixels';

const studio = studioOfFile({ width: 1100, height: 720 });
beforeAll(async () => {
  await scene(studio.page, 'Clay sheet');
  await raise(studio.page, 11, 25);
  await setDisplay(studio.page, { isocurves: false, grid: false, relief: false });
});

const look = (name: string) => studio.page.locator('select[aria-label="Look of surfaces"]').selectOption(name);
const slide = (name: string, value: number) => studio.page.locator(`input[aria-label="${name}"]`).fill(String(value));
const mean = (list: Seen[], of: (p: Seen) => number) => list.reduce((sum, p) => sum + of(p), 0) / list.length;
const offWhole = (x: number) => Math.abs(x - Math.round(x));

describe('stripes', () => {
  /** How often neighbours along the grid differ by half of what there is. */
  const changes = async () => {
    await settled(studio.page);
    const seen = (await pixels(studio.page)).filter(({ r }) => r < 60);
    return seen.slice(1).filter(({ l }, k) => Math.abs(l - seen[k]!.l) > 45).length;
  };

  it('of the zebra have a spacing and a direction', async () => {
    await look('zebra');
    await slide('Spacing of the stripes', 20);
    const wide = await changes();
    await slide('Spacing of the stripes', 7);
    const narrow = await changes();
    expect(narrow).toBeGreaterThan(1.8 * wide);
    const upright = (await pixels(studio.page)).map(({ l }) => l);
    await slide('Direction of the stripes', 90);
    await settled(studio.page);
    const turned = (await pixels(studio.page)).map(({ l }) => l);
    expect(upright.filter((l, k) => Math.abs(l - turned[k]!) > 40).length).toBeGreaterThan(0.2 * upright.length);
  });

  it('of highlight lines lie where the normal points at a lamp, from wherever they are seen', async () => {
    const { page } = studio;
    await look('highlight');
    for (const [view, angle] of [['Digit0', 0], ['Digit3', 0], ['Digit0', 30]] as const) {
      await page.keyboard.press(view);
      await slide('Direction of the stripes', angle);
      await slide('Spacing of the stripes', 5);
      await settled(page);
      const turn = (angle * Math.PI) / 180;
      const place = ({ normal: [x, y, z] }: Seen) => Math.atan2(Math.cos(turn) * x + Math.sin(turn) * y, z) / ((5 * Math.PI) / 180) + 0.5;
      const seen = await pixels(page);
      const bump = seen.filter(({ r }) => r < 40 && r > 8);
      const on = bump.filter((p) => offWhole(place(p)) < 0.015);
      const off = bump.filter((p) => offWhole(place(p)) > 0.3);
      expect(on.length).toBeGreaterThan(20);
      expect(mean(on, ({ l }) => l) - mean(off, ({ l }) => l), `${view} ${angle}`).toBeGreaterThan(30);
      expect(mean(seen.filter(({ r }) => r > 90), ({ l }) => l), 'level').toBeLessThan(50);
    }
    await page.keyboard.press('Digit0');
    await look('studio');
  });
});

it('section curves lie at multiples of their step along an axis of the file', async () => {
  const { page } = studio;
  await page.locator('.panel[data-panel=Analysis] > summary').click();
  await page.locator('select[aria-label="Section curves"]').selectOption('x');
  const step = page.locator('input[aria-label="Step of the section curves"]');
  await expect.poll(() => step.inputValue()).toBe('20');
  await step.fill('25');
  await page.keyboard.press('Enter');
  await settled(page);
  const seen = (await pixels(page)).filter(({ r }) => r < 90);
  const red = ({ rgb: [r, g] }: Seen) => r - g;
  const on = seen.filter(({ x }) => 25 * offWhole(x / 25) < 0.2);
  const off = seen.filter(({ x }) => 25 * offWhole(x / 25) > 2);
  expect(on.length).toBeGreaterThan(20);
  expect(mean(on, red)).toBeGreaterThan(60);
  expect(quantile(off.map(red), 0.99)).toBeLessThan(10); // but where the far side of the bump is seen at a flat angle
  await page.locator('select[aria-label="Section curves"]').selectOption('none');
});

it('curvature combs name the largest curvature, and stand on the selected surface', async () => {
  const { page } = studio;
  await scene(page, 'Torus'); // radii 70 and 30
  await page.locator('select[aria-label="Curvature combs"]').selectOption('both');
  await settled(page);
  const note = page.locator('.panel[data-panel=Analysis] .note');
  await expect.poll(() => note.textContent()).toMatch(/^Largest curvature 0\.0333\d* 1\/mm, radius 30 mm$/);
  const ends = () => page.evaluate(() => {
    const { teeth } = (window as never as { studio: { viewer: { combs: { teeth: { visible: boolean; geometry: { getAttribute(n: string): { array: Float32Array } } } } } } }).studio.viewer.combs;
    const at = teeth.geometry.getAttribute('position').array;
    let longest = 0;
    for (let k = 0; k < at.length; k += 6) longest = Math.max(longest, Math.hypot(at[k]! - at[k + 3]!, at[k + 1]! - at[k + 4]!, at[k + 2]! - at[k + 5]!));
    return { visible: teeth.visible, count: at.length / 6, longest };
  });
  const usual = await ends();
  expect(usual.visible).toBe(true);
  await page.locator('input[aria-label="Length of the combs"]').fill('0.3');
  await page.locator('input[aria-label="Curves with combs"]').fill('14');
  await settled(page);
  await expect.poll(async () => (await ends()).count).toBe(2 * usual.count);
  expect((await ends()).longest / usual.longest).toBeCloseTo(2, 2);
  await page.locator('select[aria-label="Curvature combs"]').selectOption('none');
  await settled(page);
  expect((await ends()).visible).toBe(false);
});

it('combs on section curves have the curvature of the circles that are cut', async () => {
  const { page } = studio;
  await scene(page, 'Torus'); // radii 70 and 30
  await page.locator('select[aria-label="Section curves"]').selectOption('x');
  await page.locator('select[aria-label="Curvature combs"]').selectOption('sections');
  await page.locator('input[aria-label="Step of the section curves"]').fill('150'); // x = 0 alone
  await page.keyboard.press('Enter');
  await settled(page);
  await expect.poll(() => page.locator('.panel[data-panel=Analysis] .note').textContent()).toMatch(/radius 30 mm$/);
  await page.locator('select[aria-label="Section curves"]').selectOption('z');
  await settled(page);
  // The plane z = 0 cuts it in circles of the radii 40 and 100.
  await expect.poll(() => page.locator('.panel[data-panel=Analysis] .note').textContent()).toMatch(/radius 40 mm$/);
  await page.locator('select[aria-label="Curvature combs"]').selectOption('none');
  await page.locator('select[aria-label="Section curves"]').selectOption('none');
});
