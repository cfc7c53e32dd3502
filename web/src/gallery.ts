import bonnetUrl from '../../samples/bonnet.step?url';
import type { App } from './app';
import { clay } from './document/clay';
import type { Command } from './engine/session_types';

export interface Scene {
  name: string;
  about: string;
  open(app: App): Promise<unknown>;
}

const sheet = (net: number): Command[] => [
  { do: 'new', size: [200, 200], net: [net, net], degree: [3, 3], name: 'sheet' },
  { do: 'hold', rows: 2 },
  ...clay,
];

export const scenes: Scene[] = [
  { name: 'Clay sheet', about: '32 × 32 control points, edges held', open: (app) => app.startFresh('sheet', sheet(32)) },
  { name: 'Fine clay sheet', about: '64 × 64 control points', open: (app) => app.startFresh('fine sheet', sheet(64)) },
  {
    name: 'Ball on a membrane',
    about: 'a tool to move, and steps to run',
    open: (app) =>
      app.startFresh('membrane', [
        { do: 'new', size: [200, 200], net: [24, 24], name: 'membrane' },
        { do: 'hold', rows: 1 },
        { do: 'tool', name: 'ball', shape: 'sphere', radius: 35, position: [100, 100, 15] },
      ]),
  },
  {
    name: 'Trampoline',
    about: 'a sheet with mass under a heavy load, swinging',
    open: (app) =>
      app.startFresh('trampoline', [
        { do: 'new', size: [200, 200], net: [20, 20], name: 'trampoline' },
        { do: 'edge', which: 'all', hold: 'position' },
        { do: 'material', alpha: [1, 0, 1], beta: [0.002, 0.002, 0.002], mass: 1, damping: 0.6 },
        { do: 'evolve', mode: 'dynamic', time_step: 0.03 },
        { do: 'load', gravity: [0, 0, -3] },
      ]),
  },
  {
    name: 'Bonnet',
    about: 'a STEP file: the sheet metal of a car, in millimetres',
    open: async (app) => {
      const bytes = new Uint8Array(await (await fetch(bonnetUrl)).arrayBuffer());
      await app.openStep(bytes, 'bonnet.step');
      await app.select(0);
    },
  },
];
