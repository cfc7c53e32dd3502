import { format } from '@studio/ui/dom';
import { parseLength } from '@studio/ui/units';
import { readKnead, toBase64, fromBase64, writeKnead } from '@studio/document/knead_file';
import { roundStep } from '@studio/view/ground';

describe('typed lengths', () => {
  it.each([
    ['3', 'mm', 3], ['3mm', 'mm', 3], [' 0.1 in ', 'mm', 2.54], ['2,5 cm', 'mm', 25], ['1e-3m', 'mm', 1], ['1"', 'inch', 1],
    ['-4', 'mm', -4], ['.5', 'm', 0.5], ['10 mm', 'm', 0.01],
  ])('%s in a file of %s is %d', (text, unit, length) => expect(parseLength(text, unit)).toBeCloseTo(length, 12));
  it.each([['', 'mm'], ['three', 'mm'], ['3 parsec', 'mm'], ['3mm', 'unknown'], ['1/2', 'mm'], ['1e999', 'mm']])(
    '%s in a file of %s is none', (text, unit) => expect(parseLength(text, unit)).toBeNull());
});

describe('numbers for people', () => {
  it.each([[0, '0'], [1, '1'], [123.456, '123.5'], [0.000123, '1.23e-4'], [1e7, '1e7'], [NaN, '–']])('%d is %s', (x, text) =>
    expect(format(x)).toBe(text));
  it.each([[1, 1], [4.9, 2], [7, 5], [0.03, 0.02], [1234, 1000]])('the round step below %d is %d', (x, step) =>
    expect(roundStep(x)).toBeCloseTo(step, 12));
});

describe('Knead documents', () => {
  const journal = '{"knead": 1, "commands": [\n  {"do":"hold","rows":2},\n  {"do":"step","count":3}\n]}\n';

  it('come back as they were written', () => {
    const source = Uint8Array.from({ length: 100_000 }, (_, k) => (k * 37) % 256);
    const read = readKnead(writeKnead('a "name"', source, journal));
    expect(read.name).toBe('a "name"');
    expect(read.source).toEqual(source);
    expect(read.commands).toEqual([{ do: 'hold', rows: 2 }, { do: 'step', count: 3 }]);
    expect(readKnead(writeKnead('fresh', null, journal)).source).toBeNull();
  });

  it('are scripts of the command line as well, where they began empty', () => {
    expect(readKnead(journal).commands.length).toBe(2);
  });

  it.each([
    ['', /not JSON/], ['[]', /version 1/], ['null', /version 1/], ['{"knead": 2}', /version 1/], ['{"knead": 1}', /no list of commands/],
    ['{"knead": 1, "commands": [{}]}', /no list of commands/], ['{"knead": 1, "commands": [], "source": 3}', /no text/],
    ['{"knead": 1, "commands": [], "source": "%"}', /not base64/],
  ])('%s is refused', (text, message) => expect(() => readKnead(text)).toThrow(message));

  it('carry any bytes in base64', () => {
    for (const length of [0, 1, 2, 3, 0x8001]) {
      const bytes = Uint8Array.from({ length }, (_, k) => (k * 251) % 256);
      expect(fromBase64(toBase64(bytes))).toEqual(bytes);
    }
  });
});
