// Sculpts a CAD file: node sculpt.mjs IN.step OUT.step. Change the numbers to suit your part.
import { readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';

import { KneadError, open } from 'knead-cad';

const [source, target] = process.argv.slice(2);
try {
  const doc = await open(readFileSync(source), { name: basename(source) });
  const skin = doc.surfaces.reduce((most, s) => (s.controlPoints.length > most.controlPoints.length ? s : most));
  const { lower, upper } = skin.info;
  const size = Math.max(...upper.map((x, k) => x - lower[k]));
  console.log(`${skin.id} ${skin.label}, about ${size.toPrecision(4)} ${skin.unit}`);

  doc.select(skin.id).hold({ mode: 'position' }); // the edges of its faces stay
  doc.tool('ball', { shape: 'sphere', radius: 0.1 * size, at: 'middle' }).move('ball', { by: [0, 0, 0.07 * size] });
  doc.step(15, { lambda: 20, progress: (done, total) => process.stderr.write(`\r${done}/${total}`) });

  const { largest_displacement, notes } = doc.report;
  console.log(`\nmoved by up to ${largest_displacement.toPrecision(4)} ${skin.unit}`);
  for (const note of notes) console.log('note:', note);
  writeFileSync(target, doc.save());
} catch (error) {
  if (!(error instanceof KneadError)) throw error;
  console.error(`sculpt.mjs: ${error.message}`);
  process.exitCode = 1;
}
