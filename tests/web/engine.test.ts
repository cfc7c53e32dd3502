import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { type Command, KneadError, type Vector3 } from '@studio/engine/session_types';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));
const bonnet = new Uint8Array(readFileSync(join(root, 'samples/bonnet.step')));
const script = JSON.parse(readFileSync(join(root, 'samples/bonnet.json'), 'utf8')) as { commands: Command[] };
const native = process.env.KNEAD_CLI || join(root, 'build/release/knead');

const load = () => Engine.load(wasm);

async function sheet(net = 12): Promise<Engine> {
  const engine = await load();
  engine.query('fresh', { name: 'sheet' });
  engine.execute({ do: 'new', size: [100, 100], net: [net, net] });
  return engine;
}

const press: Command[] = [
  { do: 'hold', rows: 2 },
  { do: 'tool', name: 'ball', radius: 20, position: [50, 50, 10], plasticity: 1 },
  { do: 'step', count: 3 },
];

describe('the session in WebAssembly', () => {
  it('gives the control points of the native one to 1e-9', async () => {
    const directory = mkdtempSync(join(tmpdir(), 'knead-'));
    try {
      const out = join(directory, 'native.step');
      execFileSync(native, ['sculpt', join(root, 'samples/bonnet.step'), '-o', out, '--script', join(root, 'samples/bonnet.json')]);
      const engine = await load();
      engine.query('open', { file: bonnet, name: 'bonnet.step' });
      for (const command of script.commands) engine.execute(command);
      const here = engine.query('control_points', { surface: engine.query('state').selection[0]! });
      const other = await load();
      other.query('open', { file: new Uint8Array(readFileSync(out)), name: 'native.step' });
      const there = other.query('control_points', { surface: engine.query('state').selection[0]! });
      expect(here.length).toBe(there.length);
      const size = Math.max(...there.map(Math.abs));
      const worst = here.reduce((most, x, k) => Math.max(most, Math.abs(x - there[k]!)), 0);
      expect(worst).toBeLessThan(1e-9 * size);
      expect(engine.query('state').surfaces[engine.query('state').selection[0]!]!.moved).toBeGreaterThan(0);
      // What is saved here is what is there.
      const saved = join(directory, 'wasm.step');
      writeFileSync(saved, engine.query('save').file);
      const info = (file: string) => execFileSync(native, ['info', file], { encoding: 'utf8' }).replaceAll(file, '');
      expect(info(saved)).toBe(info(out));
    } finally {
      rmSync(directory, { recursive: true });
    }
  });

  it('presses a ball into a sheet, and undo and redo restore it bit for bit', async () => {
    const engine = await sheet();
    const before = engine.query('control_points', { surface: 0 });
    for (const command of press) engine.execute(command);
    const after = engine.query('control_points', { surface: 0 });
    expect(after).not.toEqual(before);
    for (let k = 0; k < press.length; ++k) engine.execute({ do: 'undo' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(before);
    for (let k = 0; k < press.length; ++k) engine.execute({ do: 'redo' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(after);
  });

  it('takes a joined act back at once, and its journal replays to the same bits', async () => {
    const engine = await sheet();
    engine.execute(press[0]!);
    const before = engine.query('control_points', { surface: 0 });
    engine.execute(press[1]!);
    for (let k = 0; k < 5; ++k) engine.execute({ do: 'step' }, true);
    engine.execute({ do: 'remove' }, true);
    const after = engine.query('control_points', { surface: 0 });
    const journal = JSON.parse(engine.query('journal')) as Command[];
    expect(journal.map((c) => c.do)).toEqual(['new', 'hold', 'tool', 'step', 'remove']);
    expect(journal[3]).toMatchObject({ do: 'step', count: 5 });
    engine.execute({ do: 'undo' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(before);
    engine.execute({ do: 'redo' });
    expect(engine.query('control_points', { surface: 0 })).toEqual(after);
    const again = await load();
    again.query('fresh', { name: 'sheet' });
    for (const command of journal) again.execute(command);
    expect(again.query('control_points', { surface: 0 })).toEqual(after);
  });

  it('leaves the same groove however often the pointer reports, which one undo takes back', async () => {
    const stroke = async (events: number) => {
      const engine = await sheet(32);
      engine.execute({ do: 'hold', rows: 1 });
      engine.execute({ do: 'material', preset: 'clay' });
      const before = engine.query('control_points', { surface: 0 });
      const at = (k: number): Vector3 => [30 + (40 * k) / events, 48 + (6 * k) / events, 6];
      engine.execute({ do: 'tool', name: 'ball', radius: 10, position: at(0), plasticity: 1 });
      for (let k = 0; k <= events; ++k) engine.execute({ do: 'stroke', path: [at(k)], open: true }, true);
      engine.execute({ do: 'stroke', path: [] }, true);
      engine.execute({ do: 'remove' }, true);
      const after = engine.query('control_points', { surface: 0 });
      engine.execute({ do: 'undo' });
      expect(engine.query('control_points', { surface: 0 })).toEqual(before);
      return after;
    };
    const few = await stroke(8), many = await stroke(480);
    expect(Math.min(...few)).toBeLessThan(-3.6);
    expect(Math.min(...few)).toBeGreaterThan(-4.5); // the net lies outside of the surface
    expect(few.reduce((most, x, k) => Math.max(most, Math.abs(x - many[k]!)), 0)).toBeLessThan(0.03 * 4);
  });

  it('draws unit normals, knot lines and a field', async () => {
    const engine = await sheet();
    for (const command of press) engine.execute(command);
    const picture = engine.query('picture', { surface: 0, detail: 60, display: 'deviation' });
    const [m, n] = picture.counts;
    expect(picture.positions.length).toBe(3 * m * n);
    expect(picture.lines_u.length).toBe(10);
    for (let k = 0; k < picture.normals.length; k += 3) {
      expect(Math.hypot(...picture.normals.subarray(k, k + 3))).toBeCloseTo(1, 5);
    }
    const deepest = Math.max(...picture.values.map(Math.abs));
    expect(deepest).toBeCloseTo(engine.query('state').last!.largest_displacement, 1);
    expect(picture.positions.every(Number.isFinite)).toBe(true);
    expect([...picture.held].filter((h) => h === 1).length).toBe(144 - 64);
    const flat = (await sheet()).query('picture', { surface: 0, detail: 60, display: 'gaussian' });
    expect(Math.max(...flat.values.map(Math.abs))).toBe(0);
  });

  it('gives all numbers of a surface, from which `new` makes the same one', async () => {
    const engine = await load();
    engine.query('fresh', { name: 'shapes' });
    engine.execute({ do: 'new', shape: 'torus', radius: 30, minor: 1 / 3, position: [0.1, -1e-7, 1 / 7] });
    const { degree, net, knots_u, knots_v, weights, points } = engine.query('surface', { surface: 0 });
    expect(net).toEqual([9, 9]);
    expect(points).toEqual(engine.query('control_points', { surface: 0 }));
    const triples = Array.from({ length: 81 }, (_, k): [number, number, number] => [points[3 * k]!, points[3 * k + 1]!, points[3 * k + 2]!]);
    engine.execute({ do: 'new', degree, net, knots_u: [...knots_u], knots_v: [...knots_v], weights: [...weights], points: triples });
    expect(engine.query('surface', { surface: 1 })).toEqual(engine.query('surface', { surface: 0 }));
    engine.execute({ do: 'new', size: [2, 2], degree: [2, 3], net: [5, 4] });
    expect(engine.query('surface', { surface: 2 }).weights.length).toBe(0);
    expect(engine.query('surface', { surface: 2 }).degree).toEqual([2, 3]);
    expect(() => engine.query('surface', { surface: 3 })).toThrow(/no such surface/);
    const back = await load();
    back.query('open', { file: engine.query('save').file, name: 'back.step' });
    expect(back.query('surface', { surface: 0 })).toEqual(engine.query('surface', { surface: 0 }));
  });

  it('shows what holds control points, deviations of edited shapes and the density of the energy', async () => {
    const engine = await sheet();
    engine.execute({ do: 'freeze', region: [[0.5, 0.5], [0.5, 0.5]] });
    engine.execute({ do: 'edge', which: 'u0' });
    expect(engine.query('picture', { surface: 0, detail: 20 }).held.filter((h) => h === 1).length).toBe(16 + 12);
    expect(Math.max(...engine.query('picture', { surface: 0, detail: 20, display: 'energy' }).values)).toBe(0);
    engine.execute({ do: 'tool', name: 'ball', radius: 20, position: [25, 25, 10] });
    engine.execute({ do: 'step', count: 3 });
    const density = engine.query('picture', { surface: 0, detail: 20, display: 'energy' }).values;
    expect(Math.min(...density)).toBeGreaterThan(-1e-6);
    expect(Math.max(...density)).toBeGreaterThan(0);
    engine.execute({ do: 'remove' });
    engine.execute({ do: 'release' });
    engine.execute({ do: 'rest' });
    const before = engine.query('picture', { surface: 0, detail: 20, display: 'deviation' }).values;
    engine.execute({ do: 'weights', rows_u: [5], weight: 3 });
    engine.execute({ do: 'knots', direction: 'v', knots: [0, 0, 0, 0, 0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1, 1, 1] });
    const after = engine.query('picture', { surface: 0, detail: 20, display: 'deviation' }).values;
    expect(after.every(Number.isFinite)).toBe(true);
    expect(after).not.toEqual(before);
    // In the plane the knots move points by no more than a span and a half.
    expect(Math.max(...after.map(Math.abs))).toBeLessThan(30);
    expect(engine.query('picture', { surface: 0, detail: 20, display: 'deviation', opened: true }).values.every((v) => v === 0)).toBe(true);
  });

  it('writes meshes of every format', async () => {
    const engine = await sheet(8);
    const stl = engine.query('file', { name: 'sheet.stl', detail: 10 }).file;
    const triangles = new DataView(stl.buffer, stl.byteOffset).getUint32(80, true);
    expect(stl.length).toBe(84 + 50 * triangles);
    expect(triangles).toBe(2 * 10 * 10);
    expect(new TextDecoder().decode(engine.query('file', { name: 'sheet.obj', detail: 10 }).file.subarray(0, 30))).toMatch(/^# Knead, lengths in mm/);
    expect(new TextDecoder().decode(engine.query('file', { name: 'sheet.ply', detail: 10 }).file.subarray(0, 3))).toBe('ply');
    expect(() => engine.query('file', { name: 'sheet.stl', detail: 0 }).file).toThrow(/detail/);
  });

  it('writes the trimmed faces of a STEP file, sculpted, as the native program does', async () => {
    const directory = mkdtempSync(join(tmpdir(), 'knead-'));
    try {
      const engine = await load();
      engine.query('open', { file: bonnet, name: 'bonnet.step' });
      const opened = engine.query('file', { name: 'sheet.stl', detail: 96 }).file;
      for (const command of script.commands) engine.execute(command);
      const [stl, saved, out] = [engine.query('file', { name: 'sheet.stl', detail: 96 }).file, join(directory, 'saved.step'), join(directory, 'native.stl')];
      expect(stl).not.toEqual(opened);
      writeFileSync(saved, engine.query('save').file);
      execFileSync(native, ['mesh', saved, '-o', out]);
      const other = readFileSync(out);
      expect(other.length).toBe(stl.length);
      const [here, there] = [new DataView(stl.buffer, stl.byteOffset), new DataView(other.buffer, other.byteOffset)];
      for (let at = 84; at + 50 <= stl.length; at += 50) {
        for (let k = 12; k < 48; k += 4) expect(Math.abs(here.getFloat32(at + k, true) - there.getFloat32(at + k, true))).toBeLessThan(1e-3);
      }
    } finally {
      rmSync(directory, { recursive: true });
    }
  });

  it('opens files of curves alone, and writes them back where they stand', async () => {
    const made = await load();
    made.query('fresh', { name: 'curves' });
    made.execute({ do: 'new', shape: 'curve', form: 'circle', radius: 3 });
    made.execute({ do: 'new', shape: 'curve', size: 5, net: 8, name: 'rail' });
    const bytes = made.query('save').file;
    const engine = await load();
    engine.query('open', { file: bytes, name: 'curves.step' });
    expect(engine.query('state').surfaces).toHaveLength(0);
    expect(engine.query('state').bodies.map((b) => [b.name, b.moved])).toEqual([['circle', 0], ['rail', 0]]);
    expect(engine.query('save').file).toEqual(bytes);
    expect(engine.query('body_picture', { body: 1 }).lines.length).toBeGreaterThan(6);
    engine.execute({ do: 'select', body: engine.query('state').bodies[1]!.id });
    engine.execute({ do: 'points', which: [3], by: [0, 0, 1] });
    const again = await load();
    again.query('open', { file: engine.query('save').file, name: 'curves.step' });
    expect(Array.from(again.query('body_picture', { body: 1 }).net)).toEqual(Array.from(engine.query('body_picture', { body: 1 }).net));
    expect(() => engine.execute({ do: 'points', rows_u: [0], by: [0, 0, 1] })).toThrow(KneadError);
  });

  it('measures pictures from the middle of a first surface that is far away', async () => {
    const engine = await load();
    engine.query('fresh', { name: 'far' });
    engine.execute({ do: 'new', size: [2, 2], position: [1e6, -3e6, 10] });
    expect(engine.query('origin')).toEqual([1e6 + 1, -3e6 + 1, 10]);
    expect(Math.max(...engine.query('picture', { surface: 0, detail: 10 }).positions.map(Math.abs))).toBe(1);
    const near = await sheet();
    expect(near.query('origin')).toEqual([0, 0, 0]);
  });

  it('says what is wrong with a file, a command and an order', async () => {
    const engine = await load();
    expect(() => engine.query('state')).toThrow(/nothing is open/);
    expect(() => engine.query('open', { file: new TextEncoder().encode('solid cube'), name: 'cube.stl' })).toThrow(KneadError);
    engine.query('fresh', { name: 'empty' });
    expect(() => engine.execute({ do: 'step' })).toThrow(KneadError);
    expect(() => engine.execute(JSON.parse('{ "do": "stpe" }') as Command)).toThrow(/not a command/);
    expect(() => engine.execute({ do: 'undo' })).toThrow(/nothing to undo/);
    expect(() => engine.query('picture', { surface: 7, detail: 10 })).toThrow(/no such surface/);
    engine.execute({ do: 'new' });
    expect(engine.query('state').surfaces.length).toBe(1);
  });

  it('keeps its memory while a stroke goes on', async () => {
    const engine = await sheet(32);
    engine.execute(press[0]!);
    const stroke = (x: number, join: boolean) => {
      engine.execute({ do: 'tool', name: 'brush', radius: 15, position: [x, 50, 10], plasticity: 1 }, join);
      engine.execute({ do: 'step' }, true);
      engine.query('picture', { surface: 0, detail: 96 });
    };
    stroke(20, false);
    for (let k = 0; k < 40; ++k) stroke(20 + k, true);
    const size = engine.memorySize;
    for (let k = 0; k < 100; ++k) stroke(60 - 0.2 * k, true);
    expect(engine.memorySize).toBeLessThanOrEqual(size * 1.1);
  });
});
