import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { crc32, exchanged, placesOf } from '@studio/document/rhino/archive';
import { loadRhino, type Rhino, type RhinoBrep, type RhinoNurbs } from '@studio/document/rhino/module';
import { nurbsOf, type Patch, patchOf, samePatch } from '@studio/document/rhino/patch';
import { openRhino, readRhino } from '@studio/document/rhino/read';
import { rewriteRhino, writeRhino } from '@studio/document/rhino/write';

import { collected } from './collection';
import { boxes } from './rhino_boxes';

const root = fileURLToPath(new URL('../..', import.meta.url));

let rhino: Rhino;
beforeAll(async () => {
  rhino = await loadRhino(new Uint8Array(readFileSync(join(root, 'web/node_modules/rhino3dm/rhino3dm.wasm'))));
});

/** Numbers that are no short decimals, and odd knots. */
function patch(rational: boolean): Patch {
  const net: [number, number] = [5, 4];
  const points = Array.from({ length: 20 }, (_, k): [number, number, number] => [Math.sin(k) * 10, Math.cos(3 * k) / 3, k / 7]);
  return { degree: [3, 2], net, knots_u: [0, 0, 0, 0, 0.3, 1, 1, 1, 1], knots_v: [-1, -1, -1, 1 / 3, 2, 2, 2], points,
    weights: rational ? points.map((_, k) => 2 ** (k % 3)) : null };
}

const moved = (p: Patch, k: number): Patch => ({ ...p, points: p.points.map((x, j) => (j === k ? [x[0], x[1], x[2] + 1.25] : x)) });
const named = (name: string, p: Patch) => ({ name, patch: p });

/** S(u, v) by the definition, in Knead's terms. */
function evaluate(p: Patch, u: number, v: number): number[] {
  const basis = (x: number[], i: number, d: number, t: number): number => {
    if (d === 0) return x[i]! <= t && t < x[i + 1]! ? 1 : 0;
    const part = (a: number, b: number) => (b === 0 ? 0 : a / b);
    return part(t - x[i]!, x[i + d]! - x[i]!) * basis(x, i, d - 1, t) + part(x[i + d + 1]! - t, x[i + d + 1]! - x[i + 1]!) * basis(x, i + 1, d - 1, t);
  };
  const sum = [0, 0, 0, 0];
  p.points.forEach((point, k) => {
    const i = Math.floor(k / p.net[1]), j = k % p.net[1];
    const r = basis(p.knots_u, i, p.degree[0], u) * basis(p.knots_v, j, p.degree[1], v) * (p.weights?.[k] ?? 1);
    point.forEach((x, axis) => (sum[axis]! += r * x));
    sum[3]! += r;
  });
  return sum.slice(0, 3).map((x) => x / sum[3]!);
}

describe('Rhino files', () => {
  it.each([false, true])('carry a surface bit for bit (rational: %s)', (rational) => {
    const before = patch(rational);
    const { bytes } = writeRhino(rhino, [named('wave', before)], 'inch');
    const contents = readRhino(rhino, openRhino(rhino, bytes));
    expect(contents.unit).toBe('inch');
    expect(contents.surfaces.map((s) => s.name)).toEqual(['wave']);
    expect(contents.surfaces[0]!.patch).toEqual(before);
  });

  it('keep places within rounding where weights are no powers of two', () => {
    const p = { ...patch(true), weights: patch(true).points.map((_, k) => 0.1 + k / 3) };
    const back = readRhino(rhino, openRhino(rhino, writeRhino(rhino, [named('w', p)], 'mm').bytes)).surfaces[0]!.patch;
    expect(back.weights).toEqual(p.weights);
    back.points.flat().forEach((x, k) => expect(Math.abs(x - p.points.flat()[k]!)).toBeLessThanOrEqual(4.5e-16 * Math.abs(x)));
  });

  it('become surfaces that are the same everywhere, the knots that openNURBS leaves out restored', () => {
    // Unclamped and uneven, rational: evaluated by openNURBS and by the definition on the restored knots.
    const nurbs = rhino.NurbsSurface.create(3, true, 4, 3, 5, 4);
    [0.5, 1, 2.5, 3, 4.5, 5, 7].forEach((x, k) => nurbs.knotsU().set(k, x));
    [0, 1, 1.5, 2, 4].forEach((x, k) => nurbs.knotsV().set(k, x));
    const odd = patch(true);
    odd.points.forEach((x, k) => nurbs.points().set(Math.floor(k / 4), k % 4, [...x.map((c) => c * odd.weights![k]!), odd.weights![k]!]));
    const p = patchOf(nurbs);
    expect(p.knots_u.length).toBe(5 + 3 + 1);
    const at = nurbs as RhinoNurbs & { pointAt(u: number, v: number): number[] };
    for (const u of [2.5, 2.7, 3, 2.9]) {
      for (const v of [1, 1.3, 1.5, 1.9]) evaluate(p, u, v).forEach((x, axis) => expect(x).toBeCloseTo(at.pointAt(u, v)[axis]!, 13));
    }
  });

  it('keep ids, order and every other surface when one is sculpted', () => {
    const bytes = writeRhino(rhino, [named('a', patch(false)), named('b', patch(true)), named('c', patch(false))], 'mm').bytes;
    const ids = (b: Uint8Array) => {
      const f = openRhino(rhino, b);
      return Array.from({ length: f.objects().count }, (_, k) => f.objects().get(k).attributes().id);
    };
    const changed = rewriteRhino(rhino, bytes, [named('a', patch(false)), named('b', moved(patch(true), 7)), named('c', patch(false))]);
    expect(changed.beside).toEqual([]);
    expect(ids(changed.bytes)).toEqual(ids(bytes));
    const after = readRhino(rhino, openRhino(rhino, changed.bytes)).surfaces.map((s) => s.patch);
    expect(after).toEqual([patch(false), moved(patch(true), 7), patch(false)]);
  });

  it('get a surface with another net in place of the old one, and further surfaces', () => {
    const bytes = writeRhino(rhino, [named('a', patch(false)), named('b', patch(false))], 'm').bytes;
    const fine: Patch = { degree: [1, 1], net: [2, 2], knots_u: [0, 0, 1, 1], knots_v: [0, 0, 1, 1], points: [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1]], weights: null };
    const written = rewriteRhino(rhino, bytes, [named('a', fine), named('b', patch(false)), named('new', patch(true))]);
    const { surfaces, unit } = readRhino(rhino, openRhino(rhino, written.bytes));
    expect(unit).toBe('m');
    expect(new Map(surfaces.map((s) => [s.name, s.patch]))).toEqual(new Map([['a', fine], ['b', patch(false)], ['new', patch(true)]]));
  });

  it.each([false, true])('keep the side of a face whose surface gets another net (turned: %s)', (turned) => {
    const file = new rhino.File3dm();
    const attributes = new rhino.ObjectAttributes();
    attributes.name = 'sheet';
    const brep = rhino.Brep.createFromSurface(nurbsOf(rhino, patch(false)));
    if (turned) brep.flip();
    file.objects().add(brep, attributes);
    const bytes = file.toByteArrayOptions(Object.assign(new rhino.File3dmWriteOptions(), { version: 7 }));
    const fine: Patch = { degree: [1, 1], net: [2, 2], knots_u: [0, 0, 1, 1], knots_v: [0, 0, 1, 1], points: [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1]], weights: null };
    const written = openRhino(rhino, rewriteRhino(rhino, bytes, [named('sheet', fine)]).bytes);
    const face = (written.objects().get(0).geometry() as RhinoBrep).faces().get(0);
    expect(patchOf(face.underlyingSurface().toNurbsSurface()!)).toEqual(fine);
    expect(face.orientationIsReversed).toBe(turned);
  });

  it('of a later version get other numbers in their place, and the sum over them', () => {
    const bytes = writeRhino(rhino, [named('a', patch(false)), named('b', moved(patch(false), 5))], 'mm').bytes;
    const was = Float64Array.from(patch(false).points.flat());
    const now = was.map((x, k) => (k === 4 ? x + 0.125 : x));
    const places = placesOf(bytes, was);
    expect(places.length).toBe(1);
    const written = exchanged(bytes, places[0]!, now)!;
    const after = readRhino(rhino, openRhino(rhino, written)).surfaces;
    expect(after[0]!.patch.points.flat()).toEqual([...now]);
    expect(after[1]!.patch).toEqual(moved(patch(false), 5));
    expect(exchanged(written, places[0]!, was)).toEqual(bytes);
    // Where the sum is wrong before, nothing is written.
    const broken = bytes.slice();
    broken[places[0]! + 3]! ^= 1;
    expect(exchanged(broken, places[0]!, now)).toBeNull();
    expect(crc32(new TextEncoder().encode('123456789'))).toBe(0xcbf43926); // the check value of CRC-32
  });

  it('keep a solid that is made, but for its sculpted face', () => {
    const bytes = boxes(rhino, ['box', [0, 0, 0], [1, 2, 3]]);
    const { surfaces } = readRhino(rhino, openRhino(rhino, bytes));
    expect(surfaces.length).toBe(6);
    const wanted = surfaces.map((s, k) => (k === 2 ? named(s.name, moved(s.patch, 0)) : s));
    const written = rewriteRhino(rhino, bytes, wanted);
    expect([...written.beside, ...written.within]).toEqual([surfaces[2]!.name]);
    const after = readRhino(rhino, openRhino(rhino, written.bytes)).surfaces;
    for (const s of wanted) expect(after.some((other) => samePatch(other.patch, s.patch))).toBe(true);
    expect(after.length).toBe(6 + written.beside.length);
    expect(openRhino(rhino, written.bytes).objects().count).toBe(1 + written.beside.length);
  });

  it('say what they cannot be', () => {
    expect(() => openRhino(rhino, new TextEncoder().encode('no Rhino file at all'))).toThrow(/no Rhino file/);
  });
});

/** A statement about files: of boxes, made here, and of every Rhino file of the collection. */
function ofFiles(statement: string, check: (source: Uint8Array) => void): void {
  it(`two boxes: ${statement}`, () => check(boxes(rhino, ['large', [0, 0, 0], [7, 2, 3]], ['small', [10, 0, 0], [11, 5, 4]])));
  const folder = collected();
  const files = folder ? readdirSync(folder).filter((f) => f.endsWith('.3dm')) : [];
  it.each(files)(`%s: ${statement}`, (name) => check(new Uint8Array(readFileSync(join(folder!, name)))));
  if (files.length === 0) it.skip(`Rhino's own files: ${statement}`);
}

describe('files of polysurfaces', () => {
  ofFiles('surfaces read, one sculpted, all else as it was', (source) => {
    const file = openRhino(rhino, source);
    const { surfaces, unit, skipped } = readRhino(rhino, file);
    expect(unit).toBe('mm');
    expect(skipped).toEqual([]);
    expect(surfaces.length).toBeGreaterThan(0);
    for (const { patch: p } of surfaces) {
      expect(p.points.length).toBe(p.net[0] * p.net[1]);
      expect(p.knots_u.length).toBe(p.net[0] + p.degree[0] + 1);
      p.knots_u.slice(1).forEach((x, k) => expect(x).toBeGreaterThanOrEqual(p.knots_u[k]!));
    }
    // Nothing changed: every surface has the same bits in the file that is written.
    const same = rewriteRhino(rhino, source, surfaces);
    expect(readRhino(rhino, openRhino(rhino, same.bytes)).surfaces).toEqual(surfaces);
    // One changed: the others keep theirs.
    const first = surfaces[0]!;
    const geometry = file.objects().get(first.object).geometry();
    const whole = first.face === null || (geometry as RhinoBrep).isSurface;
    const changed = rewriteRhino(rhino, source, surfaces.map((s, k) => (k === 0 ? named(s.name, moved(s.patch, 3)) : s)));
    const after = readRhino(rhino, openRhino(rhino, changed.bytes)).surfaces.map((s) => s.patch);
    expect(changed.beside).toEqual([]);
    expect(changed.within).toEqual(whole ? [] : [first.name]);
    const has = (p: Patch) => after.some((other) => samePatch(p, other));
    expect(has(moved(first.patch, 3))).toBe(true);
    expect(has(first.patch)).toBe(false);
    for (const s of surfaces.slice(1)) expect(has(s.patch)).toBe(true);
    expect(openRhino(rhino, changed.bytes).archiveVersion).toBe(file.archiveVersion);
    if (whole) return;
    // Under the face of a polysurface only the numbers of its control points, and a sum over them, are others.
    const differ = [...source.keys()].filter((k) => source[k] !== changed.bytes[k]);
    expect(changed.bytes.length).toBe(source.length);
    expect(differ.length).toBeGreaterThan(0);
    expect(differ.length).toBeLessThanOrEqual(8 * 3 + 4);
    // With another net the numbers cannot stay in their place: it lies beside.
    const fine: Patch = { degree: [1, 1], net: [2, 2], knots_u: [0, 0, 1, 1], knots_v: [0, 0, 1, 1], points: [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1]], weights: null };
    const other = rewriteRhino(rhino, source, surfaces.map((s, k) => (k === 0 ? named(s.name, fine) : s)));
    expect([other.beside, other.within]).toEqual([[first.name], []]);
  });

  ofFiles('faces of several polysurfaces are exchanged at once, beside a further surface', (source) => {
    const file = openRhino(rhino, source);
    const { surfaces } = readRhino(rhino, file);
    const chosen = (k: number) => k % 3 === 1;
    const wanted = surfaces.map((s, k) => (chosen(k) ? named(s.name, moved(s.patch, 2)) : s));
    const written = rewriteRhino(rhino, source, [...wanted, named('new', patch(true))]);
    const after = readRhino(rhino, openRhino(rhino, written.bytes)).surfaces.map((s) => s.patch);
    for (const { patch: p } of [...wanted, named('new', patch(true))]) expect(after.some((other) => samePatch(p, other))).toBe(true);
    expect(written.beside).toEqual([]);
    expect(after.length).toBe(surfaces.length + 1);
  });
});
