import { clay } from '../engine/clay';
import type { Command, EngineErrorInfo, NoteInfo } from '../engine/session_types';

/** What an error of the engine means for a user, and what can be done about it at once. */
export interface Advice {
  text: string;
  remedy?: string;
  actions: { label: string; commands: Command[] }[];
}

type Code = EngineErrorInfo['code'];
type Values = NonNullable<EngineErrorInfo['values']>;
type Fix = EngineErrorInfo['fixes'][number];
/** Without a text the engine's own stands, without a remedy none. `undone`: ", so nothing was done", if that is so. */
type Words = (values: Values, undone: string, fixes: readonly Fix[]) => { text?: string; remedy?: string };

const short = (x: number | null, digits = 3): string => String(Number((x ?? 0).toPrecision(digits)));
const place = ({ x, y, z }: Values): string => `(${[x, y, z].map((c) => short(c, 6)).join(', ')})`;
const faces = (ids: readonly string[]): string => `the ${ids.length === 1 ? 'face' : 'faces'} ${ids.slice(0, -1).join(', ')}${ids.length > 1 ? ' and ' : ''}${ids.at(-1) ?? ''}`;

const runsAway: Words = (_, undone) => ({ text: `The surface would run away${undone}.`, remedy: 'Hold its edges, or lessen the loads and the stiffness of the tools.' });
const shell = 'Make it a shell with Young’s modulus and a thickness.', convert = 'Convert it to a B-spline surface first.';

const words: Partial<Record<Code, Words>> = {
  nothing_held: () => ({ text: 'Nothing holds the surface, so there is no position in which it would rest.' }),
  nothing_free: () => ({ text: 'Everything under the brush is pinned, frozen or held.' }),
  nothing_free_in_rows: ({ rows }) => ({ text: `The ${rows} outer rows of control points that are held leave nothing free to move under the brush.` }),
  nothing_free_at_edges: (_, __, fixes) => ({
    text: 'The held edges leave nothing free to move under the brush.',
    remedy: `Press farther from the edges, or ${fixes.length > 0 ? 'let the net become finer there' : 'let the one that is near go'}.`,
  }),
  nothing_free_at_brush: () => ({ remedy: 'Brush elsewhere, or release what is held or masked.' }),
  point_frozen: () => ({ text: 'A control point there is frozen.' }),
  region_frozen: ({ surface, distance }) => ({ text: `A frozen region of ${surface} would move by ${short(distance)}.` }),
  pins_by_number: () => ({ text: 'Pinned control points would not be the same on another net.' }),
  constraint_contradicts: () => ({ text: 'That contradicts what is held already.' }),
  step_folds: (_, undone) => ({
    text: `The surface would fold over itself there${undone}.`,
    remedy: 'Press less deep or farther from held edges, go there in several strokes, or use a stiffer material.',
  }),
  step_folds_beside_edge: ({ edge, hold }, undone) => ({
    text: `The surface would fold over itself beside the held edge ${edge}${undone}.`,
    remedy: `Press less deep or farther from it, go there in several strokes, or let the edge ${hold === 'follow' ? 'follow' : 'go'}.`,
  }),
  step_runs_away: runsAway,
  step_not_finite: runsAway,
  tool_too_small: ({ size }) => ({ text: `A brush or tool of ${short(size)} is too small for this surface.`, remedy: 'Take a larger one.' }), // a finer net does not help: the surface is as large
  brush_too_small: () => ({ remedy: 'Use a larger one, or let the net be refined.' }),
  net_too_large: () => ({ remedy: 'Take a larger tool, refine where it matters, or go on with a coarse net.' }),
  edge_face_not_spline: ({ face, form }, _, fixes) => ({
    text: `That edge cannot follow: its face ${face} lies on ${form ? `a ${form.toLowerCase().replaceAll('_', ' ')}` : 'no surface'}.`,
    ...(fixes.length > 0 ? { remedy: 'As a spline surface of the same shape it can.' } : {}),
  }),
  edge_face_not_selected: ({ surface }) => ({ text: `That edge moves with the face on ${surface} too, which is not selected.` }),
  edge_would_open: ({ edge, distance }, undone) => ({ text: `The edge ${edge}, which is held, would open by ${short(distance)}${undone}.`, remedy: 'Move less of the surface, or let the edges follow.' }),
  edge_would_turn: ({ edge, angle }, undone) => ({
    text: `The tangent planes along the edge ${edge}, which are held, would turn by ${short(angle)} degrees${undone}.`,
    remedy: 'Move less of the surface, or let the edges follow.',
  }),
  edge_would_part: () => ({ remedy: 'Refine the surfaces near the edge, move it less, or hold it.' }),
  edge_left_open: (v) => ({
    text: `Nothing was saved: the edge ${v.edge} would be left ${short(v.distance)} from ${faces(v.faces)}.`,
    remedy: 'Undo what moved them, and hold the edge or let it follow; or let it open.',
  }),
  seam_would_open: ({ first, second, distance }, undone) => ({
    text: `The seam between ${first} and ${second} would open by ${short(distance)}${undone}.`,
    remedy: 'Move less of the surfaces, or let them part.',
  }),
  edges_unknown: () => ({ remedy: 'Hold something else: the outer rows of control points, or nothing.' }),
  beyond_limit: ({ distance, limit }) => ({ text: `That would move the surface by ${short(distance, 6)}; the limit is ${short(limit, 6)}.` }),
  limit_keeps_basis: () => ({ text: 'While a limit is set, knots and weights stay as they are.' }),
  limit_needs_opened_basis: ({ surface }) => ({ text: `Knots or weights of ${surface} were edited: a limit cannot be measured.`, remedy: 'Save the file and open it again, or undo those edits.' }),
  scaling_is_raw: () => ({ text: 'Strokes need the usual scaling; this document sets the raw one.' }),
  shell_needed: () => ({ remedy: shell }),
  rest_shape_needed: () => ({ remedy: 'Give it a rest shape.' }),
  no_surface: () => ({ text: 'There is no surface yet.', remedy: 'Make one in the panel “Create”, or open a file.' }),
  no_body: () => ({}),
  no_spline_surface: ({ body }) => ({ remedy: body ? 'Select one of its curves.' : 'Convert one of its other surfaces.' }),
  none_selected: () => ({ text: 'No surface is selected.', remedy: 'Click the one that is meant.' }),
  several_selected: () => ({ remedy: 'Select only the one that is meant.' }),
  not_a_spline: () => ({ remedy: convert }),
  surface_locked: ({ surface }) => ({ text: `${surface} is locked.`, remedy: 'Unlock it.' }),
};

/** What is not listed has no button: a click selects, and a panel converts. */
const labels: Partial<Record<Fix['code'], string>> = {
  hold_edges: 'Hold the edges', hold_rows: 'Hold the outer rows', hold_nothing: 'Hold nothing', release_all: 'Release all',
  release_pins: 'Free the pins', thaw: 'Thaw all', refine: 'Refine', permit_refining: 'Refine automatically', let_follow: 'Let the edge follow',
  let_go: 'Let the edge go', let_open: 'Let it open', let_part: 'Let them part', convert_and_follow: 'Convert and follow', select_and_follow: 'Select both and follow',
  end_limit: 'End the limit', unlock: 'Unlock it', normalise: 'Use the usual scaling', keep_smooth: 'Keep it smooth',
};

/** New surfaces become clay, as those do that are clicked. */
const withClay = (commands: readonly Command[]): Command[] =>
  commands.flatMap((c): Command[] => (c.do === 'convert' ? [c, { do: 'select', surfaces: c.surfaces! }, ...clay] : [c]));

function actionsFor(fixes: readonly Fix[]): Advice['actions'] {
  return fixes.flatMap(({ code, commands }) => {
    const label = code === 'let_follow' && commands.length > 1 ? 'Let the edges follow' : labels[code];
    return label ? [{ label, commands: withClay(commands) }] : [];
  });
}

/** Options of the program that are fields of a panel. */
const options: Record<string, string> = {
  unit: '“Unit”', align: '“Align”', reach: '“Reach”', noise: '“Noise”', place: '“Place”', tolerance: '“Tolerance”', refine: '“Refine ×”', keep: 'fix',
};

/** With the signs of a page instead of those of a terminal. */
function typeset(text: string): string {
  const quoted = Object.entries(options).reduce((all, [name, label]) => all.replaceAll(`--${name}`, label), text).split('`').map((part, k) => (k % 2 === 0 ? part : `“${part}”`)).join('');
  return quoted.replaceAll('>=', '≥').replaceAll('<=', '≤').replaceAll('time_step', 'time step').replaceAll('lambda', 'λ');
}

const sentence = (text: string): string => (text ? text[0]!.toUpperCase() + text.slice(1) : text);

const longest = 240; // letters of a remedy: a longer one lists all names that there are

/** Whether a remedy is not in the language of scripts, nor for a terminal. */
const forPages = (remedy: string): boolean => !remedy.includes('{') && !remedy.includes('`knead ') && remedy.length <= longest;

/** `nothingDone`: what was refused has left no trace. */
export function adviceOn(error: EngineErrorInfo, nothingDone = false): Advice {
  const known = words[error.code]?.(error.values!, nothingDone ? ', so nothing was done' : '', error.fixes);
  const remedy = known ? known.remedy : forPages(error.remedy) ? typeset(error.remedy) : undefined;
  const text = known?.text ?? sentence(`${error.place ? `${error.place}: ` : ''}${typeset(error.what)}`);
  return { text, ...(remedy ? { remedy: sentence(remedy) } : {}), actions: actionsFor(error.fixes) };
}

/** What a note says of a seam that was smooth and is not any more; null if it says something else. */
export function creaseIn({ code, values, fixes }: NoteInfo): { seam: string; text: string; remedy: string; actions: Advice['actions'] } | null {
  if (code !== 'seam_creased' || !values) return null;
  const { first, second, angle, reason } = values;
  return {
    seam: `${first} ${second}`, text: `The seam between ${first} and ${second} was smooth, and now has a crease of ${short(angle, 2)} degrees at ${place(values)}.`,
    remedy: `These surfaces are joined in position only: ${reason}. Kept smooth, they have less freedom there`, actions: actionsFor(fixes),
  };
}

/** What a note says of surfaces that nothing holds, and what holds them; null if it says something else. */
export function looseIn({ code, values, fixes }: NoteInfo): (Advice & { surfaces: string }) | null {
  if (code !== 'surface_loose' || !values) return null;
  const surfaces = values.surfaces.join(', ');
  return { surfaces, text: `Nothing holds ${surfaces}: what presses on it moves all of it.`, actions: actionsFor(fixes) };
}

/** What a note says of a face that was stopped before, or came through, another one; null if it says something else. */
export function throughIn({ code, values }: NoteInfo): { text: string; stopped: boolean } | null {
  if ((code !== 'stopped_at_face' && code !== 'through_face') || !values) return null;
  const { surface, other, depth } = values;
  const stopped = code === 'stopped_at_face', where = `${other} at ${place(values)}`;
  return {
    stopped, text: stopped ? `${surface} was stopped ${short(depth, 4)} deep: farther on it would come through ${where}.` : `${surface} comes through ${where}, ${short(depth, 4)} deep.`,
  };
}

/** The same as one line, beside a field. */
export function inOneLine(error: EngineErrorInfo): string {
  const { text, remedy } = adviceOn(error);
  return remedy ? `${text.endsWith('.') ? text.slice(0, -1) : text}: ${remedy[0]!.toLowerCase()}${remedy.slice(1)}` : text;
}
