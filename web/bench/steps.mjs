// Times of the steps of a stroke, with all that a frame costs the worker:  node bench/steps.mjs [module.wasm ...]
//
// The stroke is the studio's own (src/view/brush.ts): a ball of 0.08 diagonals, half sunk into a sheet of clay, moved by
// 0.4 radii at a time. Several modules take turns, place by place, and are compared with the first.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { engineClass } from './engine.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const modules = process.argv.length > 2 ? process.argv.slice(2) : [here('../src/engine/knead_studio.wasm')];
const Engine = await engineClass();

const size = 200, radius = 0.08 * Math.hypot(size, size), detail = 96;
const clay = [
  { do: 'hold', rows: 2 },
  { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] },
  { do: 'evolve', mode: 'acm', lambda: 100 },
];
const ball = (x, y) => [
  { do: 'tool', name: 'brush', shape: 'sphere', radius, position: [x, y, 0.5 * radius], mode: 'collision', plasticity: 1 },
  { do: 'step' },
];
// There and back along slightly other lines, so that it meets what it left.
const places = Array.from({ length: 60 }, (_, k) => {
  const along = (k % 12) * 0.4 * radius, line = Math.floor(k / 12);
  return [size * 0.3 + (line % 2 === 0 ? along : 11 * 0.4 * radius - along), size * 0.4 + line * 0.35 * radius];
});

const sorted = (times) => [...times].sort((a, b) => a - b);
const median = (times) => sorted(times)[Math.floor(times.length / 2)];
const worst = (times) => Math.max(...times);
const ms = (t) => t.toFixed(2).padStart(8);

async function stroke(net) {
  const runs = [];
  for (const file of modules) {
    const engine = await Engine.load(readFileSync(file));
    engine.fresh('sheet');
    for (const command of [{ do: 'new', size: [size, size], net: [net, net] }, ...clay]) engine.execute(command);
    runs.push({ file, engine, first: [], step: [], frame: [], iterations: 0 });
  }
  let frames = 0;
  for (const round of [0, 1]) {
    for (const run of runs) {
      const engine = run.engine;
      if (round === 1) for (let k = 0; k < 1; ++k) engine.execute({ do: 'undo' });
    }
    for (const [k, place] of places.entries()) {
      for (const run of runs) {
        const { engine } = run;
        const begin = performance.now();
        for (const [c, command] of ball(...place).entries()) engine.execute(command, k > 0 || c > 0);
        const computed = performance.now();
        const state = engine.state();
        engine.paint(0, detail, 'none');
        const steps = engine.steps(Math.max(0, state.steps - 1));
        structuredClone({ state, steps });
        const end = performance.now();
        if (round === 0) run.first.push(end - begin);
        else {
          run.step.push(computed - begin);
          run.frame.push(end - begin);
          run.iterations += state.last.iterations;
        }
      }
      ++frames;
    }
  }
  console.log(`${net} x ${net} control points, milliseconds`);
  console.log('     step    frame    worst  first frames  Newton  ratio  module');
  for (const run of runs) {
    console.log(
      `${ms(median(run.step))} ${ms(median(run.frame))} ${ms(worst(run.frame))}      ${ms(worst(run.first))}` +
        `  ${(run.iterations / places.length).toFixed(2).padStart(6)}  ${(median(run.frame) / median(runs[0].frame)).toFixed(2)}   ${run.file}`,
    );
  }
  return runs;
}

for (const net of [32, 64]) await stroke(net);
