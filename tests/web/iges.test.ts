import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { Engine } from '@knead/engine';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));

/** A flat bilinear plate in millimetres: entity 1, a B-spline surface. */
function plateIges(): Uint8Array {
  const record = (text: string, letter: string, k: number) => `${text.padEnd(72)}${letter}${String(k).padStart(7)}\n`;
  const fields = (...values: (number | string)[]) => values.map((v) => String(v).padStart(8)).join('');
  const data = ['128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,', '0.,0.,0.,9.,0.,0.,0.,9.,0.,9.,9.,0.,0.,1.,0.,1.;'];
  return new TextEncoder().encode([
    record('a plate', 'S', 1),
    record(',,,,,,,,,,,1.,2,2HMM,1,0.01,,1E-6;', 'G', 1),
    record(fields(128, 1, 0, 0, 0, 0, 0, 0, '00000000'), 'D', 1),
    record(fields(128, 0, 0, 2, 0, '', '', 'PLATE', 0), 'D', 2),
    ...data.map((text, k) => record(text.padEnd(64) + fields(1), 'P', k + 1)),
    record('S      1G      1D      2P      2', 'T', 1),
  ].join(''));
}

describe('an IGES file', () => {
  it('is opened and saved as one, the same where nothing changes', async () => {
    const engine = await Engine.load(wasm);
    const { surfaces } = engine.query('open', { file: plateIges(), name: 'plate.igs' });
    expect(surfaces).toMatchObject([{ id: '#1', name: 'PLATE', net: [2, 2] }]);
    expect(engine.query('save').file).toEqual(plateIges());
    engine.execute({ do: 'elevate', by: [1, 1] });
    const text = new TextDecoder().decode(engine.query('save').file);
    expect(text).toContain('128,2,2,2,2,0,0,1,0,0,');
    expect(text.split('\n').slice(0, -1).every((line) => line.length === 80)).toBe(true);
  });
});
