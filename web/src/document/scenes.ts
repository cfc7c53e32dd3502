import bonnetUrl from '../../../samples/bonnet.step?url';
import { clay } from '../engine/clay';
import type { Command, Vector3 } from '../engine/session_types';
import { figureScenes } from './figures';
import type { Scene } from './scene';

const finer: Command = { do: 'refine', region: [[0, 1], [0, 1]] };

const sheet = (net: number): Command[] => [
  { do: 'new', size: [200, 200], net: [net, net], degree: [3, 3], name: 'sheet' },
  { do: 'hold', rows: 2 },
  ...clay,
];

const round = (x: number): number => Math.round(1000 * x) / 1000;

/** Half a ship, 400 long, from gunwale to gunwale: control points by formulas, so that the lines are fair. */
function hull(): Command {
  const [stations, waterlines] = [24, 16];
  const points: Vector3[] = [];
  for (let i = 0; i < stations; ++i) {
    const s = i / (stations - 1); // from the transom to the bow
    const width = s < 0.45 ? 1 - 0.35 * ((0.45 - s) / 0.45) ** 2 : 1 - 0.97 * ((s - 0.45) / 0.55) ** 2.2;
    const keel = 1 - 0.55 * Math.max(0, (s - 0.75) / 0.25) ** 2 - 0.35 * Math.max(0, (0.3 - s) / 0.3) ** 2;
    for (let j = 0; j < waterlines; ++j) {
      const t = (2 * j) / (waterlines - 1) - 1;
      const [sine, cosine] = [Math.sin((Math.PI / 2) * t), Math.cos((Math.PI / 2) * t)];
      const flare = 1 + 0.25 * s * (1 - cosine);
      points.push([round(400 * s + 18 * s * (1 - cosine)), round(52 * width * flare * Math.sign(sine) * Math.abs(sine) ** 0.75), round(-48 * keel * cosine ** 0.85)]);
    }
  }
  return { do: 'new', name: 'hull', net: [stations, waterlines], degree: [3, 3], points };
}

export const scenes: Scene[] = [
  { name: 'Clay sheet', about: '32 × 32 control points, edges held', document: 'sheet', commands: sheet(32) },
  { name: 'Fine clay sheet', about: '64 × 64 control points', document: 'fine sheet', commands: sheet(64) },
  { name: 'Bonnet', about: 'a STEP file: the sheet metal of a car', document: 'bonnet.step', file: bonnetUrl },
  {
    name: 'Bottle', about: 'an exact surface of revolution', document: 'bottle',
    commands: [
      { do: 'new', shape: 'revolution', name: 'bottle', degree: [2, 3],
        profile: [[26, 0], [40, 0], [44, 14], [44, 60], [44, 104], [40, 128], [15, 138], [14, 160], [14, 176], [17, 184]] },
      finer, finer,
      { do: 'edge', which: 'v0', hold: 'position' },
      { do: 'edge', which: 'v1', hold: 'position' },
      ...clay,
    ],
  },
  {
    name: 'Torus', about: 'exact circles, the inner side frozen', document: 'torus',
    commands: [{ do: 'new', shape: 'torus', radius: 70, minor: 30, name: 'torus' }, finer, finer, finer,
      { do: 'freeze', region: [[0, 1], [0.44, 0.56]] }, ...clay],
  },
  {
    name: 'Two patches', about: 'that stay together at their seam', document: 'two patches',
    commands: [
      { do: 'new', size: [120, 160], net: [20, 26], name: 'left' },
      { do: 'new', size: [120, 160], net: [16, 26], position: [120, 0, 0], name: 'right' },
      ...(['#1', '#2'] as const).flatMap((surface): Command[] => [
        { do: 'select', surface },
        ...([surface === '#1' ? 'u0' : 'u1', 'v0', 'v1'] as const).map((which): Command => ({ do: 'edge', which, hold: 'tangent' })),
      ]),
      { do: 'select', surfaces: ['#1', '#2'] },
      ...clay,
    ],
  },
  { name: 'Hull', about: 'a ship of explicit control points', document: 'hull', commands: [hull(), { do: 'hold', rows: 1 }, ...clay] },
  {
    name: 'Ball on a membrane', about: 'a tool to move, and steps to run', document: 'membrane',
    commands: [
      { do: 'new', size: [200, 200], net: [24, 24], name: 'membrane' },
      { do: 'hold', rows: 1 },
      { do: 'tool', name: 'ball', shape: 'sphere', radius: 35, position: [100, 100, 15] },
    ],
  },
  {
    name: 'Drape', about: 'a cloth over a ball: press play', document: 'drape',
    commands: [
      { do: 'new', size: [200, 200], net: [24, 24], name: 'cloth' },
      { do: 'material', alpha: [1, 0.2, 1], beta: [0.0005, 0.0005, 0.0005], mass: 1, damping: 1 },
      { do: 'pin', control_points: [[0, 0], [0, 23], [23, 0], [23, 23]] },
      { do: 'tool', name: 'ball', shape: 'sphere', radius: 45, position: [100, 100, -50], friction: 0.3 },
      { do: 'evolve', mode: 'dynamic', time_step: 0.03 },
      { do: 'load', gravity: [0, 0, -1.5] },
    ],
  },
  {
    name: 'Trampoline', about: 'a sheet with mass under a heavy load, swinging', document: 'trampoline',
    commands: [
      { do: 'new', size: [200, 200], net: [20, 20], name: 'trampoline' },
      { do: 'edge', which: 'all', hold: 'position' },
      { do: 'material', alpha: [1, 0, 1], beta: [0.002, 0.002, 0.002], mass: 1, damping: 0.6 },
      { do: 'evolve', mode: 'dynamic', time_step: 0.03 },
      { do: 'load', gravity: [0, 0, -3] },
    ],
  },
  ...figureScenes,
];
