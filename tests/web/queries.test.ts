import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { Engine, type Query } from '@knead/engine';
import { type Command, KneadError } from '@studio/engine/session_types';

// The one call from the page to the engine.

const folder = fileURLToPath(new URL('../../web/src/engine', import.meta.url));
const wasm = readFileSync(join(folder, 'knead_studio.wasm'));
const table = /export interface Queries \{\n([^}]*(?:\}[^}]*)*?)\n\}\n/.exec(readFileSync(join(folder, '../../../bindings/npm/src/generated.ts'), 'utf8'))![1]!;
const queries = table.split('\n').map((line) => /^  (\w+): \{ request: (\w+); answer: (.+) \};$/.exec(line)!.slice(1) as [Query, string, string]);

const sheet: Command[] = [
  { do: 'new', size: [10, 10], net: [6, 6] }, { do: 'tool', name: 'ball', radius: 1, position: [5, 5, 3] },
  { do: 'new', shape: 'curve', size: 5, net: 6 }, { do: 'select', surface: '#1' },
];
const everything = {
  surface: 0, body: 0, tool: 0, name: 'sheet.stl', history_bytes: 1, commands: [], at: [0.5, 0.5], near: [0, 0, 0], face: '#9', curves: [2, 2], teeth: 2,
  plane: [1, 0, 0, 4.5], margin: 0.1, net: [4, 4, 4], counts: [3, 4], file: new Uint8Array(), snapshot: new Uint8Array(),
  script: new TextEncoder().encode('{"knead": 2, "commands": []}'),
};

it('is one export, beside the memory for what is asked and answered', async () => {
  const functions = WebAssembly.Module.exports(await WebAssembly.compile(wasm)).filter(({ kind }) => kind === 'function').map(({ name }) => name);
  expect(functions.sort()).toEqual(['_initialize', 'knead_call', 'knead_input', 'knead_text', 'knead_text_size']);
});

it('answers what its types say, and refuses what they do not name', async () => {
  const source = readFileSync(join(folder, '../../../bindings/npm/src/generated.ts'), 'utf8');
  expect(queries.length).toBeGreaterThan(30);
  for (const [query, type, answer] of queries) {
    const engine = await Engine.load(wasm);
    engine.query('fresh', { name: 'sheet' });
    engine.query('act', { commands: sheet });
    const fields = new RegExp(`export type ${type} = \\{\n([^]*?)\\};`).exec(source)![1]!;
    const request = Object.fromEntries(Object.entries(everything).filter(([name]) => new RegExp(`^  ${name}: `, 'm').test(fields)));
    if (['morphed', 'deviation'].includes(query)) Object.assign(request, { space: '0; 0; 1' }); // one of its data, none of which is required
    const ask = () => (engine.query as (name: Query, request: object) => unknown).call(engine, query, request);
    if (['open', 'restore', 'face_reading'].includes(query)) expect(ask, query).toThrow(KneadError); // of files
    else if (answer.endsWith('[]')) expect(ask(), query).toBeInstanceOf(Array);
    else if (/Array$/.test(answer)) expect((ask() as object).constructor.name, query).toBe(answer);
    else if (/^(string|number)$/.test(answer)) expect(typeof ask(), query).toBe(answer);
    else if (!answer.includes('null')) expect(ask(), query).toBeTypeOf('object');
    else expect(ask, query).not.toThrow();
    expect(() => (engine.query as (name: Query, request: object) => unknown).call(engine, query, { ...request, colour: 1 }), query).toThrow(/colour/);
  }
});

it('hands arrays out as copies, and bytes over beside the JSON', async () => {
  const engine = await Engine.load(wasm);
  engine.query('fresh', { name: 'sheet' });
  engine.query('act', { commands: sheet });
  const { lines_u, positions } = engine.query('picture', { surface: 0, detail: 8 });
  expect([lines_u.constructor.name, positions.constructor.name]).toEqual(['Uint32Array', 'Float32Array']);
  const before = positions.slice();
  engine.execute({ do: 'points', which: [14], by: [0, 0, 1] });
  engine.query('picture', { surface: 0, detail: 8 });
  expect(positions).toEqual(before);
  const snapshot = engine.query('snapshot', { history_bytes: 1 });
  const state = engine.query('state');
  engine.query('fresh', { name: 'another' });
  engine.query('restore', { snapshot, name: 'sheet', source: new Uint8Array() });
  expect(engine.query('state').surfaces).toEqual(state.surfaces);
  expect(engine.query('script_opening')).toMatchObject([{ do: 'hold', mode: 'position', all: true }]);
});

it('checks edges with points along them where they are asked for', async () => {
  const engine = await Engine.load(wasm);
  engine.query('fresh', { name: 'sheet' });
  engine.query('act', { commands: sheet });
  expect(engine.query('check').edges.map(({ course }) => course)).toEqual(Array(4).fill(undefined));
  for (const { course, start, end } of engine.query('check', { courses: true }).edges) expect([course![0], course!.at(-1)]).toEqual([start, end]);
});
