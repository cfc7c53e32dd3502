import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { fromBase64, toBase64 } from '@studio/document/base64';
import { readKnead, type Source, writeKnead } from '@studio/document/knead_file';
import type { SavedView } from '@studio/document/saved_views';
import { format, parseLength, unitInWords } from '@studio/document/units';
import { roundStep } from '@studio/view/ground';

const root = fileURLToPath(new URL('../..', import.meta.url));

describe('typed lengths', () => {
  it.each([
    ['3', 'mm', 3], ['3mm', 'mm', 3], [' 0.1 in ', 'mm', 2.54], ['2,5 cm', 'mm', 25], ['1e-3m', 'mm', 1], ['1"', 'inch', 1],
    ['-4', 'mm', -4], ['.5', 'm', 0.5], ['10 mm', 'm', 0.01], ['2 cm', 'mm', 20], ['1/2', 'mm', 0.5], ['1/2in', 'mm', 12.7],
    ['1 1/2 in', 'inch', 1.5], ['-3/4"', 'mm', -19.05], ['2 1/4 ft', 'foot', 2.25], ["1'", 'inch', 12], ['1E2MM', 'cm', 10], ['5 thou', 'inch', 0.005],
    ['3 units', 'unknown', 3], ['2 µin', 'microinch', 2], ['1 yd', 'foot', 3],
  ])('%s in a file of %s is %d', (text, unit, length) => expect(parseLength(text, unit)).toBeCloseTo(length, 12));
  it.each([['', 'mm'], ['three', 'mm'], ['3 parsec', 'mm'], ['3mm', 'unknown'], ['3 units', 'mm'], ['1/0', 'mm'], ['1e999', 'mm'], ['1 2', 'mm'], ['mm', 'mm'],
    ['1/2/3', 'mm'], ['--1', 'mm'], ['1.5/2', 'mm'], ['3 mm mm', 'mm']])(
    '%s in a file of %s is none', (text, unit) => expect(parseLength(text, unit)).toBeNull());
});

describe('units', () => {
  it.each([['inch', 'in'], ['foot', 'ft'], ['yard', 'yd'], ['um', 'µm'], ['mm', 'mm'], ['unknown', 'units'], ['', '']])('%j are written %j', (unit, text) =>
    expect(unitInWords(unit)).toBe(text));
  it.each(['in', 'ft', 'yd', 'µm', 'µin', 'mil'])('%s can be typed as it is written', (unit) => expect(parseLength(`2 ${unit}`, 'm')).toBeGreaterThan(0));
});

describe('numbers for people', () => {
  it.each([[0, '0'], [1, '1'], [123.456, '123.5'], [0.000123, '1.23e-4'], [1e7, '1e7'], [NaN, '–']])('%d is %s', (x, text) =>
    expect(format(x)).toBe(text));
  it.each([[1, 1], [4.9, 2], [7, 5], [0.03, 0.02], [1234, 1000]])('the round step below %d is %d', (x, step) =>
    expect(roundStep(x)).toBeCloseTo(step, 12));
});

describe('Knead documents', () => {
  const journal = '[\n  {"do":"hold","rows":2},\n  {"do":"step","count":3}\n]\n';

  const bytes = Uint8Array.from({ length: 20_000 }, (_, k) => (k * 37) % 256);
  const commands = [{ do: 'hold', rows: 2 }, { do: 'step', count: 3 }];

  it.each<Source | null>([null, { kind: 'step', name: 'a "b".step', bytes }, { kind: 'rhino', name: 'c.3dm', bytes }])(
    'come back as they were written', (source) => {
      for (const snapshot of [null, bytes.slice(7)]) {
        const read = readKnead(writeKnead({ name: 'a "name"', source, journal, snapshot }));
        expect(read).toEqual({ name: 'a "name"', source, commands, script: false, snapshot, views: [] });
      }
    });

  it('keep views', () => {
    const views: SavedView[] = [
      { name: 'the "nose"', position: [1, 2.5, 3e-7], target: [0, 0, 1 / 3], up: [0, 0, 1], height: 12, parallel: true },
      { name: 'b', position: [1, 2, 3], target: [0, 0, 0], up: [0, 0, 1], height: 0.1, parallel: false },
    ];
    expect(readKnead(writeKnead({ name: 'n', source: null, journal, views })).views).toEqual(views);
    for (const [field, wrong] of [['name', ''], ['position', [1, 2]], ['target', [1, 2, '3']], ['height', 0], ['parallel', 1], ['position', [0, 0, 0]]] as const) {
      const text = writeKnead({ name: 'n', source: null, journal, views: [views[0]!, { ...views[1]!, [field]: wrong }] });
      expect(() => readKnead(text)).toThrow(`views[1].${field}: write`);
    }
  });

  it('are told from scripts of the command line', () => {
    expect(readKnead(`{"knead": 2, "commands": ${journal}}`)).toMatchObject({ commands, script: true });
    expect(readKnead('{"knead": 3, "commands": []}')).toMatchObject({ commands: [], script: false });
  });

  it.each([['{"knead": 1, "commands": []}', 'script'], ['{"knead": 1, "name": "a", "source": "abc", "commands": []}', 'Knead document'],
    ['{"knead": 2, "name": "a", "commands": []}', 'Knead document'], ['{"knead": 2, "source": {}, "commands": []}', 'Knead document']])(
    '%s, of an older version, is refused with what to do', (text, what) => {
      expect(() => readKnead(text)).toThrow(new RegExp(`the ${what} is of version [12], .*docs/scripts.md says how`));
    });

  it('may have no command yet', () => {
    expect(readKnead(writeKnead({ name: 'n', source: null, journal: '[]' })).commands).toEqual([]);
  });

  const two = (fields: object) => JSON.stringify({ knead: 3, commands: [], ...fields });
  it.each([
    ['', /not JSON/], ['[]', /version, is missing/], ['null', /version, is missing/], ['{"knead": 4}', /version 4, .*reload the page/],
    ['{"knead": 2}', /list of commands is missing/], ['{"knead": 2, "commands": [{"do": "step"}, {}]}', /commands\[1\]\.do/],
    ['{"knead": 2, "commands": [7]}', /commands\[0\]/], [two({ source: 'abc' }), /"source": write/],
    [two({ source: { kind: 'iges', name: 'a', bytes: '' } }), /source\.kind: "iges"/], [two({ source: { kind: 'step', bytes: '' } }), /source\.name/],
    [two({ source: { kind: 'step', name: 'a', bytes: '*' } }), /source\.bytes/], [two({ snapshot: 1 }), /"snapshot"/], [two({ name: 1 }), /"name"/],
    [two({ views: {} }), /"views"/], [two({ undo: [] }), /"undo": a Knead document has no such field/],
  ])('%s is refused', (text, message) => expect(() => readKnead(text)).toThrow(message));

  it('have the fields of their schema', () => {
    const schema = JSON.parse(readFileSync(join(root, 'docs/knead-document.schema.json'), 'utf8')) as {
      properties: Record<string, { properties?: object; enum?: unknown[] }>; required: string[];
    };
    const written = JSON.parse(writeKnead({ name: 'n', source: { kind: 'step', name: 'a', bytes }, journal, snapshot: bytes,
      views: [{ name: 'a', position: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], height: 1, parallel: true }] })) as Record<string, object>;
    expect(Object.keys(schema.properties).sort()).toEqual(Object.keys(written).sort());
    expect(Object.keys(schema.properties.source!.properties!).sort()).toEqual(Object.keys(written.source!).sort());
    for (const field of schema.required) {
      const { [field]: _, ...rest } = written;
      expect(() => readKnead(JSON.stringify(rest))).toThrow();
    }
  });

  it('carry any bytes in base64', () => {
    for (const length of [0, 1, 2, 3, 0x8001]) {
      const bytes = Uint8Array.from({ length }, (_, k) => (k * 251) % 256);
      expect(fromBase64(toBase64(bytes))).toEqual(bytes);
    }
  });
});
