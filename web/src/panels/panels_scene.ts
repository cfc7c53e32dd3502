import { format, parseLength } from '../document/units';
import { type BodyInfo, type EditToolCommand, shapes, type ToolCommand } from '@knead/generated';
import { unitOf } from '../engine/session_state';
import type { Command, ToolInfo, Vector3 } from '../engine/session_types';
import { constraintInWords } from '../tools/held';
import { tooFar, wayOf } from '../tools/tool_way';
import type { App } from './app';
import { field, h, iconButton, select, title, toggle } from './dom';
import { numberInput } from './number_input';
import { note, panel, row } from './panel';

/** Pieces of the way to a place that is typed. */
const longestWay = 256;

const length = (app: App) => (text: string) => parseLength(text, unitOf(app.state));

export function surfacesPanel(app: App): HTMLElement {
  const places = (id: string) => app.viewer.placing.of(id).length;
  return panel(app, 'Surfaces', (a) => [a.viewer.placing.assembly?.parts.length, a.state?.surfaces.map((s) => [s.id, s.name, s.net, s.degree, s.moved > 0]), a.state?.selection,
    a.state?.bodies.map((b) => [b.id, b.name, b.net, b.moved > 0]), a.state?.body], () => {
    const { state } = app;
    if (!state || state.surfaces.length + state.bodies.length === 0) return [note('Nothing to sculpt yet.')];
    return [
      h('ul', { class: 'list' }, ...state.surfaces.map((s, k) => {
        const on = state.selection.includes(k);
        const pick = (e: MouseEvent) => {
          const together = e.ctrlKey || e.metaKey || e.shiftKey;
          const all = together ? [...state.selection.filter((i) => i !== k), ...(on ? [] : [k])] : [k];
          if (all.length === 1) void app.select(all[0]!);
          else if (all.length > 1) void app.selectTogether(all);
        };
        return h('li', {}, h('button', { class: on ? 'item on' : 'item', type: 'button', onclick: pick, title: 'Ctrl-click selects several, which then move together',
          aria: { pressed: String(on) } },
          h('span', {}, s.name || s.id),
          h('small', {}, `degree ${s.degree.join('×')}, ${s.net.join('×')} points${s.rational ? '  NURBS' : ''}${places(s.id) > 1 ? `  in ${places(s.id)} places` : ''}${s.moved > 0 ? '  •' : ''}`)));
      }), ...state.bodies.map((b, k) => bodyItem(app, b, state.body === k))),
      row(
        h('button', { class: 'button small', type: 'button', title: 'Halve every span: the same shape on a finer net',
          onclick: () => void app.execute([state.body !== null ? { do: 'refine' } : { do: 'refine', region: [[0, 1], [0, 1]] }]) }, 'Refine'),
        ...(state.body !== null ? [] : [h('button', { class: 'button small', type: 'button', title: 'By one, with the same shape',
          onclick: () => void app.execute([{ do: 'elevate' }]) }, 'Raise degree'),
        h('button', { class: 'button small', type: 'button', title: 'Select everything that seams connect with this surface',
          onclick: () => void app.execute([{ do: 'select', surface: state.surfaces[state.selection[0] ?? 0]!.id, connected: true }]) }, 'Select connected')]),
      ),
    ];
  });
}

/** A curve or a volume in the list of what can be sculpted. */
function bodyItem(app: App, b: BodyInfo, on: boolean): HTMLElement {
  return h('li', {}, h('button', { class: on ? 'item on' : 'item', type: 'button', onclick: () => void app.execute([{ do: 'select', body: b.id }]),
    title: `A ${b.rational ? 'rational ' : ''}${b.kind} of degree ${b.degree.join(' × ')}, which is sculpted alone`, aria: { pressed: String(on) } },
    h('span', {}, b.name || b.id),
    h('small', {}, `${b.kind}  ${b.net.join(' × ')}${b.moved > 0 ? '  •' : ''}`)));
}

/** The shapes with their titles. */
export const shapeTitles = Object.keys(shapes).map((name) => [name, name === 'surface' ? 'Surface of the document' : title(name)] as const);

/** Measures with a different name in the panel. */
const words: Record<string, string> = { minor: 'Tube', thickness: 'Wall', sizes: 'Semi-axes' };

/** A length that is the same in every direction as one number. */
const single = (value: number | [number, number] | undefined): number => (Array.isArray(value) ? value[0] : value ?? 0);

/** The command that changes these fields of a tool. A shape without a radius of its own is as large as the previous one. */
function edited(tool: ToolInfo, change: Partial<EditToolCommand>): EditToolCommand {
  const command: EditToolCommand = { do: 'edit_tool', tool: tool.name, ...change };
  const shape = change.shape ?? tool.shape;
  const has = (name: string) => shapes[shape]!.fields.some((f) => f.name === name);
  if (shape !== tool.shape && tool.radius === undefined && (has('radius') || (has('sizes') && tool.sizes === undefined))) {
    command.radius = tool.sizes?.[0] ?? tool.size ?? 1;
  }
  if (change.mode !== undefined && change.mode !== tool.mode) command.stiffness = change.mode === 'proximity' ? 100 : 1e4;
  return command;
}

export function toolsPanel(app: App): HTMLElement {
  return panel(app, 'Tools', (a) => [a.state?.tools, a.viewer.tools.selected, a.viewer.viewports[0]!.gizmo.mode], () => {
    const tools = app.state?.tools.filter((t) => !(app.hand.active && t.name === 'brush')) ?? [];
    const chosen = tools.find((t) => t.name === app.viewer.tools.selected);
    const pick = (name: string | null) => {
      app.viewer.selectTool(name);
      app.changed();
    };
    return [
      tools.length === 0 ? note('No tool in the scene. Choose “Place a tool” and click the surface.') : null,
      h('ul', { class: 'list' }, ...tools.map((t) =>
        h('li', { class: 'with-action' },
          h('button', { class: t === chosen ? 'item on' : 'item', type: 'button', onclick: () => pick(t === chosen ? null : t.name), aria: { pressed: String(t === chosen) } },
            h('span', {}, t.name), h('small', {}, `${t.shape}  ${t.mode}`)),
          iconButton('trash', `Take ${t.name} away`, () => void app.execute([{ do: 'remove', tool: t.name }]))))),
      ...(chosen ? toolFields(app, chosen) : []),
    ];
  });
}

function toolFields(app: App, tool: ToolInfo): (Node | null)[] {
  const change = (what: Partial<EditToolCommand>) => void app.execute([edited(tool, what)]);
  const offer = (what: Partial<EditToolCommand>) => app.offer([edited(tool, what)]);
  const setGizmo = (mode: 'translate' | 'rotate' | 'scale') => {
    for (const v of app.viewer.viewports) v.gizmo.setMode(mode);
    app.changed();
  };
  const mode = app.viewer.viewports[0]!.gizmo.mode;
  const number = (label: string, value: number, name: keyof EditToolCommand, isLength = false, tip?: string) =>
    field(label, numberInput(label, value, (v) => offer({ [name]: v }), isLength ? length(app) : undefined), tip);
  return [
    row(...(['translate', 'rotate', 'scale'] as const).map((m) =>
      toggle({ translate: 'Move', rotate: 'Turn', scale: 'Resize' }[m], mode === m, () => setGizmo(m)))),
    field('Shape', select('Shape', shapeTitles, tool.shape, (shape) => change({ shape: shape as ToolCommand['shape'] }))),
    ...measures(app, tool, offer),
    field('Mode', select('Mode', [['collision', 'Collision'], ['proximity', 'Proximity'], ['imprint', 'Imprint']], tool.mode, (m) => change({ mode: m })),
      'Collision pushes out what has entered; proximity draws from either side; imprint leaves its shape at once'),
    tool.mode === 'proximity'
      ? field('Direction', select('Direction', [['pull', 'Pull'], ['push', 'Push']], tool.direction, (d) => change({ direction: d }))) : null,
    number('Stiffness', tool.stiffness, 'stiffness', false, 'Spring constant k: force per length and area'),
    tool.mode === 'proximity' ? number('Range', tool.range, 'range', true, 'How far it reaches') : null,
    number('Friction', tool.friction, 'friction', false, 'Coulomb’s coefficient'),
    number('Plasticity', tool.plasticity, 'plasticity', false, 'Share of the shape that stays when the tool is taken away, 0 to 1'),
    row(toggle('Rigid', tool.rigid, (rigid) => change({ rigid }), 'Raise the stiffness until nothing enters')),
  ];
}

/** Leads a tool to a place that was typed: one entry of the history. In one jump it would pass through the surface. */
async function led(app: App, tool: ToolInfo, position: Vector3): Promise<string | null> {
  const by = position.map((x, k) => x - tool.position[k]!) as Vector3;
  const there: Command = { do: 'edit_tool', tool: tool.name, position };
  if (app.state!.selection.length === 0 || by.every((x) => x === 0)) return app.offer([there]);
  const answer = await app.offer([...wayOf(tool, by, longestWay), there, { do: 'step' }]);
  if (answer === null && tooFar(tool, by, longestWay)) {
    app.notify({ kind: 'info', text: `${tool.name} went so far that its steps were longer than an eighth of its size: it may have passed through the surface.`,
      remedy: 'Undo, and let it go there by way of a nearer place.' });
  }
  return answer;
}

/** The numbers of its shape, and where the tool is. */
function measures(app: App, tool: ToolInfo, change: (what: Partial<EditToolCommand>) => Promise<string | null>): Node[] {
  const input = (label: string, value: number, isLength: boolean, set: (v: number) => Promise<string | null>) => numberInput(label, value, set, isLength ? length(app) : undefined);
  const several = (label: string, name: string, values: readonly number[], isLength: boolean, tip?: string) =>
    field(label, row(...values.map((value, k) => input(`${label} ${k + 1}`, value, isLength,
      (v) => change({ [name]: values.map((x, l) => (l === k ? v : x)) })))), tip);
  return [
    ...shapes[tool.shape]!.fields.map((f) => {
      const value = (tool as Record<string, unknown>)[f.name] as number | number[];
      const label = tool.shape === 'box' && f.name === 'sizes' ? 'Half sides' : words[f.name] ?? title(f.name);
      return f.initial.length > 1 && f.name !== 'minor' ? several(label, f.name, value as number[], f.length, f.help)
        : field(label, input(label, single(value as number | [number, number]), f.length, (v) => change({ [f.name]: v })), f.help);
    }),
    field('Position', row(...tool.position.map((value, k) => input(`Position ${k + 1}`, value, true, (v) => led(app, tool, tool.position.map((x, l) => (l === k ? v : x)) as Vector3)))),
      'Of its centre. The tool goes there in steps, and takes the surface along'),
  ];
}

export function constraintsPanel(app: App): HTMLElement {
  const relevant = (a: App) => a.state?.selection.map((k) => {
    const s = a.state!.surfaces[k]!;
    return [s.hold, s.pins, s.constraints];
  });
  return panel(app, 'Constraints', (a) => [relevant(a), a.state?.coupled, a.state?.seams, a.state?.limit], () => {
    const { state } = app;
    const chosen = state?.surfaces[state.selection[0] ?? -1];
    if (!state || !chosen) return [note('Select a surface.')];
    const run = (...commands: Command[]) => void app.execute(commands);
    const edges = [['all', 'All edges'], ['u0', 'u = 0'], ['u1', 'u = 1'], ['v0', 'v = 0'], ['v1', 'v = 1']] as const;
    const edgeSelect = select('Edge', edges, 'all', () => {});
    const holdSelect = select('Continuity', [['position', 'Position'], ['tangent', 'Tangent'], ['curvature', 'Curvature'], ['open', 'Free']], 'position', () => {});
    return [
      field('Held rows', numberInput('Held rows', chosen.hold, (v) => app.offer([{ do: 'hold', rows: Math.round(v) }])), 'Outer rows of control points that stay'),
      row(edgeSelect, holdSelect, h('button', { class: 'button small', type: 'button',
        onclick: () => run({ do: 'edge', which: edgeSelect.value, hold: holdSelect.value }) }, 'Hold')),
      row(
        h('button', { class: 'button small', type: 'button', title: 'Stays its own mirror image across the middle of u', onclick: () => run({ do: 'symmetry', mirror: 'u' }) }, 'Mirror u'),
        h('button', { class: 'button small', type: 'button', title: 'Stays its own mirror image across the middle of v', onclick: () => run({ do: 'symmetry', mirror: 'v' }) }, 'Mirror v'),
        toggle('Seams', state.coupled, (couple) => run({ do: 'seams', couple, smooth: state.smooth }), 'Patches selected together stay together at their seams'),
        h('button', { class: 'button small', type: 'button', title: 'Frees all that is held, pinned, frozen or kept', onclick: () => run({ do: 'release' }) }, 'Release all'),
      ),
      field('Limit', numberInput('Limit', state.limit, (v) => app.offer([v > 0 ? { do: 'limit', distance: v } : { do: 'limit' }]), length(app), 'none'),
        'No point moves further from the surface as opened; 0 for no limit'),
      chosen.pins > 0 || chosen.constraints.length > 0
        ? note([chosen.pins > 0 ? `${chosen.pins} control points pinned` : '', ...chosen.constraints.map(constraintInWords)].filter(Boolean).join('\n')) : null,
      state.seams.length > 0 ? note(state.seams.map((s) => `seam ${s.continuity}, gap ${format(s.gap)}${s.reason ? `: ${s.reason}` : ''}`).join('\n')) : null,
    ];
  }, false);
}
