import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { adviceOn, inOneLine, looseIn, throughIn } from '@studio/document/words';
import { Engine } from '@knead/engine';
import { type Command, KneadError, type EngineErrorInfo, errorOf, type NoteInfo } from '@studio/engine/session_types';

const wasm = readFileSync(fileURLToPath(new URL('../../web/src/engine/knead_studio.wasm', import.meta.url)));

type Values = NonNullable<EngineErrorInfo['values']>;
const noValues: Values = {
  surface: null, surfaces: [], others: [], body: null, edge: null, edges: [], face: null, faces: [], form: null, tool: null, hold: null, permission: null, rows: null,
  point: null, distance: null, limit: null, angle: null, size: null, sizes: null, depth: null, x: null, y: null, z: null, first: null, second: null, other: null, reason: null,
};
const told = (code: EngineErrorInfo['code'], values: Partial<Values> | null, fixes: EngineErrorInfo['fixes'] = []): EngineErrorInfo =>
  ({ ...errorOf('numerical', 'what', 'remedy'), code, values: values && { ...noValues, ...values }, fixes });

async function refused(...commands: Command[]): Promise<{ engine: Engine; info: EngineErrorInfo }> {
  const engine = await Engine.load(wasm);
  engine.query('fresh', { name: 'sheet' });
  engine.execute({ do: 'new', size: [100, 100], net: [12, 12] });
  for (const command of commands.slice(0, -1)) engine.execute(command);
  try {
    engine.execute(commands.at(-1)!);
  } catch (error) {
    if (error instanceof KneadError) return { engine, info: error.info };
    throw error;
  }
  throw new Error('this is not refused');
}

const ball: Command = { do: 'tool', name: 'brush', shape: 'sphere', radius: 12, position: [50, 50, 6], plasticity: 1 };
const press: Command = { do: 'stroke', tool: 'brush', path: [[50, 50, 6], [60, 50, 6]], open: true };

describe('what the engine refuses', () => {
  const cases: [string, Command[], RegExp, string | null][] = [
    ['a balance of nothing held', [{ do: 'evolve', mode: 'static' }], /^Nothing holds the surface/, 'Hold the outer rows'],
    ['a stroke in raw scaling', [{ do: 'material', preset: 'clay' }, { do: 'scaling', mode: 'raw' }, ball, press], /usual scaling/, 'Use the usual scaling'],
    ['a stroke where all is held', [{ do: 'material', preset: 'clay' }, { do: 'hold', rows: 6 }, ball, press], /6 outer rows/, 'Refine'],
    ['points beyond the limit', [{ do: 'limit', distance: 1 }, { do: 'points', which: [60], by: [0, 0, 9] }], /limit is 1/, 'End the limit'],
    ['frozen points', [{ do: 'freeze', region: [[0, 1], [0, 1]] }, { do: 'points', which: [60], by: [0, 0, 9] }], /frozen/, 'Thaw all'],
    ['a ball of a micrometre', [{ do: 'hold', rows: 2 }, { ...ball, radius: 1e-3, position: [50, 50, 0] }, { do: 'step' }], /is too small for this surface/, null],
    ['a step parameter', [{ do: 'evolve', mode: 'acm', lambda: -1 }], /^Lambda: -1 is out of range$/, null],
  ];
  it.each(cases)('%s is told in words, with what helps', async (_, commands, text, label) => {
    const { engine, info } = await refused(...commands);
    const advice = adviceOn(info);
    expect(advice.text).toMatch(text);
    expect(`${advice.text} ${advice.remedy ?? ''}`).not.toMatch(/[{}`]|lambda|allow/);
    if (label === null) expect(advice.actions).toEqual([]);
    else for (const command of advice.actions.find((a) => a.label === label)!.commands) engine.execute(command); // is a command that can be done
  });

  it('names options of the program as fields of a panel', () => {
    const said = adviceOn(errorOf('input', 'none of 3 points is within 1 of a face', 'are they in the unit of the model? --unit, --align, --reach'));
    expect(said.remedy).toBe('Are they in the unit of the model? “Unit”, “Align”, “Reach”');
    const refused = adviceOn(errorOf('numerical', 'it would be parted', 'allow more control points with --refine, a larger --tolerance, or --keep its faces'));
    expect(refused.remedy).toBe('Allow more control points with “Refine ×”, a larger “Tolerance”, or fix its faces');
  });

  it('a fold names the held edge beside it, which may follow instead', () => {
    const error = told('step_folds_beside_edge', { surface: '#10', edge: '#43', hold: 'follow' }, [{ code: 'let_follow', commands: [{ do: 'edge', edge: '#43', hold: 'follow' }] }]);
    const { text, remedy, actions } = adviceOn(error, true);
    expect(text).toBe('The surface would fold over itself beside the held edge #43, so nothing was done.');
    expect(adviceOn(error).text).toBe('The surface would fold over itself beside the held edge #43.');
    expect(remedy).toMatch(/let the edge follow/);
    expect(actions).toEqual([{ label: 'Let the edge follow', commands: [{ do: 'edge', edge: '#43', hold: 'follow' }] }]);
    const far = adviceOn(told('step_folds', { surface: '#10' }));
    expect(far.text).not.toContain('#43');
    expect(far.actions).toEqual([]);
  });

  it('an edge beside a face of another form offers to convert it, after which the edge follows', async () => {
    const engine = await Engine.load(wasm);
    engine.query('open', { file: new Uint8Array(readFileSync(fileURLToPath(new URL('../../samples/bonnet.step', import.meta.url)))), name: 'bonnet.step' });
    engine.execute({ do: 'select', surface: '#285' });
    engine.execute({ do: 'hold', mode: 'position' });
    const error = (() => {
      try {
        engine.execute({ do: 'edge', edge: '#43', hold: 'follow' });
      } catch (e) {
        if (e instanceof KneadError) return e.info;
      }
      throw new Error('this is not refused');
    })();
    const { text, remedy, actions } = adviceOn(error);
    expect(text).toBe('That edge cannot follow: its face #454 lies on a surface of linear extrusion.');
    expect(`${text} ${remedy}`).not.toMatch(/[{}`]/);
    expect(actions.map((a) => a.label)).toEqual(['Convert and follow']);
    for (const command of actions[0]!.commands) engine.execute(command);
    const { surfaces, selection } = engine.query('state');
    expect(selection.map((k) => surfaces[k]!.id)).toEqual(['#285', '#534']);
    expect(surfaces.at(-1)).toMatchObject({ id: '#534', faces: 1, preset: 'clay' });
    expect(surfaces[0]!.constraints).toContainEqual(expect.objectContaining({ do: 'edge', edge: '#43', hold: 'follow' }));
    expect(engine.query('context')!.skipped).toEqual([]);
    expect(engine.query('trims', { surface: surfaces.length - 1 })).toBeNull(); // its face shows all of it
    expect(engine.query('trims', { surface: 0 })).not.toBeNull();

    engine.execute({ do: 'select', surface: '#285' });
    const alone = (() => {
      try {
        engine.execute({ do: 'edge', edge: '#43', hold: 'follow' });
      } catch (e) {
        if (e instanceof KneadError) return adviceOn(e.info);
      }
      throw new Error('this is not refused');
    })();
    expect(alone.actions.map((a) => a.label)).toEqual(['Select both and follow']);
    for (const command of alone.actions[0]!.commands) engine.execute(command);
  });

  it('what nobody has written words for stands as the engine says it', () => {
    const info: EngineErrorInfo = { ...told('none', null), what: 'the net is odd', where: 'which', remedy: 'use `knots` with lambda >= 0' };
    expect(adviceOn(info)).toEqual({ text: 'The net is odd', remedy: 'Use “knots” with λ ≥ 0', actions: [] });
    expect(inOneLine(info)).toBe('The net is odd: use “knots” with λ ≥ 0');
    expect(adviceOn({ ...info, where: '#12 line 7', place: '#12 line 7', remedy: '' })).toEqual({ text: '#12 line 7: the net is odd', actions: [] });
  });
});

describe('an edge that would open', () => {
  const follow = (edge: string): Command => ({ do: 'edge', edge, hold: 'follow' });

  it('may follow what moves, all of them at once', () => {
    const commands = [follow('#7'), follow('#8')];
    const { text, actions } = adviceOn(told('edge_would_open', { edge: '#7', distance: 0.25, edges: ['#7', '#8'] }, [{ code: 'let_follow', commands }]), true);
    expect(text).toBe('The edge #7, which is held, would open by 0.25, so nothing was done.');
    expect(actions).toEqual([{ label: 'Let the edges follow', commands }]);
    expect(adviceOn(told('edge_would_turn', { edge: '#7', angle: 12 })).text).toContain('would turn by 12 degrees');
  });

  it('is saved once it is let go', () => {
    const commands: Command[] = [{ do: 'select', surface: '#10' }, { do: 'hold', mode: 'open' }];
    const { text, actions } = adviceOn(told('edge_left_open', { edge: '#7', distance: 0.25, faces: ['#1', '#2'] }, [{ code: 'let_open', commands }]));
    expect(text).toBe('Nothing was saved: the edge #7 would be left 0.25 from the faces #1 and #2.');
    expect(actions).toEqual([{ label: 'Let it open', commands }]);
  });
});

describe('a remedy for a terminal', () => {
  const uncoded = (remedy: string) => adviceOn({ ...told('none', {}), what: 'it is wrong', place: '#7', remedy });

  it('is not said on a page', () => {
    expect(uncoded('write {"do":"hold"}').remedy).toBeUndefined();
    expect(uncoded('`knead info --faces` lists those that can be converted').remedy).toBeUndefined();
    expect(uncoded(Array.from({ length: 50 }, (_, k) => `command${k}`).join(', ')).remedy).toBeUndefined();
    expect(uncoded('take a larger one')).toMatchObject({ text: '#7: it is wrong', remedy: 'Take a larger one' });
  });
});

describe('what notes tell', () => {
  it('that nothing holds a surface comes with what holds it', async () => {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'sheet' });
    for (const command of [{ do: 'new', size: [100, 100], net: [12, 12] }, ball, { do: 'step' }] satisfies Command[]) engine.execute(command);
    const loose = engine.query('state').notes.flatMap((note) => looseIn(note) ?? []);
    expect(loose).toHaveLength(1);
    expect(loose[0]!.text).toMatch(/^Nothing holds \S+: what presses on it moves all of it\.$/);
    for (const { commands } of loose[0]!.actions) for (const command of commands) engine.execute(command);
    expect(looseIn({ text: 'made smaller', code: 'none', values: null, fixes: [] })).toBeNull();
  });

  it('that a face is stopped before another, or comes through it', () => {
    const values = { ...told('none', {}).values!, surface: '#10', other: 'the face #45 on #20', x: 5, y: 5, z: 0, depth: 1 };
    const note = (code: NoteInfo['code']): NoteInfo => ({ text: '', code, values, fixes: [] });
    expect(throughIn(note('stopped_at_face')))
      .toEqual({ stopped: true, text: '#10 was stopped 1 deep: farther on it would come through the face #45 on #20 at (5, 5, 0).' });
    expect(throughIn(note('through_face'))?.text).toBe('#10 comes through the face #45 on #20 at (5, 5, 0), 1 deep.');
    expect(throughIn(note('none'))).toBeNull();
  });
});
