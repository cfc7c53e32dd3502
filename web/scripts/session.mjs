// What users of the studio do in their first minutes, for scripts/split.mjs: whatever is called here is in the module that the
// page loads first. What they do later may be slower by a millisecond, once.

const clay = [{ do: 'material', preset: 'clay' }, { do: 'evolve', mode: 'acm', lambda: 100, accuracy: 'interactive' }];
const kinds = ['inflate', 'pull', 'push', 'flatten', 'smooth', 'pinch', 'crease', 'ridge', 'mask', 'unmask'];
const aboutPlaces = [{ kind: 'grab', by: [1, 2, 3.5] }, { kind: 'twist', angle: 20 }, { kind: 'scale', factor: 1.2 }];
const displays = ['plain', 'deviation', 'mean_curvature', 'gaussian_curvature', 'zebra'];

/** A step that would fold the surface is refused, as for users. */
function tried(does) {
  try {
    does();
  } catch (error) {
    if (error.info?.kind !== 'numerical') throw error;
  }
}

/** One command after the other, as one entry of the history. */
function act(engine, commands, join = false) {
  for (const [k, command] of commands.entries()) tried(() => engine.execute(command, join || k > 0));
}

function refused(engine, command) {
  for (const does of [() => engine.execute(command), () => engine.query('rehearse', { commands: [{ do: 'step' }, command] })]) {
    try {
      does();
    } catch {
      continue;
    }
    throw new Error(`${JSON.stringify(command)} is not refused`);
  }
}

/** What a frame and the panels show. */
function look(engine) {
  const state = engine.query('state'), known = engine.query('displays').map(({ name }) => name);
  engine.query('steps', { first: Math.max(0, state.steps - 400) });
  for (const k of state.surfaces.keys()) {
    for (const display of displays.filter((name) => known.includes(name))) engine.query('picture', { surface: k, detail: 48, display, settings: {} });
    engine.query('picture', { surface: k, detail: 48, opened: true });
    engine.query('picture', { surface: k, detail: 48, window: { lower: [0.2, 0.2], upper: [0.6, 0.6], tolerance: 0.1 } });
    engine.query('control_points', { surface: k });
    engine.query('face_edges', { surface: k });
    engine.query('edge_distance', { surface: k });
    engine.query('trims', { surface: k });
  }
  for (const k of state.tools.keys()) engine.query('tool_picture', { tool: k });
  for (const k of state.bodies.keys()) engine.query('body_picture', { body: k });
  engine.query('range');
  return state;
}

/** A point that is drawn, in file units. */
function pointOn(engine, k, [s, t]) {
  const { positions, s: along, t: across } = engine.query('picture', { surface: k, detail: 48 });
  const index = (fractions, x) => fractions.reduce((best, f, i) => (Math.abs(f - x) < Math.abs(fractions[best] - x) ? i : best), 0);
  const i = index(along, s), j = index(across, t);
  return engine.query('origin').map((x, axis) => x + positions[3 * (i * across.length + j) + axis]);
}

function strokes(engine, k, radius) {
  const points = [[0.4, 0.5], [0.44, 0.5], [0.5, 0.52]].map((at) => pointOn(engine, k, at));
  const ball = { do: 'tool', name: 'brush', shape: 'sphere', radius, mode: 'collision', plasticity: 1, touches: 'visible' };
  const pressed = [{ ...ball, position: points[0] }, { do: 'stroke', tool: 'brush', path: [points[0]], open: true }];
  tried(() => engine.query('rehearse', { commands: pressed }));
  act(engine, pressed);
  act(engine, [{ do: 'stroke', tool: 'brush', path: points.slice(1), open: true }], true);
  look(engine);
  act(engine, [{ do: 'stroke', tool: 'brush', path: [] }, { do: 'remove', tool: 'brush' }], true);
  act(engine, [{ do: 'relax', at: [0.4, 0.5], radius, strength: 0.5 }]);
  act(engine, [{ do: 'drag', at: [0.6, 0.5], by: [0, 1, radius / 4], radius, steps: 1 }]);
  for (const kind of kinds) act(engine, [{ do: 'brush', kind, radius, path: [[0.4, 0.4], [0.5, 0.45]], open: true }, { do: 'brush', kind, radius, path: [[0.52, 0.45]] }]);
  for (const fields of aboutPlaces) act(engine, [{ do: 'brush', ...fields, radius, path: [[0.4, 0.4]] }]);
  look(engine);
}

/** Tools that stay in the scene, put by numbers with and without a fraction, moved, changed and removed. */
function tools(engine, k, radius) {
  const whole = Math.max(1, Math.round(radius));
  for (const shape of [{ shape: 'sphere', radius: whole }, { shape: 'sphere', radius }, { shape: 'cylinder', radius, height: radius }, { shape: 'box', sizes: [radius, radius, whole] }]) {
    act(engine, [{ do: 'tool', name: 'ball', ...shape, position: pointOn(engine, k, [0.5, 0.5]) }]);
    act(engine, [{ do: 'step' }]);
    look(engine);
    act(engine, [{ do: 'move', tool: 'ball', by: [0.5, 0, -1] }, { do: 'step', count: 2 }]);
    act(engine, [{ do: 'edit_tool', tool: 'ball', mode: 'proximity' }, { do: 'step' }]);
    act(engine, [{ do: 'remove', tool: 'ball' }]);
    act(engine, [{ do: 'tool', name: 'ball', ...shape, at: [0.5, 0.5] }, { do: 'step' }, { do: 'remove', tool: 'ball' }]);
  }
}

function travel(engine) {
  for (let k = 0; k < 4; ++k) engine.execute({ do: 'undo' });
  look(engine);
  for (let k = 0; k < 4; ++k) engine.execute({ do: 'redo' });
  look(engine);
}

/** `scenes`: those of the gallery (src/document/scenes.ts), the one with a file on the bytes of `file`. */
export function session(engine, scenes, file) {
  for (const scene of scenes) {
    if (scene.file) engine.query('open', { file, name: scene.document });
    else engine.query('fresh', { name: scene.document });
    act(engine, scene.commands ?? []);
    engine.query('assembly');
    engine.query('context');
    const { surfaces } = look(engine);
    if (scene.file) act(engine, [{ do: 'select', surface: surfaces[0].id }, { do: 'hold', mode: 'position' }, ...clay]);
    const { lower, upper } = surfaces[0];
    const radius = 0.05 * Math.hypot(...upper.map((x, axis) => x - lower[axis]));
    engine.execute({ do: 'step' });
    strokes(engine, 0, radius);
    tools(engine, 0, radius);
    travel(engine);
    engine.query('journal');
    engine.query('restore', { source: scene.file ? file : null, name: scene.document, snapshot: engine.query('snapshot', { history_bytes: 2 ** 20 }) });
    look(engine);
    engine.query('save');
    engine.query('surface', { surface: 0 });
  }
  refused(engine, { do: 'nothing' });
  refused(engine, { do: 'step', count: -1 });
  refused(engine, { do: 'select', surface: '#99' });
}
