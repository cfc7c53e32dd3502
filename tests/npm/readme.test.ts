import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { bonnet, directory, lend, root, run, sample } from './support';

// What the pages show runs, and has the types that the package says.

const snippets = [...readFileSync(join(root, 'bindings/npm/README.md'), 'utf8').matchAll(/^```js\n([^]*?)^```/gm)].map(([, code]) => code!);

it('has three programs', () => expect(snippets.length).toBe(3));

it.each(snippets.map((code, k) => [k + 1, code] as const))('number %i runs', async (k, code) => {
  const where = directory('readme');
  copyFileSync(sample, join(where, 'bonnet.step'));
  writeFileSync(join(where, `${k}.mjs`), code);
  const said = await run(where, process.execPath, `${k}.mjs`);
  if (k !== 1) return;
  expect(said).toContain('out_of_range');
  const file = readFileSync(join(where, 'out.step'));
  expect(file.subarray(0, 13).toString()).toBe('ISO-10303-21;');
  expect(Buffer.compare(file, bonnet())).not.toBe(0);
  expect(readFileSync(join(where, 'sheet.igs')).length).toBeGreaterThan(1000);
});

it('the example sculpts a file, and says in one line what is wrong', async () => {
  const where = directory('example');
  copyFileSync(join(root, 'examples/npm/sculpt.mjs'), join(where, 'sculpt.mjs'));
  expect(await run(where, process.execPath, 'sculpt.mjs', sample, 'out.step')).toMatch(/moved by up to \d+/);
  expect(readFileSync(join(where, 'out.step'), 'utf8')).toMatch(/^ISO-10303-21;/);
  writeFileSync(join(where, 'no.step'), 'nothing');
  await expect(run(where, process.execPath, 'sculpt.mjs', 'no.step', 'out.step')).rejects.toMatchObject({ code: 1, stderr: expect.stringMatching(/^sculpt\.mjs: no\.step:1: .*; .*\n$/) as string });
});

describe('the types', () => {
  const options = ['--noEmit', '--strict', '--target', 'es2022', '--skipLibCheck', 'false', '--allowJs', '--checkJs'];
  const check = async (module: string, ...files: string[]) => {
    const where = directory(`types-${module}`);
    lend(where, '@types', 'undici-types');
    for (const file of files) copyFileSync(file.startsWith('/') ? file : join(directory('readme'), file), join(where, file.split('/').at(-1)!));
    return run(where, process.execPath, join(root, 'web/node_modules/typescript/bin/tsc'), ...options, '--module', module === 'bundler' ? 'esnext' : module,
      '--moduleResolution', module, '--lib', 'es2022,dom,dom.iterable', '--types', 'node', ...files.map((file) => file.split('/').at(-1)!)).catch((error: { stdout: string }) => error.stdout);
  };
  it.each(process.env.KNEAD_LONG ? ['nodenext', 'bundler'] : ['nodenext'])('are strict, for %s', async (module) => {
    const strict = directory('readme');
    writeFileSync(join(strict, 'strict.ts'), `import { open, create, KneadError, type Snapshot, type SurfaceInfo } from 'knead-cad';
import * as lean from 'knead-cad/lean';
import * as worker from 'knead-cad/worker';
const doc = await create({ unit: 'mm' });
doc.new('plane', { size: [1, 2] }).select('#1').step(3, { lambda: 20, progress: (done, total) => done < total });
const points: Float64Array = doc.surfaces[0]!.controlPoints;
const info: SurfaceInfo = doc.surfaces[0]!.info;
const snapshot: Snapshot = doc.snapshot();
const other: lean.Document = await lean.restore(snapshot, { wasmUrl: new URL('https://example.org/knead.wasm') });
const remote: worker.RemoteDocument = await (await worker.open(new Uint8Array())).select('#1').hold(2);
const shape: Promise<worker.SurfaceShape> = (await remote.surface('#1')).shape;
if (doc instanceof KneadError) console.log(points, info, other, shape, open);
// @ts-expect-error: no such command
doc.nothing();
// @ts-expect-error: no such field
doc.step(1, { colour: 2 });
// @ts-expect-error: a text
doc.step('1');
// @ts-expect-error: the engine must come from somewhere
lean.create();
`);
    expect(await check(module, '1.mjs', 'strict.ts', join(root, 'examples/npm/sculpt.mjs'), join(root, 'examples/npm/page.ts'))).toBe('');
  });
});
