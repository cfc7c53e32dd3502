import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import * as THREE from 'three';

import { cannotFollow, type MeasuredPoint } from '@studio/document/readings';
import { Engine } from '@knead/engine';
import { type AssemblyNode, assemblyTree, placeNames } from '@studio/panels/assembly_tree';
import { inModel } from '@studio/tools/measure';
import { ContextView } from '@studio/view/context_view';
import { boxOf, type DrawnBody, drawnBodies, nearestChord } from '@studio/view/near';
import { eyeOn } from '@studio/view/nearby';
import { GridPicker } from '@studio/view/picking';
import { mostDrawn, placedPoints, Placing, planeOf, still } from '@studio/view/placing';
import { cutOfPicture } from '@studio/view/section_lines';
import { nearestOn, scenePoint } from '@studio/view/surface_pick';

import { assemblyStep, nestedStep } from './assembly_step';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));
const wasm = readFileSync(here('../../web/src/engine/knead_studio.wasm'));
let engine: Engine;
const placing = new Placing();
/** Of the plate, in the order of the file: upright, turned, lying. */
const middles = [[20, 0, 0], [0, 30, 0], [0, -30, 5]] as const;
let plate: string;

beforeAll(async () => {
  engine = await Engine.load(wasm);
  engine.query('open', { file: assemblyStep(), name: 'table.step' });
  placing.open(engine.query('assembly'), engine.query('origin'));
  plate = engine.query('state').surfaces[0]!.id;
});

const inScene = (p: readonly number[]) => new THREE.Vector3(...p.map((x, d) => x - engine.query('origin')[d]!) as [number, number, number]);

describe('parts of an assembly', () => {
  it('come from the engine with their places, converted surfaces among them', () => {
    const { unit, parts, warnings } = engine.query('assembly')!;
    expect([unit, warnings]).toEqual(['mm', []]);
    expect(parts.map((p) => [p.name, p.unit, p.places.length, p.surfaces.length, p.faces.length, p.curves.length]))
      .toEqual([['plate', 'mm', 3, 1, 0, 0], ['foot', 'inch', 1, 1, 1, 0], ['rail', 'mm', 2, 0, 0, 1]]);
    expect(parts[0]!.places[0]).toEqual({ path: 'table/plate', matrix: [0, 0, 1, 20, 1, 0, 0, 0, 0, 1, 0, 0] });
    expect(engine.query('context')!.faces[0]!.surface).toBe(parts[1]!.surfaces[0]);
  });

  it('are none of a file without products', async () => {
    const fresh = await Engine.load(wasm);
    fresh.query('fresh', { name: 'sheet' });
    expect(fresh.query('assembly')).toBeNull();
    placing.of('#7').forEach((s) => expect(s).toBe(still));
  });

  it('stand in the scene where the model has them, in its unit', () => {
    expect(placing.placed).toBe(true);
    const centres = placing.of(plate).map((s) => inScene([0, 0, 0]).applyMatrix4(s.matrix));
    centres.forEach((p, k) => expect(p.distanceTo(inScene(middles[k]!))).toBeLessThan(1e-12));
    const [foot] = placing.of(engine.query('assembly')!.parts[1]!.faces[0]!);
    expect(foot!.scale).toBeCloseTo(25.4, 12);
    expect(inScene([1, 0, 0]).applyMatrix4(foot!.matrix).distanceTo(inScene([-60 + 25.4, 0, 0]))).toBeLessThan(1e-12);
  });

  it('are worked on in the place that was asked for last, each part in its own', () => {
    const [first, second] = placing.of(plate);
    expect(placing.working(plate)).toBe(first);
    expect(placing.work(second!)).toBe(true);
    expect(placing.work(second!)).toBe(false);
    expect(placing.working(plate)).toBe(second);
    expect(placing.working('#7')).toBe(still);
    expect(placing.work(first!)).toBe(true);
  });

  it('have curves where they stand, met there by the pointer', () => {
    const { bodies } = engine.query('state');
    expect(placing.of(bodies[0]!.id).map((s) => inScene([12, 0, 0]).applyMatrix4(s.matrix).distanceTo(inScene(s.place === 0 ? [0, 72, 0] : [12, 60, 8]))))
      .toEqual([expect.closeTo(0, 12), expect.closeTo(0, 12)]);
    const all = drawnBodies([engine.query('body_picture', { body: 0 })], bodies, placing);
    const boxes = all.map((drawn) => boxOf(drawn).translate(new THREE.Vector3(...(engine.query('origin') as [number, number, number]))));
    const near = (p: THREE.Vector3, q: readonly number[]) => p.toArray().forEach((x, d) => expect(x).toBeCloseTo(q[d]!, 5));
    near(boxes[0]!.min, [0, 60, 0]);
    near(boxes[0]!.max, [0, 72, 0]);
    near(boxes[1]!.min, [0, 60, 8]);
    near(boxes[1]!.max, [12, 60, 8]);
    // Seen from above, in the scene.
    const above = ({ picture, standing }: DrawnBody) => placedPoints(picture.lines, standing).filter((_, k) => k % 3 < 2);
    const at = inScene([0, 66, 0]);
    const hit = nearestChord(all, at.x, at.y, 0.1, above)!;
    expect(hit.standing.place).toBe(0);
    expect(hit.point.distanceTo(inScene([6, 0, 0]))).toBeLessThan(1e-4);
    expect(scenePoint(hit).distanceTo(at)).toBeLessThan(1e-4);
  });

  it('are hit by rays where they stand, at the same point of the surface', () => {
    const picture = engine.query('picture', { surface: 0, detail: 24 });
    const surfaces = [{ picker: new GridPicker(picture), trim: null, standings: placing.of(plate) }];
    const hitAt = (from: readonly number[], to: readonly number[]) =>
      nearestOn(new THREE.Ray(inScene(from), inScene(to).sub(inScene(from)).normalize()), Infinity, surfaces);
    // (1, 2, 0) of the part: at (20, 1, 2), at (-2, 31, 0), at (1, -28, 5).
    const hits = [hitAt([40, 1, 2], [20, 1, 2]), hitAt([-2, 31, 9], [-2, 31, 0]), hitAt([1, -28, 9], [1, -28, 5])];
    hits.forEach((hit, place) => {
      expect(hit!.standing.place).toBe(place);
      expect(hit!.point.distanceTo(inScene([1, 2, 0]))).toBeLessThan(1e-5);
      hit!.fractions.forEach((x, d) => expect(x).toBeCloseTo(hits[0]!.fractions[d]!, 5));
    });
    expect(scenePoint(hits[0]!)!.distanceTo(inScene([20, 1, 2]))).toBeLessThan(1e-5);
    expect(hitAt([1, 2, 9], [1, 2, 0])).toBeNull(); // where the part would be drawn at its own origin
  });

  it('are cut by a plane of the scene where they stand', () => {
    const picture = engine.query('picture', { surface: 0, detail: 24 });
    // x = 20 would touch the upright one all over; y = 30.5 cuts the turned one only.
    const offset = -(30.5 - engine.query('origin')[1]);
    const lengths = placing.of(plate).map((at) => {
      const cut = placedPoints(cutOfPicture(picture, planeOf([0, 1, 0, offset], at), null), at);
      for (let k = 1; k < cut.length; k += 3) expect(cut[k]! + engine.query('origin')[1]).toBeCloseTo(30.5, 5);
      let sum = 0;
      for (let k = 0; k < cut.length; k += 6) sum += Math.hypot(...[0, 1, 2].map((d) => cut[k + d]! - cut[k + 3 + d]!));
      return sum;
    });
    [0, 10, 0].forEach((length, k) => expect(lengths[k]).toBeCloseTo(length, 5));
  });

  it('are measured in the model: distances between places, radii in its unit', () => {
    const reading = (p: [number, number, number]): MeasuredPoint => ({ surface: 0, at: [0.5, 0.5], point: p, displacement: [0, 0, 0], normal: [0, 0, 1], curvature: [0.5, 0] });
    const [upright, turned] = placing.of(plate);
    const a = inModel(reading([0, 0, 0]), upright!, engine.query('origin')), b = inModel(reading([0, 0, 0]), turned!, engine.query('origin'));
    expect(Math.hypot(...a.point.map((x, d) => x - b.point[d]!))).toBeCloseTo(Math.hypot(20, 30), 12);
    a.normal.forEach((x, d) => expect(x).toBeCloseTo([1, 0, 0][d]!, 12));
    const kind = 'distance' as const, more = { name: 'distance 1', pinned: false, names: [], kind };
    expect(cannotFollow({ ...more, points: [a, a] })).toBeNull();
    expect(cannotFollow({ ...more, points: [a, b] })).toContain('several places');
    const [foot] = placing.ofPart(1);
    const onFoot = inModel(reading([1, 0, 0]), foot!, engine.query('origin'));
    expect(onFoot.curvature![0]).toBeCloseTo(0.5 / 25.4, 12);
    expect(cannotFollow({ ...more, points: [onFoot, onFoot] })).not.toBeNull();
    expect(inModel(reading([1, 2, 3]), still, engine.query('origin'))).toEqual(reading([1, 2, 3]));
  });

  it('are seen from nearby in their own size', () => {
    const [foot] = placing.ofPart(1);
    const eye = { matrix: new THREE.Matrix4().makePerspective(-1, 1, 1, -1, 1, 1000), scale: 300 };
    const on = eyeOn(eye, foot!);
    expect(on.scale).toBeCloseTo(300 * 25.4, 9);
    const p = new THREE.Vector3(0.3, 0.2, -1);
    expect(p.clone().applyMatrix4(on.matrix).distanceTo(p.clone().applyMatrix4(foot!.matrix).applyMatrix4(eye.matrix))).toBeLessThan(1e-9);
    expect(eyeOn(eye, still)).toEqual(eye);
  });

  it('are grey where they stand, and are hit there', () => {
    const grey = new ContextView();
    grey.show(engine.query('context'), placing);
    grey.group.visible = true;
    const box = grey.box()!;
    expect(box.min.distanceTo(inScene([-85.4, -25.4, 0]))).toBeLessThan(1e-4);
    expect(box.max.distanceTo(inScene([-34.6, 25.4, 0]))).toBeLessThan(1e-4);
    const ray = new THREE.Raycaster(inScene([-50, 5, 9]), new THREE.Vector3(0, 0, -1));
    const hit = grey.hit(ray, Infinity)!;
    expect(hit.point.distanceTo(inScene([10 / 25.4, 5 / 25.4, 0]))).toBeLessThan(1e-5);
    grey.choose(hit);
    expect(grey.chosenBox()!.min.x).toBeCloseTo(box.min.x, 4);
    expect(grey.hit(new THREE.Raycaster(inScene([0, 0, 9]), new THREE.Vector3(0, 0, -1)), Infinity)).toBeNull();
  });

  it('that are mirrored look alike from outside: their grey triangles are turned over by the mesh', () => {
    const all = engine.query('assembly')!;
    const mirrored = { ...all, parts: all.parts.map((part) => ({ ...part, places: [...part.places, { path: 'mirrored', matrix: [-1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0] }] })) };
    const both = new Placing();
    both.open(mirrored, engine.query('origin'));
    const grey = new ContextView();
    grey.show(engine.query('context'), both);
    grey.group.visible = true;
    expect(grey.group.children.map((mesh) => Math.sign(mesh.matrixWorld.determinant()))).toEqual([1, -1]);
    const hit = grey.hit(new THREE.Raycaster(inScene([4.5, 0.25, 9]), new THREE.Vector3(0, 0, -1)), Infinity)!;
    expect(hit.point.distanceTo(inScene([0.5, 0.25, 0]))).toBeLessThan(1e-5);
  });

  it('beyond what can be drawn are counted', () => {
    const all = engine.query('assembly')!;
    const many = new Placing();
    many.open({ ...all, parts: [{ ...all.parts[0]!, places: Array.from({ length: mostDrawn + 7 }, () => all.parts[0]!.places[0]!) }] }, engine.query('origin'));
    expect([many.of(plate).length, many.left]).toEqual([mostDrawn, 7]);
  });

  it('have names for their places, as commands do', async () => {
    const nested = await Engine.load(wasm);
    nested.query('open', { file: nestedStep(), name: 'door.step' });
    const pin = nested.query('assembly')!.parts.find(({ name }) => name === 'pin')!;
    const names = placeNames(pin);
    expect(new Set(names).size).toBe(7);
    names.forEach((name, k) => {
      const [x, y] = [3, 7].map((d) => pin.places[k]!.matrix[d]!) as [number, number];
      const scan = new TextEncoder().encode(Array.from({ length: 25 }, (_, l) => `${(l % 5) - 2 + x} ${Math.floor(l / 5) - 2 + y} 0.1`).join('\n'));
      expect(nested.query('deviation', { scan, unit: 'mm', place: [name] }).used).toBe(25);
      expect(() => nested.query('deviation', { scan, unit: 'mm', place: [names[(k + 1) % 7]!] })).toThrow(/none of 25 points/);
    });
    expect(placeNames({ ...pin, places: ['a', 'b', 'a', 'a'].map((path) => ({ path, matrix: [] })) })).toEqual(['a', 'b', 'a:2', 'a:3']);
  });
});

describe('the product tree', () => {
  const text = (node: AssemblyNode): unknown => [...node.within.values()].map((n) => [n.name, n.places.length, ...(n.within.size > 0 ? [text(n)] : [])]);

  it('has the products below each other, and counts those of one name', () => {
    expect(text(assemblyTree(engine.query('assembly')!))).toEqual([['table', 0, [['plate', 3], ['foot', 1], ['rail', 2]]]]);
  });

  it('shows geometry that belongs to no product', () => {
    const rest = { name: '', unit: 'mm', surfaces: ['#1'], faces: [], curves: [], places: [{ path: '', matrix: [] }] };
    expect(text(assemblyTree({ unit: 'mm', parts: [rest], warnings: [] }))).toEqual([['', 1]]);
  });
});
