import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import type { Vector3 } from '@studio/engine/session_types';
import { scenes } from '@studio/document/scenes';

const root = fileURLToPath(new URL('../..', import.meta.url));
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));

describe('the gallery', () => {
  it('has names of their own', () => expect(new Set(scenes.map((s) => s.name)).size).toBe(scenes.length));

  it.each(scenes.filter((s) => s.commands))('$name: is made, and gives way', async ({ name, commands, file }) => {
    const engine = await Engine.load(wasm);
    if (file) engine.query('open', { file: readFileSync(join(root, 'examples/figures/patches.step')), name: 'patches.step' });
    else engine.query('fresh', { name: 'scene' });
    for (const command of commands!) engine.execute(command);
    const { surfaces, selection, tools } = engine.query('state');
    expect(selection.length).toBeGreaterThan(0);
    const k = selection[0]!;
    for (const s of surfaces) expect(s.net[0] * s.net[1]).toBeLessThanOrEqual(64 * 64);
    const before = engine.query('control_points', { surface: k });
    if (tools.length === 0 && !name.startsWith('Fig.')) {
      // A ball half sunk into the middle of the surface, from outside.
      const picture = engine.query('picture', { surface: k, detail: 33 });
      const [m, n] = picture.counts;
      const at = 3 * (Math.floor(m / 3) * n + Math.floor(n / 3));
      const radius = 0.08 * Math.hypot(...surfaces[k]!.upper.map((x, axis) => x - surfaces[k]!.lower[axis]!));
      const position = [0, 1, 2].map((axis) => picture.positions[at + axis]! + engine.query('origin')[axis]! + 0.5 * radius * picture.normals[at + axis]!) as Vector3;
      engine.execute({ do: 'tool', name: 'brush', radius, plasticity: 1, position });
    }
    engine.execute({ do: 'step', count: 4 });
    const after = engine.query('control_points', { surface: k });
    const size = Math.max(...before.map(Math.abs));
    expect(after.every(Number.isFinite)).toBe(true);
    const moved = after.reduce((most, x, i) => Math.max(most, Math.abs(x - before[i]!)), 0);
    expect(moved).toBeGreaterThan(1e-4 * size);
    expect(moved).toBeLessThan(0.5 * size);
  });
});
