import type { Command } from './session_types';

/** A material that yields only where it is pressed, and stays deformed. */
export const clay: Command[] = [
  { do: 'material', preset: 'clay' },
  { do: 'evolve', mode: 'acm', lambda: 100, accuracy: 'interactive' },
];
