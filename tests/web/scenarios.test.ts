import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';
import { type Command, KneadError } from '@studio/engine/session_types';

// The scenarios that the native session passes too (tests/session/scenario_test.cpp), and the examples' scripts: the same
// expectations hold in WebAssembly, and the control points at the end are the native ones to 1e-9 of the size unless a scenario
// says otherwise.

const root = fileURLToPath(new URL('../..', import.meta.url));
const native = process.env.KNEAD_CLI || join(root, 'build/release/knead');
const wasm = readFileSync(join(root, 'web/src/engine/knead_studio.wasm'));

type Step = Command | { refused: Command; where: string } | { expect: string; is?: unknown; min?: number; max?: number };
interface Scenario {
  open?: string;
  steps: Step[];
  /** How far control points may be off the native ones, of the size: five strokes over one another add up the steps' 1e-11. */
  agreement?: number;
}

/** The falling sheet of Fig. 6.15 takes ninety steps; the way to its first touch will do here. */
const shortened = (commands: Command[]) => commands.map((c) => (c.do === 'step' && Number(c.count) > 20 ? { ...c, count: 20 } : c));
const read = (path: string) => JSON.parse(readFileSync(path, 'utf8')) as never;
const listed = (directory: string) =>
  readdirSync(join(root, directory)).filter((f) => f.endsWith('.json')).map((f) => join(root, directory, f));
const scenarios: [string, Scenario][] = [
  ...listed('tests/scenarios').map((f): [string, Scenario] => [basename(f, '.json'), read(f)]),
  ...listed('examples/figures').map((f): [string, Scenario] => [
    basename(f, '.json'),
    { open: /figure_6_11/.test(f) ? 'examples/figures/patches.step' : undefined, steps: shortened((read(f) as { commands: Command[] }).commands) },
  ]),
];

async function begin(open?: string): Promise<Engine> {
  const engine = await Engine.load(wasm);
  if (open) engine.query('open', { file: new Uint8Array(readFileSync(join(root, open))), name: basename(open) });
  else engine.query('fresh', { name: 'scenario' });
  return engine;
}

const at = (value: unknown, pointer: string): unknown =>
  pointer.split('/').slice(1).reduce<unknown>((v, key) => (v as Record<string, unknown>)[key], value);

function check(engine: Engine, step: Step): void {
  if ('do' in step) {
    engine.execute(step);
  } else if ('refused' in step) {
    const { refused, where } = step;
    const before = engine.query('state');
    let error: unknown;
    try {
      engine.execute(refused);
    } catch (e) {
      error = e;
    }
    expect(error).toBeInstanceOf(KneadError);
    expect((error as KneadError).info.where).toBe(where);
    expect(engine.query('state')).toEqual(before);
  } else {
    const { expect: pointer, is, min, max } = step;
    const value = at(engine.query('state'), pointer);
    if (is !== undefined) expect(value ?? null, pointer).toEqual(is);
    else {
      expect(value, pointer).toBeGreaterThanOrEqual(min!);
      expect(value, pointer).toBeLessThanOrEqual(max!);
    }
  }
}

describe('scenarios in WebAssembly', () => {
  it.each(scenarios)('%s runs as the native session runs it', async (_name, { open, steps, agreement = 1e-9 }) => {
    const engine = await begin(open);
    for (const step of steps) check(engine, step);

    const directory = mkdtempSync(join(tmpdir(), 'knead-'));
    try {
      const script = join(directory, 'script.json');
      const out = join(directory, 'native.step');
      writeFileSync(script, JSON.stringify({ knead: 2, commands: [{ do: 'hold', rows: 0, all: true }, ...steps.filter((s) => 'do' in s)] }));
      execFileSync(native, ['sculpt', ...(open ? [join(root, open)] : ['--new']), '-o', out, '--script', script], { stdio: 'pipe' });
      const there = await Engine.load(wasm);
      there.query('open', { file: new Uint8Array(readFileSync(out)), name: 'native.step' });
      // Curves and volumes are surfaces and curves of the files that they are saved in.
      let mine = engine;
      if (engine.query('state').bodies.length > 0) {
        mine = await Engine.load(wasm);
        mine.query('open', { file: engine.query('save').file, name: 'page.step' });
      }
      const { surfaces } = mine.query('state');
      expect(there.query('state').surfaces.length).toBe(surfaces.length);
      surfaces.forEach((_, k) => {
        const [here, other] = [mine.query('control_points', { surface: k }), there.query('control_points', { surface: k })];
        expect(here.length).toBe(other.length);
        const size = other.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
        const worst = here.reduce((most, x, i) => Math.max(most, Math.abs(x - other[i]!)), 0);
        expect(worst).toBeLessThanOrEqual(agreement * size);
      });
    } finally {
      rmSync(directory, { recursive: true });
    }
  });
});
