import patchesUrl from '../../../examples/figures/patches.step?url';
import type { Command } from '../engine/session_types';
import type { Scene } from './scene';

/** The scripts of the thesis' sculpting figures, as the command line runs them. */
const scripts = import.meta.glob<{ commands: Command[] }>('../../../examples/figures/*.json', { eager: true, import: 'default' });

const figures: [file: string, name: string, about: string][] = [
  ['6_9_a', 'Fig. 6.9 a', 'a sheet drawn to a ball'],
  ['6_9_b', 'Fig. 6.9 b', 'and to a ring'],
  ['6_10', 'Fig. 6.10', 'internal forces alone: it flattens and shrinks'],
  ['6_11', 'Fig. 6.11', 'patches come apart at their seams'],
  ['6_11_coupled', 'Fig. 6.11, coupled', 'the same patches shrink as one'],
  ['6_12', 'Fig. 6.12', 'four pinned corners, pinched between'],
  ['6_13', 'Fig. 6.13', 'a bump that goes towards a bowl'],
  ['6_14', 'Fig. 6.14', 'a dent by a ball'],
  ['6_15', 'Fig. 6.15', 'a sheet falls and drapes'],
];

/** Up to the first step, which the play button makes, with the λ that it has. */
function prepared(commands: Command[]): Command[] {
  const first = commands.findIndex((c) => c.do === 'step');
  const step = commands[first];
  const begin = commands.slice(0, first);
  return step?.do === 'step' && step.lambda !== undefined ? [...begin, { do: 'evolve', lambda: step.lambda }] : begin;
}

/** Thesis Figs. 6.9 to 6.15 as scenes that wait to be played. */
export const figureScenes: Scene[] = figures.map(([file, name, about]) => {
  const { commands } = scripts[`../../../examples/figures/figure_${file}.json`]!;
  return {
    name, about, document: name.toLowerCase(), commands: prepared(commands),
    ...(commands.some((c) => c.do === 'new') ? {} : { file: patchesUrl }), // of patches in a file
  };
});
