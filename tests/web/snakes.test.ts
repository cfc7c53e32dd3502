import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { KneadError } from '@studio/engine/session_types';
import { type Pixels, SnakeModule, type Snakes } from '@studio/panels/snakes/module';
import { imageFields, moreFields, moreImageFields, noEnergy, type Preset, presetOf, presets, type Script, scriptText, snakeFields, type Start, thinned } from '@studio/panels/snakes/script';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/panels/snakes/knead_snake.wasm'));

const [size, middle, radius] = [96, [46.3, 49.6], 22.4] as const;

/** A disc whose edge is blurred to the width of a pixel, dark on light or light on dark. */
function disc(inside = 230, outside = 30): Pixels {
  const data = new Uint8ClampedArray(4 * size * size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const share = Math.min(1, Math.max(0, radius + 0.5 - Math.hypot(x - middle[0], y - middle[1])));
      data.fill(Math.round(outside + share * (inside - outside)), 4 * (y * size + x), 4 * (y * size + x) + 3);
      data[4 * (y * size + x) + 3] = 255;
    }
  }
  return { width: size, height: size, data };
}

const script = (snakes: Start[], preset = presets[0]!, more: Partial<Script> = {}): Script =>
  ({ ...presetOf(preset), mask: '', volcanoes: [], snakes, ...more });
const circle = (x: number, y: number, r: number): Start => ({ shape: 'ellipse', centre: [x, y], radii: [r, r] });

async function room(snakes: Start[], preset = presets[0]!): Promise<SnakeModule> {
  const module = await SnakeModule.load(wasm);
  module.setImage(disc());
  module.setScript(scriptText(script(snakes, preset)));
  return module;
}

function rest(module: SnakeModule): Snakes {
  let snakes = module.advance(20);
  for (let k = 0; k < 200 && !snakes.ended; ++k) snakes = module.advance(20);
  return snakes;
}

/** Mean distance of a contour from a place. */
function meanRadius({ points, offsets }: Snakes, k: number, [x, y]: readonly [number, number]): number {
  let sum = 0;
  for (let i = offsets[k]!; i < offsets[k + 1]!; ++i) sum += Math.hypot(points[3 * i]! - x, points[3 * i + 1]! - y);
  return sum / (offsets[k + 1]! - offsets[k]!);
}

describe('the module of snakes', () => {
  it('draws a circle beside a disc onto its edge, by regions and by edges', async () => {
    // A Gaussian of σ moves the edge of a disc inwards by about σ² / 2r; stretch and bend add to that.
    const edges: Preset = { ...presets[1]!, image: { smoothing: 1, edge: 1 }, settings: { ...presets[1]!.settings, alpha: 0.001, beta: 1 } };
    for (const [preset, start] of [[presets[0]!, circle(40, 52, 30)], [edges, circle(46, 50, 24)]] as const) {
      const module = await room([start], preset);
      const snakes = rest(module);
      expect(snakes.states[0]!.resting).toBe(true);
      expect(Math.abs(meanRadius(snakes, 0, middle) - radius)).toBeLessThan(0.1);
    }
  });

  it('gives every place of a contour its parameter, in order', async () => {
    const { points, offsets, net, netFrom } = (await room([circle(40, 50, 20), { shape: 'points', points: [[5, 5], [30, 8], [60, 5]], closed: false }])).advance(1);
    expect([...netFrom]).toEqual([0, 40, 80]);
    expect(net.length).toBe(160);
    for (const k of [0, 1]) {
      for (let i = offsets[k]! + 1; i < offsets[k + 1]!; ++i) expect(points[3 * i + 2]!).toBeGreaterThan(points[3 * i - 1]!);
    }
    expect(points[3 * offsets[0]! + 2]).toBe(0);
    expect(points.at(-1)).toBe(1); // an open one with its end
    expect(points[3 * (offsets[1]! - 1) + 2]).toBeLessThan(1);
  });

  it('goes on from where snakes are when another one is added or a setting changes', async () => {
    const first = circle(40, 52, 30);
    const module = await room([first]);
    const before = rest(module);
    const after = module.setScript(scriptText(script([circle(80, 15, 8), first])));
    expect(after.states[1]!.iterations).toBe(before.states[0]!.iterations);
    expect([...after.points.subarray(3 * after.offsets[1]!)]).toEqual([...before.points]);
    expect(after.states[0]).toEqual({ closed: true, iterations: 0, resting: false });
    // More control points: the same contour, nearly.
    const finer = module.setScript(scriptText(script([first], presets[0]!, { settings: { ...presetOf(presets[0]!).settings, control_points: 60 } })));
    expect([...finer.netFrom]).toEqual([0, 60]);
    expect(Math.abs(meanRadius(finer, 0, middle) - meanRadius(before, 0, middle))).toBeLessThan(0.01);
    const again = module.setScript(scriptText(script([first])), true);
    expect(Math.abs(meanRadius(again, 0, [40, 52]) - 30)).toBeLessThan(1e-3);
  });

  it('moves a control point of a closed snake without opening it', async () => {
    const module = await room([circle(48, 48, 20)]);
    const { points, net } = module.move(0, 0, [90, 48]);
    expect([net[0], net[1]]).toEqual([90, 48]);
    // Degree 3 with one knot each: a place is (1, 4, 1) / 6 of three control points; some place is two thirds of the way.
    expect(Math.max(...[...points].filter((_, k) => k % 3 === 0))).toBeGreaterThan(70);
    const n = points.length / 3;
    expect(Math.hypot(points[0]! - points[3 * n - 3]!, points[1]! - points[3 * n - 2]!)).toBeLessThan(12); // the closing piece is as short as others
  });

  it("lets the hand's spring draw a point, and go", async () => {
    const module = await room([circle(46, 50, 25)], presets[1]!);
    const before = meanRadius(rest(module), 0, middle);
    module.pull({ snake: 0, at: 0, to: [88, 50], strength: 0.1 });
    const pulled = module.advance(100);
    expect(Math.max(...[...pulled.points].filter((_, k) => k % 3 === 0))).toBeGreaterThan(middle[0] + radius + 10);
    module.pull(null);
    const after = rest(module);
    expect(after.states[0]!.resting).toBe(true);
    expect(Math.abs(meanRadius(after, 0, middle) - before)).toBeLessThan(0.1);
  });

  it('is pushed away by a volcano', async () => {
    const module = await room([circle(46, 50, 25)]);
    rest(module);
    const settings = script([circle(46, 50, 25)], presets[0]!, { volcanoes: [{ at: [72, 50], strength: 4, radius: 6 }] });
    module.setScript(scriptText(settings));
    const dented = rest(module);
    const least = (s: Snakes) => Math.min(...Array.from({ length: s.points.length / 3 }, (_, k) => Math.hypot(s.points[3 * k]! - 72, s.points[3 * k + 1]! - 50)));
    expect(least(dented)).toBeGreaterThan(middle[0] + radius < 72 ? 72 - middle[0] - radius + 1 : 1);
  });

  it('goes back to what was kept, bit for bit, and on from there as before', async () => {
    const module = await room([circle(46, 50, 30)], presets[1]!);
    module.advance(20);
    const kept = module.keep(), before = module.contours('json', '');
    const on = module.advance(40), end = module.contours('json', '');
    module.setScript(scriptText(script([circle(20, 20, 9), circle(46, 50, 30)])), true);
    const other = module.keep();
    module.clear();
    expect(module.contours('csv', '').trim().split('\n').length).toBe(1);
    for (let k = 0; k < 2; ++k) {
      module.restore(kept);
      expect(module.contours('json', '')).toBe(before);
      expect(module.advance(40)).toEqual(on);
      expect(module.contours('json', '')).toBe(end);
    }
    expect(module.restore(other).states.length).toBe(2);
    module.forget(kept);
    expect(() => module.restore(kept)).toThrow(/nothing was kept/);
    module.setImage(disc());
    expect(() => module.restore(other)).toThrow(/nothing was kept/);
  });

  it('keeps the mask when the last snake is removed', async () => {
    const module = await room([circle(40, 52, 30)]);
    module.setMask(disc(255, 0));
    const near = scriptText(script([circle(40, 52, 30)], presets[0]!, { mask: 'mask.png', image: { ...noEnergy, distance: 1 } }));
    module.setScript(near);
    const mask = module.keep();
    module.clear();
    expect(module.setScript(near).states.length).toBe(1);
    module.setMask(null);
    expect(() => module.setScript(near)).toThrow(/mask/);
    module.restore(mask);
    expect(module.setScript(near, true).states.length).toBe(1);
  });

  it('saves contours, the mask and the energy', async () => {
    const module = await room([circle(40, 52, 30)]);
    const snakes = rest(module);
    const json = JSON.parse(module.contours('json', 'a "disc".png')) as { image: string; width: number; snakes: { closed: boolean; area: number; crossings: number; control_points: number[][] }[] };
    expect(json).toMatchObject({ image: 'a "disc".png', width: size, snakes: [{ closed: true, crossings: 0 }] });
    expect(json.snakes[0]!.control_points.length).toBe(43);
    expect(json.snakes[0]!.area).toBeCloseTo(Math.PI * radius ** 2, -1);
    expect(module.contours('csv', '').split('\n')[0]).toBe('snake,x,y');
    expect(module.contours('csv', '').trim().split('\n').length).toBe(1 + 2 * (snakes.points.length / 3)); // 16 places a span, 8 are drawn
    expect(module.contours('svg', '')).toContain('<polygon points=');
    const mask = module.picture('mask').data;
    expect(mask.filter((v) => v === 255).length).toBeCloseTo(Math.PI * radius ** 2, -2);
    expect(mask[50 * size + 46]).toBe(255);
    expect(mask[0]).toBe(0);
    module.setScript(scriptText(script([circle(40, 52, 30)], presets[1]!)));
    const energy = module.picture('energy').data; // brightest on the edge of the disc
    expect(Math.hypot(energy.indexOf(255) % size - middle[0], Math.floor(energy.indexOf(255) / size) - middle[1])).toBeCloseTo(radius, 0);
  });

  it('refuses what cannot be, says where, and keeps what was there', async () => {
    const module = await room([circle(40, 52, 30)]);
    const before = module.contours('csv', '');
    const refused = (text: string, why: RegExp) => {
      expect(() => module.setScript(text)).toThrow(KneadError);
      expect(() => module.setScript(text)).toThrow(why);
    };
    refused('{', /JSON|json|end/);
    refused(scriptText(script([])), /no snake/);
    refused(scriptText(script([circle(1, 1, 0)])), /ellipse has no size/);
    refused(scriptText(script([{ shape: 'points', points: [[1, 1]] }])), /points/);
    refused(scriptText(script([circle(40, 52, 30)])).replace('"alpha":1', '"alpha":-1'), /alpha/);
    refused(scriptText(script([circle(40, 52, 30)])).replace('"alpha"', '"alpa"'), /alpa/);
    refused(scriptText(script([circle(40, 52, 30)], presets[0]!, { image: { ...presetOf(presets[0]!).image, distance: 1 } })), /mask/);
    expect(() => module.move(1, 0, [0, 0])).toThrow(/no snake 1/);
    expect(() => module.move(0, 40, [0, 0])).toThrow(/no control point 40/);
    expect(() => module.pull({ snake: 3, at: 0, to: [0, 0], strength: 1 })).toThrow(/no snake 3/);
    expect(module.contours('csv', '')).toBe(before);
    expect(() => module.setImage({ width: 3, height: 3, data: new Uint8ClampedArray(8) })).toThrow(/pixels|values/);
  });

  it('does not grow while snakes run', async () => {
    const module = await room([circle(40, 52, 30)]);
    for (let k = 0; k < 20; ++k) module.advance(20);
    const before = module.memorySize;
    for (let k = 0; k < 50; ++k) module.advance(20);
    expect(module.memorySize).toBe(before);
  });
});

describe('the script of snakes', () => {
  it('has a field with an explanation for every number of its energies and settings', () => {
    const { image, settings } = presetOf(presets[0]!);
    const { relative_region: _, ...numbers } = image;
    expect([...imageFields, ...moreImageFields].map((f) => f.key).sort()).toEqual(Object.keys(numbers).sort());
    expect([...snakeFields, ...moreFields].map((f) => f.key).sort()).toEqual(Object.keys(settings).sort());
    for (const { about } of [...imageFields, ...moreImageFields, ...snakeFields, ...moreFields]) expect(about.length).toBeGreaterThan(15);
  });

  it('is taken by the engine for every preset', async () => {
    const module = await SnakeModule.load(wasm);
    module.setImage(disc());
    for (const preset of presets) expect(module.setScript(scriptText(script([circle(48, 48, 20)], preset))).states.length).toBe(1);
  });

  it('keeps of a stroke what is a pixel apart, and its end', () => {
    expect(thinned([[0, 0], [0.2, 0], [0.6, 0], [1.1, 0], [1.3, 0]], 1)).toEqual([[0, 0], [1.1, 0], [1.3, 0]]);
    expect(thinned([[0, 0], [2, 0]], 1)).toEqual([[0, 0], [2, 0]]);
    expect(thinned([], 1)).toEqual([]);
  });
});
