import type { Command } from '../engine/session_types';

/** A material that gives way where it is pressed and hardly anywhere else: many small steps of the implicit scheme. */
export const clay: Command[] = [
  { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] },
  { do: 'evolve', mode: 'acm', lambda: 100 },
];
