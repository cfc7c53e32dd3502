import { clay } from '../engine/clay';
import type { Command, EngineErrorInfo } from '../engine/session_types';

/** What an error of the engine means for a user, and what can be done about it at once. */
export interface Advice {
  text: string;
  remedy?: string;
  actions: { label: string; commands: Command[] }[];
}

const holdEdges = { label: 'Hold the edges', commands: [{ do: 'hold', rows: 2 }] satisfies Command[] };
const refine = { label: 'Refine', commands: [{ do: 'refine', region: [[0, 1], [0, 1]] }] satisfies Command[] };
const refineWhereNeeded = { label: 'Refine where needed', commands: [{ do: 'refine', permission: 'trims' }] satisfies Command[] };
const release = (label: string, ...what: string[]) => ({ label, commands: [{ do: 'release', ...(what.length > 0 ? { what } : {}) }] satisfies Command[] });

/** What a remedy of the engine says in JSON. */
const commandsIn = (remedy: string): Command[] => (remedy.match(/\{"do":.*?\}/g) ?? []).map((c) => JSON.parse(c) as Command);

const follow = (edge: string): Command => ({ do: 'edge', edge, hold: 'follow' });

/** By what the engine says: the first that fits. */
const known: [RegExp, (found: RegExpExecArray, error: EngineErrorInfo) => Advice][] = [
  [/^the face (#\d+) would have to follow the edge, but lies on #\d+ (\w+)/, ([, face, form], { where, remedy }) => {
    const [convert, select] = commandsIn(remedy);
    const text = `That edge cannot follow: its face ${face} lies on a ${form!.toLowerCase().replaceAll('_', ' ')}.`;
    if (convert?.do !== 'convert' || !select) return { text, actions: [] };
    // New surfaces become clay, as those do that are clicked.
    const commands: Command[] = [convert, { do: 'select', surfaces: convert.surfaces! }, ...clay, select, follow(where)];
    return { text, remedy: 'As a spline surface of the same shape it can.', actions: [{ label: 'Convert and follow', commands }] };
  }],
  [/^the face on (#\d+) would have to follow the edge, but it is not selected/, ([, surface], { where, remedy }) => ({
    text: `That edge moves with the face on ${surface} too, which is not selected.`,
    actions: [{ label: 'Select both and follow', commands: [...commandsIn(remedy), follow(where)] }] })],
  [/^nothing holds the model in place/, () => ({
    text: 'Nothing holds the surface, so there is no position in which it would rest.', actions: [holdEdges] })],
  [/^nothing is free to move under the tool .*hold of the edges of its faces/, () => ({
    text: 'The held edges leave nothing free to move under the brush.', remedy: 'Press farther from the edges, or let the net become finer there.',
    actions: [refineWhereNeeded] })],
  [/^nothing is free to move under the tool .*hold of (\d+) rows/, ([, rows]) => ({
    text: `The ${rows} outer rows of control points that are held leave nothing free to move under the brush.`, actions: [refine, release('Hold nothing', 'hold')] })],
  [/^nothing is free to move under the tool/, () => ({
    text: 'Everything under the brush is pinned, frozen or held.', actions: [release('Release all')] })],
  [/^the step folds .* beside the edge (#\d+), which is held/, ([, edge], { remedy }) => ({
    text: `The surface would fold over itself beside the held edge ${edge}, so nothing was done.`,
    remedy: 'Press less deep or farther from it, go there in several strokes, or let the edge follow.',
    actions: [{ label: 'Let the edge follow', commands: commandsIn(remedy) }] })],
  [/^the edge (#\d+) on .* is held, and would open by (\S+) at/, ([, edge, distance], { remedy }) => ({
    text: `The edge ${edge}, which is held, would open by ${distance}, so nothing was done.`, remedy: 'Move less of the surface, or let the edges follow.',
    actions: [{ label: 'Let the edges follow', commands: commandsIn(remedy).filter((c) => c.do === 'edge') }] })],
  [/^the tangent planes along the edge (#\d+) on .* are held, and would turn by (\S+) degrees/, ([, edge, angle], { remedy }) => ({
    text: `The tangent planes along the edge ${edge}, which are held, would turn by ${angle} degrees, so nothing was done.`,
    remedy: 'Move less of the surface, or let the edges follow.',
    actions: [{ label: 'Let the edges follow', commands: commandsIn(remedy).filter((c) => c.do === 'edge') }] })],
  [/^the edge (#\d+) would be left (\S+) from (the faces? .*?) at \(.*?; nothing is written/, ([, edge, distance, faces], { remedy }) => ({
    text: `Nothing was saved: the edge ${edge} would be left ${distance} from ${faces}.`, remedy: 'Undo what moved them, and hold the edge or let it follow; or let it open.',
    actions: [{ label: 'Let it open', commands: commandsIn(remedy).slice(-2) }] })],
  [/^the step folds/, () => ({
    text: 'The surface would fold over itself there, so nothing was done.', remedy: 'Press less deep or farther from held edges, go there in several strokes, or use a stiffer material.', actions: [] })],
  [/^the step (runs away|gives no finite result)/, () => ({
    text: 'The surface would run away, so nothing was done.', remedy: 'Hold its edges, or lessen the loads and the stiffness of the tools.', actions: [holdEdges] })],
  [/^the surface would be (\S+) from where it was opened, and (\S+) is the limit/, ([, far, limit]) => ({
    text: `That would move the surface by ${far}; the limit is ${limit}.`, actions: [{ label: 'End the limit', commands: [{ do: 'limit' }] }] })],
  [/a limit is measured on|limit is measured on those/, () => ({
    text: 'While a limit is set, knots and weights stay as they are.', actions: [{ label: 'End the limit', commands: [{ do: 'limit' }] }] })],
  [/need a model in normalised units/, () => ({
    text: 'Strokes need the usual scaling; this document sets the raw one.', actions: [{ label: 'Use the usual scaling', commands: [{ do: 'scaling', mode: 'normalised' }] }] })],
  [/ is frozen$/, () => ({ text: 'A control point there is frozen.', actions: [release('Thaw all', 'freeze')] })],
  [/^the constraint contradicts/, () => ({ text: 'That contradicts what is held already.', actions: [release('Release all')] })],
  [/^control points are pinned by their numbers/, () => ({ text: 'Pinned control points would not be the same on another net.', actions: [release('Free the pins', 'pins')] })],
  [/surfaces is selected$/, () => ({ text: 'No surface is selected.', remedy: 'Click the one that is meant.', actions: [] })],
  [/^there is no surface yet/, () => ({ text: 'There is no surface yet.', remedy: 'Make one in the panel “Create”, or open a file.', actions: [] })],
  [/^a tool of size (\S+) is too small/, ([, size]) => ({
    text: `A brush or tool of ${size} is too small for this surface.`, remedy: 'Take a larger one.', actions: [] })], // a finer net does not help: the surface is as large
];

/** Without what only scripts need: fields in JSON, names of commands. */
function plain(text: string): string {
  return text.replace(/,? ?(?:or go on regardless with )?"allow": ?"(?:held|through)"/g, '').replace(/[,:]? ?\{.*?\}/g, '').replace(/`([^`]*)`/g, '“$1”').replace(/>=/g, '≥').replace(/<=/g, '≤')
    .replaceAll('time_step', 'time step').replaceAll('lambda', 'λ').replace(/[;,] *$/, '').trim();
}

const sentence = (text: string): string => (text ? text[0]!.toUpperCase() + text.slice(1) : text);

export function adviceOn(error: EngineErrorInfo): Advice {
  for (const [pattern, advice] of known) {
    const found = pattern.exec(error.what);
    if (found) return advice(found, error);
  }
  // Places of a file say where; fields of commands do not.
  const place = /^[a-z_]+\d*(\[\d+\])?$/i.test(error.where) ? '' : error.where;
  const remedy = plain(error.remedy);
  return { text: sentence(`${place ? `${place}: ` : ''}${plain(error.what)}`), ...(remedy ? { remedy: sentence(remedy) } : {}), actions: [] };
}

/** What a note says of a seam that was smooth and is not any more; null if it says something else. */
export function creaseIn(note: string): { seam: string; text: string; remedy: string } | null {
  const found = /^the seam (\S+ \w+) – (\S+ \w+) was smooth and has a crease of (\S+) degrees now at (\(.*?\)): it keeps its position only, as (.*); undo/.exec(note);
  if (!found) return null;
  const [, a, b, angle, place, why] = found;
  return {
    seam: `${a} ${b}`, text: `The seam between ${a} and ${b} was smooth, and now has a crease of ${angle} degrees at ${place}.`,
    remedy: `These surfaces are joined in position only: ${why}. Kept smooth, they have less freedom there`,
  };
}

/** What a note says of surfaces that nothing holds, and what holds them; null if it says something else. */
export function looseIn(note: string): (Advice & { surfaces: string }) | null {
  const found = /^nothing holds (.*?): what presses on it moves all of it/.exec(note);
  if (!found) return null;
  const surfaces = found[1]!;
  return { surfaces, text: `Nothing holds ${surfaces}: what presses on it moves all of it.`, actions: [{ label: 'Hold the edges', commands: [{ do: 'hold', mode: 'trim' }] }, { label: 'Hold the outer rows', commands: [{ do: 'hold', rows: 2 }] }] };
}

/** What a note says of a face that was stopped before, or came through, another one; null if it says something else. */
export function throughIn(note: string): { text: string; stopped: boolean } | null {
  const found = /^(stopped at|through) another face: (\S+) (?:would come through|comes to) (.*), (\S+) deep(?:, and goes on)?;/.exec(note);
  if (!found) return null;
  const [, how, surface, place, depth] = found;
  const stopped = how === 'stopped at';
  return { stopped, text: stopped ? `${surface} was stopped ${depth} deep: farther on it would come through ${place}.` : `${surface} comes through ${place}, ${depth} deep.` };
}

/** The same as one line, beside a field. */
export function inOneLine(error: EngineErrorInfo): string {
  const { text, remedy } = adviceOn(error);
  return remedy ? `${text.replace(/\.$/, '')}: ${remedy[0]!.toLowerCase()}${remedy.slice(1)}` : text;
}
