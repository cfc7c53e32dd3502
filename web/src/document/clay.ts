import type { Command } from '../engine/session_types';

/** A material that gives way where it is pressed and nowhere else, and stays. */
export const clay: Command[] = [
  { do: 'material', preset: 'clay' },
  { do: 'evolve', mode: 'acm', lambda: 100 },
];
