import type { Document } from '../../bindings/npm/src/index';
import { bonnet, knead } from './support';

// Documents in Node.

const { create, open, restore, KneadError } = await knead();

async function sheet(): Promise<Document> {
  const doc = await create({ name: 'sheet' });
  return doc.new('plane', { size: [100, 100], net: [12, 12] }).hold(2).tool('ball', { radius: 20, position: [50, 50, 10] });
}

/** What a call throws. */
function thrown(call: () => unknown): InstanceType<typeof KneadError> {
  try {
    call();
  } catch (error) {
    expect(error).toBeInstanceOf(KneadError);
    return error as InstanceType<typeof KneadError>;
  }
  throw new Error('nothing was thrown');
}

it('has a method for every command of a script, and each returns the document', async () => {
  const doc = await sheet();
  const { message } = thrown(() => doc.run([{ do: 'nothing' } as never]));
  const names = /the commands are: ([\w, ]+)/.exec(message)![1]!.split(', ');
  expect(names.length).toBeGreaterThan(40);
  for (const name of names) expect(typeof (doc as never as Record<string, unknown>)[name], name).toBe('function');
  expect(doc.select('#1').select({ surface: '#1' }).step()).toBe(doc);
});

it('takes the first field alone or by name, and numbers in typed arrays', async () => {
  const one = await sheet(), other = await sheet();
  one.step(3, { lambda: 20 }).move('ball', { by: [0, 0, 1] });
  other.step({ count: 3, lambda: 20 }).move({ tool: 'ball', by: Float64Array.of(0, 0, 1) as never });
  expect(other.surfaces[0]!.controlPoints).toEqual(one.surfaces[0]!.controlPoints);
  expect(other.script).toBe(one.script);
});

it('says of an error what the library says, and has changed nothing', async () => {
  const doc = await sheet();
  const before = doc.state;
  const error = thrown(() => doc.step(-1));
  expect(error).toMatchObject({ name: 'KneadError', code: 'out_of_range', kind: 'input', where: 'count', values: {}, fixes: [], file: '', line: 0 });
  expect(error.message).toBe('count: -1 is out of range; use numbers from 0 to 1000000');
  expect(thrown(() => doc.move('ball', { by: [0, 0, NaN] }))).toMatchObject({ where: 'by[2]', what: 'NaN is no number', remedy: 'use a finite one' });
  expect(thrown(() => doc.run('{"knead": 2, "commands": [{"do": "undo"}, {"do": "step", "count": -1}]}', { name: 'press.json' })))
    .toMatchObject({ where: 'commands[1].count', file: 'press.json' });
  expect(thrown(() => doc.run('{\n]', { name: 'press.json' }))).toMatchObject({ file: 'press.json', line: 2 });
  expect(doc.state).toEqual(before);
});

it('carries out what an error says would help', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  doc.select('#285').hold(2).tool('ball', { radius: 160, at: [0.4, 0.5] }).step(3);
  const error = thrown(() => doc.save());
  expect(error).toMatchObject({ code: 'edge_left_open', kind: 'numerical', values: { surface: '#285' } });
  doc.run(error.fixes.find(({ code }) => code === 'let_open')!);
  expect(doc.save().length).toBeGreaterThan(80_000);
});

it('stops at false, at what is thrown and at a signal; whole steps stay', async () => {
  const doc = await sheet();
  expect(doc.step(50, { progress: (done) => done < 2 }).state.steps).toBe(2);
  expect(() => doc.step(50, { progress: () => { throw new RangeError('mine'); } })).toThrow(new RangeError('mine'));
  const abort = new AbortController();
  expect(() => doc.run([{ do: 'step', count: 50 }, { do: 'hold', rows: 1 }], { signal: abort.signal, progress: () => abort.abort() })).toThrow(/abort/i);
  expect(() => doc.step(50, { signal: abort.signal })).toThrow(/abort/i);
  expect(doc.state).toMatchObject({ steps: 4, surfaces: [{ hold: 2 }] });
  expect(doc.undo().undo().undo().state.steps).toBe(0);
});

it('is not used in a function that its own command calls', async () => {
  const doc = await sheet();
  expect(thrown(() => doc.step(2, { progress: () => void doc.undo() }))).toMatchObject({ kind: 'usage', what: 'the document is at work' });
  expect(doc.step().state.steps).toBe(2);
});

it('is restored from a snapshot with undo and redo, which can be posted', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  doc.select('#285').tool('ball', { radius: 160, at: [0.4, 0.5] }).step(3).undo();
  const again = await restore(structuredClone(doc.snapshot()));
  expect(again.redo().surface('#285').controlPoints).toEqual(doc.redo().surface('#285').controlPoints);
  again.undo().undo().undo();
  expect(again.state).toMatchObject({ undo: false, name: 'bonnet.step' });
  expect(Buffer.compare(again.save(), bonnet())).toBe(0);
  const inches = await restore((await create({ unit: 'inch' })).snapshot());
  expect(inches.new().surfaces[0]!.unit).toBe('inch');
});

it('names surfaces by id and by label, and makes the same of their numbers', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  expect(doc.surface('bonnet skin').id).toBe('#285');
  expect(thrown(() => doc.surface('roof'))).toMatchObject({ what: 'there is no surface "roof"', remedy: 'the ids are: #285, #1044' });
  const { degree, net, knots, weights, controlPoints } = doc.surface('#285').shape;
  expect([controlPoints.length, knots[0].length, weights]).toEqual([3 * net[0] * net[1], net[0] + degree[0] + 1, null]);
  const gone = await sheet();
  const surface = gone.surfaces[0]!;
  gone.undo().undo().undo();
  expect(thrown(() => surface.controlPoints)).toMatchObject({ where: '#1', what: 'it is not in the document any more' });
});

it('writes other formats, and says what they would lose', async () => {
  const doc = await sheet();
  const back = await open(doc.save('sheet.igs'), { name: 'sheet.igs' });
  expect(back.surfaces[0]!.controlPoints).toEqual(doc.surfaces[0]!.controlPoints);
  expect(thrown(() => doc.save('sheet.stl'))).toMatchObject({ where: 'sheet.stl', what: '.stl holds triangles, which lose the surfaces' });
  expect(doc.export('sheet.stl', { detail: 8 })).toMatchObject({ leftOut: [] });
  const file = await open(bonnet(), { name: 'bonnet.step' });
  expect(file.export('bonnet.stl', { tolerance: 10 }).file.length).toBeLessThan(file.export('bonnet.stl', { tolerance: 0.1 }).file.length);
  const iges = await open(file.save('bonnet.igs'), { name: 'bonnet.igs' });
  expect(iges.check().edges.length).toBe(file.check().edges.length);
  for (const { controlPoints } of file.surfaces) expect(iges.surfaces.map((one) => one.controlPoints)).toContainEqual(controlPoints);
  expect(thrown(() => file.save('bonnet.g2')).message).toMatch(/lose the faces/);
});

it('answers every query of a document, as the program does', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  const answer = doc.check({ class: 'a', curvature: 2 });
  expect(answer).toMatchObject({ passed: true, file: 'bonnet.step', unit: 'mm', thresholds: { gap: 0.01, angle: 0.1, curvature: 2 } });
  expect(answer.edges.map(({ kind }) => kind).filter((kind) => kind === 'open').length).toBe(8);
  expect(doc.check({ edges: ['#43'] }).edges.map(({ id }) => id)).toEqual(['#43']);
  doc.select('#285').hold({ mode: 'open' }).tool('ball', { radius: 160, at: [0.5, 0.1] }).step(5);
  const worse = doc.check({ gap: 1e-3, against: bonnet() });
  expect(worse.passed).toBe(false);
  expect(worse.faults.map(({ measure }) => measure)).toContain('gap');
  expect(thrown(() => doc.check({ angle: 6 }))).toMatchObject({ where: 'angle' });
  expect(thrown(() => doc.check({ gap: NaN }))).toMatchObject({ where: 'gap', what: 'NaN is no number' });
  expect(thrown(() => doc.check({ unit: 'mm' }))).toMatchObject({ where: 'unit', remedy: 'give a class too' });
});

it('moves a document after data, to a file', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  const { file, report, page } = doc.morphed({ space: '0; 0; 20*sin(x/500)', scale: -0.5 });
  expect(report).toMatchObject({ scale: -0.5, unit: 'mm', left_out: 0, fixed: [] });
  expect(report.after.largest).toBeLessThan(report.tolerance);
  expect(page).toContain('## Deviation from the data');
  expect(doc.save()).toEqual(bonnet());
  expect(doc.morph({ space: '0; 0; 20*sin(x/500)', scale: -0.5 }).save()).toEqual(file);
  expect(doc.undo().save()).toEqual(bonnet());
  const moved = await open(file, { name: 'moved.step' });
  expect(moved.check({ gap: 1e-2, against: bonnet() }).passed).toBe(true);
  const lines = new TextEncoder().encode('0 0 0 0 0 1\n');
  expect(thrown(() => doc.morphed({ space: '0;0;0', vectors: lines }))).toMatchObject({ where: 'vectors', kind: 'usage' });
  expect(thrown(() => doc.morphed())).toMatchObject({ what: 'nothing says where the surfaces should go' });
});

it('says how far data are from a document, which stays', async () => {
  const doc = await open(bonnet(), { name: 'bonnet.step' });
  const answer = doc.deviation({ space: '0; 0; 2' });
  expect(answer).toMatchObject({ unit: 'mm', used: answer.points, left_out: 0, alignment: null });
  expect(answer.deviation.largest).toBeLessThanOrEqual(2 + 1e-12);
  const [places, wanted] = [answer.places, answer.wanted].map((bytes) => new Float64Array(bytes.buffer));
  expect([places!.length, wanted!.length, answer.states.length]).toEqual([3 * answer.points, 3 * answer.points, answer.points]);
  expect([...wanted!.slice(0, 3)]).toEqual([0, 0, 2]);
  const scan = new TextEncoder().encode(Array.from({ length: 9 }, (_, k) => [...places!.slice(3 * k, 3 * k + 3)].join(' ')).join('\n'));
  expect(doc.deviation({ scan, unit: 'mm' }).deviation.largest).toBeLessThan(1e-6);
  expect(doc.save()).toEqual(bonnet());
  expect(thrown(() => doc.deviation())).toMatchObject({ what: 'nothing says where the surfaces should go' });
});

it('compresses as the file was, or as a name says', async () => {
  const gzip = new Uint8Array(await new Response(new Blob([bonnet()]).stream().pipeThrough(new CompressionStream('gzip'))).arrayBuffer());
  const doc = await open(gzip, { name: 'bonnet.step.gz' });
  expect(await doc.saveCompressed()).toEqual(gzip);
  doc.select('#285').hold({ mode: 'position' }).tool('ball', { radius: 60, at: [0.4, 0.5] }).step();
  for (const packed of [await doc.saveCompressed(), await doc.saveCompressed('new.stpZ'), await (await restore(doc.snapshot())).saveCompressed('a/new.step.gz')]) {
    expect(packed.length).toBeLessThan(0.7 * bonnet().length);
    expect(Buffer.compare((await open(packed)).save(), doc.save())).toBe(0);
  }
  const zip = await doc.saveCompressed('a/new.stpZ');
  expect(new TextDecoder('latin1').decode(zip.slice(30, 37))).toBe('new.stp');
  const again = await open(zip);
  expect(await again.saveCompressed()).toEqual(zip);
  expect((await open(await doc.saveCompressed('new.igs.gz'), { name: 'new.igs' })).check().edges.length).toBeGreaterThan(0);
  await expect(doc.saveCompressed('new.step')).rejects.toMatchObject({ what: 'the ending of new.step tells of no compression' });
  await expect((await sheet()).saveCompressed()).rejects.toMatchObject({ name: 'KneadError', remedy: 'give a name that ends in .gz or .stpZ, or use save' });
});

it('opens what is compressed, and a Blob', async () => {
  const packed = new Uint8Array(await new Response(new Blob([bonnet()]).stream().pipeThrough(new CompressionStream('gzip'))).arrayBuffer());
  const doc = await open(new Blob([packed]), { name: 'bonnet.step.gz' });
  expect(Buffer.compare(doc.save(), bonnet())).toBe(0);
  await expect(open(packed, { name: 'bonnet.step.gz', maxUnpacked: 1000 })).rejects.toMatchObject({ name: 'KneadError', where: 'bonnet.step.gz' });
  await expect(open('bonnet.step' as never)).rejects.toThrow('file: a file is opened from its bytes; give a Uint8Array, an ArrayBuffer or a Blob');
});
