import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { type DisplayInfo, type SettingValue, unitIn } from '@studio/engine/displays';
import { Engine } from '@knead/engine';
import type { Command } from '@studio/engine/session_types';
import { limitsOf, nothingToShow } from '@studio/view/limits';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));

async function session(...commands: Command[]): Promise<Engine> {
  const engine = await Engine.load(wasm);
  engine.query('fresh', { name: 'displays' });
  for (const command of commands) engine.execute(command);
  return engine;
}
const values = (engine: Engine, display: string, settings?: Record<string, SettingValue>) => [...engine.query('picture', { surface: 0, detail: 20, display, ...(settings ? { settings } : {}) }).values];

const ofShells = ['von_mises', 'von_mises_outer', 'von_mises_inner', 'bending_strain'];

describe('displays', () => {
  it('are described: a name of their own, a title, a unit and a help each', async () => {
    const all = (await session()).query('displays');
    expect(new Set(all.map((d) => d.name)).size).toBe(all.length);
    expect(all.map((d) => d.name)).toEqual(['deviation', 'mean', 'gaussian', 'largest', 'draft', 'thickness', 'gap', 'energy', ...ofShells, 'mask']);
    for (const d of all) {
      for (const text of [d.title, d.unit, d.help]) expect(text, d.name).not.toBe('');
      expect(d.palette, d.name).toBe(d.signed ? 'diverging' : 'rising');
      if (d.limits) expect(d.limits[0]).toBeLessThan(d.limits[1]);
      for (const s of d.settings) expect(s.help).not.toBe('');
    }
  });

  it('give a number at each point of the grid, of the sign that they say', async () => {
    const engine = await session({ do: 'new', size: [100, 100], net: [8, 8] }, { do: 'hold', rows: 2 },
      { do: 'tool', name: 'ball', radius: 20, position: [50, 50, 10] }, { do: 'step', count: 2 },
      { do: 'brush', kind: 'mask', radius: 40, path: [[0.5, 0.5]] });
    for (const { name, signed } of engine.query('displays')) {
      const { counts, values: found } = engine.query('picture', { surface: 0, detail: 20, display: name });
      expect(found.length, name).toBe(counts[0] * counts[1]);
      expect(found.every(Number.isFinite), name).toBe(true);
      if (name === 'thickness' || ofShells.includes(name)) { // there is nothing behind a sheet, and it is no shell
        expect(Math.max(...found), name).toBeLessThan(-1e20);
        continue;
      }
      if (!signed) expect(Math.min(...found), name).toBeGreaterThan(-1e-6);
      expect(Math.max(...found.map(Math.abs)), name).toBeGreaterThan(0);
    }
    expect(engine.query('picture', { surface: 0, detail: 20 }).values.length).toBe(0);
  });

  it('of shells give the stresses of a strip that is bent by its end moment', async () => {
    const engine = await session({ do: 'new', size: [10, 1], net: [12, 4] }, { do: 'edge', which: 'u0', hold: 'tangent' },
      { do: 'material', model: 'shell', young: 1.2e6, thickness: 0.1 }, { do: 'evolve', mode: 'static' },
      { do: 'force', kind: 'moment', edge: 'u1', moment: 1e-3 }, { do: 'step' });
    for (const name of ofShells.slice(0, 3)) { // 6 m / t², as 32-bit numbers
      for (const x of values(engine, name)) expect(x, name).toBeCloseTo(0.6, 4);
    }
    for (const x of values(engine, 'bending_strain')) expect(x).toBeCloseTo(0.6 / 1.2e4, 8); // in percent
  });

  it('that do not exist, and settings that a display does not have, are refused with the ones that exist', async () => {
    const engine = await session({ do: 'new' });
    expect(() => values(engine, 'beauty')).toThrow(/no display "beauty".*deviation/);
    expect(() => values(engine, 'draft', { axis: [0, 0, 1] })).toThrow(/settings\.axis.*direction/);
    expect(() => values(engine, 'draft', { direction: [0, 1] })).toThrow(/settings\.direction.*3 numbers/);
    expect(() => values(engine, 'draft', { direction: 3 })).toThrow(/3 numbers/);
    expect(() => values(engine, 'mean', { direction: [0, 0, 1] })).toThrow(/no such setting/);
  });
});

describe('the draft angle', () => {
  const all = (list: number[], expected: number) => {
    for (const x of list) expect(x).toBeCloseTo(expected, 4);
  };

  it('is 90° where the surface faces the direction of the pull, and -90° from behind', async () => {
    const engine = await session({ do: 'new', size: [10, 10] });
    all(values(engine, 'draft'), 90);
    all(values(engine, 'draft', { direction: [0, 0, -3] }), -90);
    all(values(engine, 'draft', { direction: [1, 0, 1] }), 45);
    all(values(engine, 'draft', { direction: [0, 2, 0] }), 0);
    all(values(engine, 'draft', { direction: [0, 0, 0] }), 0);
  });

  it('of a cone is its half angle, that of a cylinder along its axis 0', async () => {
    const cone = await session({ do: 'new', shape: 'revolution', degree: [2, 1], profile: [[20, 0], [10, 40]] });
    const half = (Math.atan2(10, 40) * 180) / Math.PI;
    const found = values(cone, 'draft');
    const sign = Math.sign(found[0]!); // of the normals
    all(found, sign * half);
    all(values(cone, 'draft', { direction: [0, 0, -1] }), -sign * half);
    const cylinder = await session({ do: 'new', shape: 'cylinder', radius: 10, height: 30 });
    all(values(cylinder, 'draft'), 0);
  });
});

describe('the largest curvature', () => {
  it('of a cylinder is 1/radius, and that of a torus 1/minor radius', async () => {
    const cylinder = await session({ do: 'new', shape: 'cylinder', radius: 8, height: 30 });
    for (const x of values(cylinder, 'largest')) expect(x).toBeCloseTo(1 / 8, 5);
    const torus = await session({ do: 'new', shape: 'torus', radius: 70, minor: 30 });
    for (const x of values(torus, 'largest')) expect(x).toBeCloseTo(1 / 30, 5);
  });
});

describe('limits of the colours', () => {
  const display = (more: Partial<DisplayInfo>): DisplayInfo =>
    ({ name: 'x', title: 'X', unit: 'length', signed: true, palette: 'diverging', help: '', limits: null, tolerance: '', compares: false, sees_model: false, settings: [], ...more });
  const range = { lower: -9.9, upper: 9.9, least: -40, greatest: 3 };

  it('are those of the display, or round ones of the range', () => {
    expect(limitsOf(display({ limits: [-3, 5] }), range)).toEqual([-3, 5]);
    expect(limitsOf(display({}), range)).toEqual([-10, 10]);
    expect(limitsOf(display({ signed: false, palette: 'rising' }), range)).toEqual([0, 10]);
  });

  it('cover what is seen: the share of the area decides, not that of the grid points', async () => {
    // A cone with its apex: κ grows without bound, on ever less area.
    const cone = await session({ do: 'new', shape: 'revolution', degree: [2, 3], profile: [[0.01, 0], [3.34, 40 / 3], [6.67, 80 / 3], [10, 40]] });
    const found = [...cone.query('picture', { surface: 0, detail: 60, display: 'mean' }).values].map(Math.abs);
    const { upper, lower, least, greatest } = cone.query('range')!;
    expect(lower).toBe(-upper);
    expect(Math.max(-least, greatest)).toBeCloseTo(Math.max(...found), 4);
    // |H| = cos α / 2r, and 98 % of the area lie where r > √0.02 · 10.
    const expected = (40 / Math.hypot(10, 40)) / (2 * Math.sqrt(0.02) * 10);
    expect(upper).toBeGreaterThan(0.8 * expected);
    expect(upper).toBeLessThan(1.25 * expected);
    expect(Math.max(...found)).toBeGreaterThan(100 * upper);
  });

  it('of deviations hold the largest', async () => {
    const engine = await session({ do: 'new', size: [100, 100], net: [12, 12] }, { do: 'points', which: [70], by: [0, 0, 9] });
    const found = [...engine.query('picture', { surface: 0, detail: 60, display: 'deviation' }).values];
    expect(engine.query('range')!.upper).toBeCloseTo(Math.max(...found), 5);
  });

  it('are none without a display', async () => {
    const engine = await session({ do: 'new' });
    engine.query('picture', { surface: 0, detail: 20 });
    expect(engine.query('range')).toBeNull();
  });

  it('have the unit of the file', () => expect(unitIn('1/length²', 'mm')).toBe('1/mm²'));
});

describe('colours of nothing', () => {
  const said = (engine: Engine, name: string) => {
    engine.query('picture', { surface: 0, detail: 20, display: name });
    const display = engine.query('displays').find((d) => d.name === name)!;
    return nothingToShow(display, engine.query('range'), engine.query('state'));
  };

  it('say why there are none', async () => {
    const engine = await session({ do: 'new', size: [100, 100], net: [8, 8] }, { do: 'hold', rows: 2 });
    expect(said(engine, 'gap')).toBe('Nothing to show: no tool in the scene.');
    expect(said(engine, 'mask')).toBe('Nothing to show: nothing is masked.');
    expect(said(engine, 'deviation')).toBe('Nothing to show: nothing has moved.');
    expect(said(engine, 'mean')).toBe('Nothing to show: flat everywhere.');
    expect(said(engine, 'energy')).toBe('Nothing to show: nothing is stretched or bent.');
    expect(said(engine, 'von_mises')).toBe('Nothing to show: no surface is a shell.');
    expect(said(engine, 'draft')).toBeNull();
  });

  it('give way to what there is', async () => {
    const engine = await session({ do: 'new', size: [100, 100], net: [8, 8] }, { do: 'hold', rows: 2 },
      { do: 'tool', name: 'ball', radius: 20, position: [50, 50, 10] }, { do: 'step', count: 2 }, { do: 'brush', kind: 'mask', radius: 40, path: [[0.5, 0.5]] });
    for (const name of ['gap', 'mask', 'deviation', 'mean', 'energy']) expect(said(engine, name), name).toBeNull();
  });
});
