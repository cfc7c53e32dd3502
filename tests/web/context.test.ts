import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { notShown } from '@studio/document/context';
import { Engine } from '@knead/engine';

import { facesStep } from './faces_step';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));

describe('faces round the surfaces', () => {
  it('come as triangles relative to the origin of the session', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: facesStep(), name: 'faces.step' });
    const context = engine.query('context')!;
    expect(context.skipped).toEqual([]);
    expect(context.indices.length).toBe(6); // a square
    expect(context.faces).toEqual([{ id: expect.stringMatching(/^#\d+$/), surface: expect.stringMatching(/^#\d+$/), form: 'PLANE', triangles: 2 }]);
    const zs = [...context.positions].filter((_, k) => k % 3 === 2);
    expect(zs.every((z) => z === -4 - engine.query('origin')[2])).toBe(true);
    expect([...context.normals].filter((_, k) => k % 3 === 2)).toEqual([1, 1, 1, 1]);
  });

  it('may be all there is, until one is converted', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: facesStep(true), name: 'planes.step' });
    const [face] = engine.query('context')!.faces;
    expect(engine.query('origin')[2]).toBe(-4);
    engine.execute({ do: 'convert', surfaces: [face!.surface] });
    expect(engine.query('context')!.faces).toEqual([]);
    expect(engine.query('trims', { surface: 0 })).toBeNull(); // the square is all of it
  });

  it('leave what the faces show of the surfaces, in fractions of the domain', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: facesStep(), name: 'faces.step' });
    const trim = engine.query('trims', { surface: 0 })!;
    expect(trim.faces.length).toBe(1);
    const [loop] = trim.faces[0]!;
    // x = -5 + 10 s only where the control points are the Greville abscissae: by symmetry all is within the middle.
    expect(loop!.every((x) => x > 0.05 && x < 0.95)).toBe(true);
    expect(Math.min(...loop!) + Math.max(...loop!)).toBeCloseTo(1, 3);
    expect(engine.query('trims', { surface: 7 })).toBeNull();
  });

  it('belong to parts where the file is an assembly', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: facesStep(), name: 'faces.step' });
    expect(engine.query('assembly')).toBeNull();
    engine.query('open', { file: readFileSync(fileURLToPath(new URL('../../samples/bonnet.step', import.meta.url))), name: 'bonnet.step' });
    const { parts } = engine.query('assembly')!;
    expect(parts.map(({ name, places }) => [name, places.length])).toEqual([['Bonnet', 1], ['Headlamp ring', 1]]);
    for (const { id } of engine.query('context')!.faces) expect(parts.filter(({ faces }) => faces.includes(id)).length).toBe(1);
  });

  it('may be triangles of the file itself, which are marked; what is not drawn is named', async () => {
    const engine = await Engine.load(wasm);
    const records = [
      "#9001=COORDINATES_LIST('',4,((0.,0.,5.),(1.,0.,5.),(0.,1.,5.),(1.,1.,5.)));",
      "#9002=COMPLEX_TRIANGULATED_FACE('',#9001,4,((0.,0.,1.)),$,(),((1,2,3,4)),());",
      "#9003=TRIANGULATED_FACE('',#9001,4,(),$,(),((1,2,5)));",
      "#9004=GEOMETRIC_SET('',(#9005));", "#9005=CARTESIAN_POINT('',(0.,0.,0.));",
    ].join('\n');
    const text = new TextDecoder().decode(facesStep());
    engine.query('open', { file: new TextEncoder().encode(text.replace('\nDATA;\n', `\nDATA;\n${records}\n`)), name: 'triangles.step' });
    const context = engine.query('context')!;
    expect(context.faces.map(({ form, triangles }) => [form, triangles])).toEqual([['PLANE', 2], ['TRIANGLES', 2]]);
    expect(context.skipped.map(({ id }) => id)).toEqual(['#9003']);
    expect(context.left_out).toEqual([expect.stringMatching(/^1 face that cannot be drawn \(#9003\): an index is 5/), '1 point (#9005): a point has no surface']);
    expect(notShown(context.left_out)).toMatch(/^Not shown: 1 face .* Nothing of the file is lost\.$/);
    expect(notShown([])).toBe('');
    expect(notShown(['a', 'b', 'c', 'd'])).toContain('a. b. c. And 1 more');
  });

  it('are none without a file', async () => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'sheet' });
    engine.execute({ do: 'new', size: [10, 10], net: [4, 4] });
    expect(engine.query('context')).toBeNull();
    expect(engine.query('trims', { surface: 0 })).toBeNull();
  });
});
