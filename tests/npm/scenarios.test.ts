import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import type { AnyCommand, Document, Script } from '../../bindings/npm/src/index';
import { bonnet, knead, native, root, sample } from './support';

// The same scenarios as in Python and in the program: the control points are the program's to 1e-9 of the size.

const names = ['all_shapes', 'constraints', 'edits', 'forms', 'nets', 'press_and_take_back', 'seams', 'shell'];
const read = (path: string) => JSON.parse(readFileSync(join(root, path), 'utf8')) as never;

/** What the program makes of a script, and the document that it began with here. */
function natively(script: Script, given: string[]): Uint8Array {
  const directory = mkdtempSync(join(tmpdir(), 'knead-'));
  try {
    const [file, out] = [join(directory, 'script.json'), join(directory, 'out.step')];
    writeFileSync(file, typeof script === 'string' ? script : JSON.stringify(script));
    execFileSync(native, ['sculpt', ...given, '-o', out, '--script', file], { stdio: 'pipe' });
    return new Uint8Array(readFileSync(out));
  } finally {
    rmSync(directory, { recursive: true });
  }
}

async function same(doc: Document, file: Uint8Array): Promise<void> {
  const { open } = await knead();
  const there = await open(file, { name: 'native.step' });
  const here = await open(doc.save(), { name: 'here.step' }); // curves and volumes are surfaces and curves of files
  expect(here.surfaces.length).toBe(there.surfaces.length);
  for (const [k, surface] of there.surfaces.entries()) {
    const points = surface.controlPoints, mine = here.surfaces[k]!.controlPoints;
    expect(mine.length).toBe(points.length);
    const size = points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    expect(points.reduce((most, x, i) => Math.max(most, Math.abs(x - mine[i]!)), 0)).toBeLessThanOrEqual(1e-9 * size);
  }
}

it.each(names)('%s', async (name) => {
  const { open, create, KneadError } = await knead();
  const steps = read(`tests/scenarios/${name}.json`) as { open?: string; steps: (AnyCommand | { refused: AnyCommand; where: string } | object)[] };
  const commands: AnyCommand[] = [{ do: 'hold', rows: 0, all: true }];
  const file = steps.open && join(root, steps.open);
  const doc = file ? await open(new Uint8Array(readFileSync(file)), { name: basename(file) }) : await create({ name });
  doc.run(commands);
  for (const step of steps.steps) {
    if ('do' in step) {
      commands.push(step);
      const { do: command, ...fields } = step;
      (doc[command] as (fields: object) => Document).call(doc, fields);
    } else if ('refused' in step) {
      const before = doc.state;
      expect(() => doc.run([step.refused])).toThrow(KneadError);
      expect(doc.state).toEqual(before);
    }
  }
  await same(doc, natively({ knead: 2, commands }, [file || '--new']));
});

it('the sample', async () => {
  const { open } = await knead();
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  const script = readFileSync(join(root, 'samples/bonnet.json'), 'utf8');
  doc.run(script);
  await same(doc, natively(script, [sample]));
  expect(JSON.parse(doc.script)).toHaveProperty('knead', 2);
});

it('a file in which nothing was done is saved as it is', async () => {
  const { open } = await knead();
  for (const file of [sample, join(root, 'examples/figures/patches.step')]) {
    const bytes = new Uint8Array(readFileSync(file));
    expect(Buffer.compare((await open(bytes, { name: basename(file) })).save(), bytes)).toBe(0);
  }
});
