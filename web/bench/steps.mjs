// Times of steps under a ball, and of the page's own strokes, in node, with all that a frame costs the worker:  node bench/steps.mjs [module.wasm ...]
// Several modules take turns, place by place, and are compared with the first.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { engineClass } from './engine.mjs';
import { accuracies, clay, detail, firstStroke, least, median, ms, nets, places, sheet, worst } from './stroke.mjs';

const modules =
  process.argv.length > 2 ? process.argv.slice(2) : [fileURLToPath(new URL('../src/engine/knead_studio.wasm', import.meta.url))];
const Engine = await engineClass();

const kinds = [
  ...accuracies.map((accuracy) => ({ name: `${accuracy} steps`, prepare: (net) => sheet(net, accuracy), frames: places })),
  { name: 'stroke', prepare: clay, frames: firstStroke },
];

for (const { net, name, prepare, frames } of nets.flatMap((net) => kinds.map((kind) => ({ net, ...kind })))) {
  const runs = [];
  for (const file of modules) {
    const engine = await Engine.load(readFileSync(file));
    engine.query('fresh', { name: 'sheet' });
    for (const command of prepare(net)) engine.execute(command);
    runs.push({ file, engine, first: [], step: [], frame: [], iterations: 0 });
  }
  // The first stroke warms up.
  for (const measured of [false, true]) {
    for (const [k, commands] of frames.entries()) {
      for (const run of runs) {
        const { engine } = run;
        const begin = performance.now();
        for (const [c, command] of commands.entries()) engine.execute(command, k > 0 || c > 0);
        const computed = performance.now();
        const state = engine.query('state');
        const picture = engine.query('picture', { surface: 0, detail });
        structuredClone({ state, picture, steps: engine.query('steps', { first: state.steps - 1 }) });
        const end = performance.now();
        if (!measured) {
          run.first.push(end - begin);
          continue;
        }
        run.step.push(computed - begin);
        run.frame.push(end - begin);
        run.iterations += state.last.iterations;
      }
    }
    for (const { engine } of runs) engine.execute({ do: 'undo' });
  }
  console.log(`${name}, ${net} x ${net} control points, milliseconds`);
  console.log('     step    frame: median    least    worst  of the first  Newton  ratio  module');
  for (const { file, first, step, frame, iterations } of runs) {
    console.log(
      `${ms(median(step))}        ${ms(median(frame))}${ms(least(frame))}${ms(worst(frame))}     ${ms(worst(first))}` +
        `   ${(iterations / frames.length).toFixed(2)}   ${(median(frame) / median(runs[0].frame)).toFixed(2)}   ${file}`,
    );
  }
}
