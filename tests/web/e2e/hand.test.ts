import { commands, distance, positions, scene, settled, spot, stroke, studioOfFile } from './page';

const studio = studioOfFile();

interface Vector {
  toArray(): number[];
}
interface App {
  hand: { points: { chosen: Set<number> }; edges: { points(edge: string): Float32Array } };
  frame: { pictures: { net: Float32Array; held: Uint8Array }[]; state: { surfaces: { constraints: { do: string }[]; pins: number; alpha: (number | null)[] }[] } };
  viewer: {
    viewports: { projectAll(points: ArrayLike<number>): Float32Array; camera: { position: Vector; zoom: number }; target: Vector }[];
  };
}
const app = <T>(ask: (studio: App) => T): Promise<T> =>
  studio.page.evaluate(`(${ask.toString()})(window.studio)`) as Promise<T>;

/** Where a control point is on the page. */
const pointAt = async (index: number): Promise<[number, number]> => {
  const places = await studio.page.evaluate((k) => {
    const { viewer, frame } = (window as never as { studio: App }).studio;
    return [...viewer.viewports[0]!.projectAll(frame.pictures[0]!.net.subarray(3 * k, 3 * k + 3))];
  }, index);
  return [places[0]!, places[1]!];
};
const camera = () => app((s) => [...s.viewer.viewports[0]!.camera.position.toArray(), ...s.viewer.viewports[0]!.target.toArray()]);
const chosen = () => app((s) => [...s.hand.points.chosen].sort((a, b) => a - b));
const drag = async (from: [number, number], to: [number, number], button: 'left' | 'middle' | 'right' = 'left') => {
  const { page } = studio;
  await page.mouse.move(...from);
  await page.mouse.down({ button });
  await page.mouse.move(...to, { steps: 5 });
  await page.mouse.up({ button });
  await settled(page);
};

describe('the view', () => {
  it('is turned, moved and zoomed by the mouse as one is used to', async () => {
    const { page } = studio;
    await page.keyboard.press('v');
    const cases = [
      ['knead', 'right', []], ['knead', 'middle', []], ['blender', 'middle', []], ['blender', 'middle', ['Shift']], ['rhino', 'right', []],
      ['rhino', 'right', ['Shift']], ['fusion', 'middle', []], ['fusion', 'middle', ['Shift']], ['blender', 'middle', ['Control']],
    ] as const;
    const pans = new Set(['knead middle ', 'blender middle Shift', 'rhino right Shift', 'fusion middle ']);
    for (const [convention, button, keys] of cases) {
      await page.locator('select[aria-label="Mouse as in"]').selectOption(convention);
      const before = await camera();
      for (const key of keys) await page.keyboard.down(key);
      await drag(await spot(page, 20, 20), await spot(page, 60, 40), button);
      for (const key of keys) await page.keyboard.up(key);
      const after = await camera();
      expect(distance(before, after), `${convention} ${button} ${keys.join()}`).toBeGreaterThan(1);
      // Panned, the camera and what it looks at move alike.
      const alike = [0, 1, 2].every((k) => Math.abs(after[k]! - before[k]! - (after[k + 3]! - before[k + 3]!)) < 1e-6);
      expect(alike, `${convention} ${button} ${keys.join()}`).toBe(pans.has(`${convention} ${button} ${keys.join()}`));
      await page.keyboard.press('0');
      await page.keyboard.press('f');
    }
    await page.locator('select[aria-label="Mouse as in"]').selectOption('rhino');
    await page.reload();
    await page.waitForSelector('html[data-ready]', { state: 'attached' });
    expect(await page.locator('select[aria-label="Mouse as in"]').inputValue()).toBe('rhino');
    await page.locator('select[aria-label="Mouse as in"]').selectOption('knead');
  });

  it('zooms to the point under the pointer', async () => {
    const { page } = studio;
    const k = 10 * 32 + 20;
    const place = await pointAt(k);
    await page.mouse.move(...place);
    for (let j = 0; j < 4; ++j) await page.mouse.wheel(0, -240);
    await settled(page);
    const after = await pointAt(k);
    // The wheel's place is whole pixels: half of one in either direction, 4.6 times as large.
    expect(Math.hypot(after[0] - place[0], after[1] - place[1])).toBeLessThan(4.7 * Math.SQRT1_2 + 0.1);
    await page.keyboard.press('f');
  });

  it('is one of four, or alone after a double click on its label', async () => {
    const { page } = studio;
    await page.keyboard.press('4');
    await page.locator('.view-front .viewport-label').dblclick();
    expect(await page.locator('.view-perspective').isVisible()).toBe(false);
    expect((await page.locator('.view-front').boundingBox())!.width).toBeGreaterThan(500);
    await page.keyboard.press('3');
    expect(await page.locator('.view-front .viewport-label').textContent()).toBe('Top');
    await page.locator('.view-front .viewport-label').dblclick();
    expect(await page.locator('.view-perspective').isVisible()).toBe(true);
    await page.locator('.view-perspective .viewport-label').focus();
    await page.keyboard.press('Enter');
    expect(await page.locator('.view-front').isVisible()).toBe(false);
    await page.keyboard.press('f');
  });

  it('pans and zooms by two fingers, and a finger on the clay presses it', async () => {
    const { page } = studio;
    await page.keyboard.press('b');
    const before = await camera();
    const shape = await positions(page);
    const touch = await page.context().newCDPSession(page);
    const [x, y] = await spot(page);
    const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', ...points: [number, number][]) =>
      touch.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([a, b], id) => ({ x: a, y: b, id })) });
    await send('touchStart', [x - 40, y], [x + 40, y]);
    for (let k = 1; k <= 5; ++k) await send('touchMove', [x - 40 - 6 * k, y + 4 * k], [x + 40 + 6 * k, y + 4 * k]);
    await send('touchEnd');
    await settled(page);
    const after = await camera();
    const length = (c: number[]) => Math.hypot(c[0]! - c[3]!, c[1]! - c[4]!, c[2]! - c[5]!);
    expect(length(after)).toBeLessThan(0.8 * length(before));
    expect(distance(await positions(page), shape)).toBe(0);
    await page.keyboard.press('0');
    await page.keyboard.press('f');
    await send('touchStart', [x, y]);
    for (let k = 1; k <= 4; ++k) await send('touchMove', [x + 8 * k, y]);
    await settled(page);
    await send('touchEnd');
    await settled(page);
    expect(distance(await positions(page), shape)).toBeGreaterThan(1);
    expect((await commands(page)).at(-1)!.do).toBe('remove');
    await page.keyboard.press('Control+z');
    await settled(page);
    await touch.detach();
  });
});

describe('control points', () => {
  it('are chosen by click, Shift, row and box', async () => {
    const { page } = studio;
    await page.keyboard.press('e');
    await page.mouse.click(...(await pointAt(330)));
    expect(await chosen()).toEqual([330]);
    await page.keyboard.down('Shift');
    await page.mouse.click(...(await pointAt(340)));
    await page.keyboard.up('Shift');
    expect(await chosen()).toEqual([330, 340]);
    await page.mouse.dblclick(...(await pointAt(10 * 32 + 12)));
    expect(await chosen()).toEqual(Array.from({ length: 32 }, (_, i) => 32 * i + 12));
    await page.locator('.panel[data-panel="Control points"] button', { hasText: 'None' }).click();
    const box = (await page.locator('.view-perspective').boundingBox())!;
    await drag([box.x + 5, box.y + 30], [box.x + box.width - 5, box.y + box.height - 40]);
    expect((await chosen()).length).toBe(1024);
  });

  it('are dragged, the surface follows, and it is one entry of the history', async () => {
    const { page } = studio;
    const before = await positions(page);
    await page.locator('.panel[data-panel="Control points"] button', { hasText: 'None' }).click();
    const from = await pointAt(16 * 32 + 16);
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(from[0], from[1] - 30, { steps: 4 });
    await page.keyboard.press('z');
    await page.mouse.move(from[0] + 15, from[1] - 50, { steps: 4 });
    await settled(page);
    expect(distance(before, await positions(page)), 'while dragging').toBeGreaterThan(1);
    await page.mouse.up();
    await settled(page);
    const last = (await commands(page)).at(-1)! as { do: string; which?: number[]; by?: number[] };
    expect(last).toMatchObject({ do: 'points', which: [16 * 32 + 16] });
    expect(last.by![0]).toBe(0);
    expect(last.by![1]).toBe(0);
    expect(last.by![2]).toBeGreaterThan(1);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(distance(before, await positions(page))).toBe(0);
  });

  it('come back on Esc', async () => {
    const { page } = studio;
    const before = await positions(page);
    const count = (await commands(page)).length;
    const from = await pointAt(8 * 32 + 8);
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(from[0], from[1] - 30, { steps: 4 });
    await page.keyboard.press('Escape');
    await page.mouse.up();
    await settled(page);
    expect(distance(before, await positions(page))).toBe(0);
    expect((await commands(page)).length).toBe(count);
  });

  it('go by typed lengths, and take weights', async () => {
    const { page } = studio;
    await page.mouse.click(...(await pointAt(20 * 32 + 20)));
    await page.locator('input[aria-label="Move by z"]').fill('1 cm');
    await page.locator('.panel[data-panel="Control points"] button', { hasText: 'Move' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'points', by: [0, 0, 10] });
    const before = await positions(page);
    await page.locator('input[aria-label="Weight"]').fill('4');
    await page.keyboard.press('Enter');
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'weights', weight: 4 });
    expect(distance(before, await positions(page))).toBeGreaterThan(1);
    await page.keyboard.press('Control+z');
    await page.keyboard.press('Control+z');
    await settled(page);
  });
});

describe('paint', () => {
  it('freezes whole spans, that then do not move, and thaws them with Alt', async () => {
    const { page } = studio;
    await scene(studio.page, 'Clay sheet');
    await page.keyboard.press('i');
    await stroke(page, [-40, 0], [40, 0]);
    const frozen = (await commands(page)).filter((c) => c.do === 'freeze').length;
    expect(frozen).toBeGreaterThan(0);
    const before = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [-5, 0], [5, 0]);
    expect(distance(before, await positions(page))).toBeLessThan(1e-9);
    expect((await commands(page)).at(-1)!.do).toBe('freeze'); // what is refused leaves no entry
    await page.keyboard.press('i');
    await page.keyboard.down('Alt');
    await stroke(page, [-60, -20], [60, -20], [60, 0], [-60, 0], [-60, 20], [60, 20]);
    await page.keyboard.up('Alt');
    const left = await app((s) => s.frame.state.surfaces[0]!.constraints.filter((c) => c.do === 'freeze').length);
    expect(left).toBe(0);
    // One entry: all regions at once come back.
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(await app((s) => s.frame.state.surfaces[0]!.constraints.filter((c) => c.do === 'freeze').length)).toBe(frozen);
  });

  it('pins control points and frees them with Alt', async () => {
    const { page } = studio;
    await page.keyboard.press('p');
    await stroke(page, [80, 40], [100, 40]);
    const pins = await app((s) => s.frame.state.surfaces[0]!.pins);
    expect(pins).toBeGreaterThan(3);
    await page.keyboard.down('Alt');
    await stroke(page, [80, 40], [90, 40], [100, 40]);
    await page.keyboard.up('Alt');
    expect(await app((s) => s.frame.state.surfaces[0]!.pins)).toBe(0);
    expect(await app((s) => s.frame.state.surfaces[0]!.constraints.some((c) => c.do === 'freeze'))).toBe(true);
  });

  it('paints another material', async () => {
    const { page } = studio;
    await page.keyboard.press('a');
    await page.locator('.panel[data-panel=Brush] .chip', { hasText: 'Sheet metal' }).click();
    await stroke(page, [-60, -30], [-30, -30]);
    const samples = async () => (await commands(page)).filter((c) => c.do === 'material').filter((c) => 'coefficient' in c);
    const painted = await samples();
    expect(painted.map((c) => c.coefficient)).toEqual(['alpha11', 'alpha22', 'beta11', 'beta12', 'beta22']);
    expect(new Set(painted[2]!.samples).has(0.05)).toBe(true);
    expect(painted[2]!.samples!.filter((x) => x === 0.001).length).toBeGreaterThan(500);
    expect(await app((s) => s.frame.state.surfaces[0]!.alpha[0])).toBeNull();
    // A second stroke keeps the first.
    await stroke(page, [60, 30], [70, 30]);
    const again = (await samples()).at(-3)!;
    painted[2]!.samples!.forEach((x, k) => expect(again.samples![k]).toBeGreaterThanOrEqual(x));
  });

  it('asks beside a clicked edge what is to hold there', async () => {
    const { page } = studio;
    await page.keyboard.press('d');
    const [x, y] = await page.evaluate(() => {
      const { viewer, hand } = (window as never as { studio: App }).studio;
      return [...viewer.viewports[0]!.projectAll(hand.edges.points('v0'))].slice(60, 62);
    });
    await page.mouse.click(x!, y!);
    await page.locator('.popover .chip', { hasText: 'Curvature' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'edge', which: 'v0', hold: 'curvature' });
    expect(await page.locator('.popover').count()).toBe(0);
  });
});

describe('the brush', () => {
  it('smooths with Shift', async () => {
    const { page } = studio;
    await scene(studio.page, 'Clay sheet');
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [10, 0]);
    const depth = (all: number[]) => Math.min(...all.filter((_, k) => k % 3 === 2));
    const pressed = depth(await positions(page));
    await page.keyboard.down('Shift');
    await stroke(page, [-5, 0], [5, 0], [15, 0]);
    await page.keyboard.up('Shift');
    expect((await commands(page)).at(-1)!.do).toBe('relax');
    expect(depth(await positions(page))).toBeGreaterThan(0.95 * pressed);
    await page.keyboard.press('Control+z');
    await settled(page);
    expect(depth(await positions(page))).toBe(pressed);
  });

  it('changes its size and depth by Ctrl-drag and wheel', async () => {
    const { page } = studio;
    const settings = () => page.evaluate(() => ({ ...(window as never as { studio: { hand: { brush: { settings: { radius: number; strength: number } } } } }).studio.hand.brush.settings }));
    const before = await settings();
    await page.keyboard.down('Control');
    await drag(await spot(page), await spot(page, 40, -30));
    await page.keyboard.up('Control');
    const after = await settings();
    expect(after.radius).toBeGreaterThan(1.2 * before.radius);
    expect(after.strength).toBeGreaterThan(before.strength);
    await page.keyboard.down('Shift');
    await page.mouse.wheel(0, 120);
    await page.keyboard.up('Shift');
    expect((await settings()).radius).toBeLessThan(after.radius);
  });

  it('places every shape', async () => {
    const { page } = studio;
    for (const shape of ['sphere', 'ellipsoid', 'box', 'cylinder', 'cone', 'capsule', 'torus', 'plane', 'bowl', 'superellipsoid', 'supertoroid']) {
      await page.keyboard.press('t');
      await page.locator('select[aria-label="Shape of the new tool"]').selectOption(shape);
      await page.mouse.click(...(await spot(page, -30, 10)));
      await settled(page);
      expect((await commands(page)).at(-1)).toMatchObject({ do: 'tool', shape });
      await page.keyboard.press('Delete');
      await settled(page);
    }
  });
});

describe('a tool', () => {
  it('is dragged by its gizmo in a view along an axis too', async () => {
    const { page } = studio;
    await scene(studio.page, 'Ball on a membrane');
    await page.keyboard.press('v');
    await page.keyboard.press('4');
    await page.locator('.panel[data-panel=Tools] .item').click();
    const handle = await page.evaluate(() => {
      const { viewer } = (window as never as { studio: { viewer: {
        viewports: { name: string; projectAll(points: number[]): Float32Array }[]; tools: Map<string, { object: { position: { toArray(): number[] } } }> } } }).studio;
      const view = viewer.viewports.find((v) => v.name === 'front')!;
      return [...view.projectAll(viewer.tools.get('ball')!.object.position.toArray())];
    });
    // The arrow along x.
    await drag([handle[0]! + 20, handle[1]!], [handle[0]! + 60, handle[1]!]);
    const move = (await commands(page)).find((c) => c.do === 'move')!;
    expect(move.by[0]).toBeGreaterThan(0);
    expect(move.by[1]).toBe(0);
    expect(move.by[2]).toBe(0);
    await page.keyboard.press('4');
  });
});
