import { clay } from './clay';
import type { Engine } from '@knead/engine';
import { type Command, KneadError, type Vector3 } from './session_types';

/** Of the brush, in diagonals of what is selected, until the user chooses another one. */
export const usualRadius = 0.08;

const size = 200, net = 32;
const detail = 96;

const ball = (radius: number, position: Vector3): Command[] => [
  { do: 'tool', name: 'brush', shape: 'sphere', radius, position, mode: 'collision', plasticity: 1, touches: 'visible' },
  { do: 'stroke', tool: 'brush', path: [position], open: true },
];

/** What a frame shows. */
function look(engine: Engine): void {
  const { steps } = engine.query('state');
  engine.query('steps', { first: Math.max(0, steps - 1) });
  engine.query('picture', { surface: 0, detail });
}

/** What users do first, in a session of its own: strokes on a sheet. The caller can stop after every frame. */
export function* strokes(engine: Engine): Generator<void> {
  const sheet: Command[] = [{ do: 'new', size: [size, size], net: [net, net] }, { do: 'hold', rows: 2 }, ...clay];
  const lifted: Command[] = [{ do: 'stroke', tool: 'brush', path: [] }, { do: 'remove', tool: 'brush' }];
  engine.query('fresh', { name: '' });
  for (const command of sheet) engine.execute(command);
  look(engine);
  yield;
  const radius = usualRadius * Math.hypot(size, size);
  for (let line = 0; line < 4; ++line) {
    const across = 0.35 + 0.1 * line;
    for (let k = 0; k < 12; ++k) {
      const position: Vector3 = [size * 0.3 + 0.2 * radius * k, size * across, 0.5 * radius];
      const [tool, stroke] = ball(radius, position) as [Command, Command];
      if (k === 0) engine.execute(tool);
      engine.execute(stroke, true);
      look(engine);
      yield;
    }
    for (const command of lifted) engine.execute(command, true);
    engine.execute({ do: 'relax', at: [0.5, across], radius, strength: 0.5 });
    look(engine);
    yield;
    engine.execute({ do: 'drag', at: [0.6, across], by: [0, 0, radius / 4], radius, steps: 1 });
    engine.execute({ do: 'undo' });
    look(engine);
    yield;
  }
}

const mostControlPoints = 5000; // a request waits for the rehearsal of one stroke, as long as the first frame would take without it

/** The model that a stroke needs is made while nobody waits for it: by one that touches nothing, and is forgotten. */
export function rehearse(engine: Engine): void {
  const { selection, surfaces, tools } = engine.query('state');
  const chosen = selection.map((k) => surfaces[k]!);
  const points = chosen.reduce((sum, s) => sum + s.net[0] * s.net[1], 0);
  if (points === 0 || points > mostControlPoints || tools.length > 0) return;
  const lower = [0, 1, 2].map((axis) => Math.min(...chosen.map((s) => s.lower[axis]!)));
  const upper = [0, 1, 2].map((axis) => Math.max(...chosen.map((s) => s.upper[axis]!)));
  const [x, y, z] = upper.map((most, axis) => most - lower[axis]!) as Vector3;
  const diagonal = Math.sqrt(x * x + y * y + z * z);
  if (diagonal === 0) return;
  const away = upper.map((most) => most + 2 * diagonal) as Vector3;
  try {
    engine.query('rehearse', { commands: ball(usualRadius * diagonal, away) });
  } catch (error) {
    if (!(error instanceof KneadError)) throw error; // what is refused now would be refused then, and told
  }
}
