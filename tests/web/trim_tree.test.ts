
import { shown, showsAt, trimTree } from '@studio/engine/trim_tree';

/** What a trim shows, decided from the few segments of a leaf, is what all its loops say. */

const circle = (x: number, y: number, r: number, corners: number): number[] =>
  Array.from({ length: corners }, (_, k) => (2 * Math.PI * k) / corners).flatMap((a) => [x + r * Math.cos(a), y + r * Math.sin(a)]);
const rectangle = (x0: number, y0: number, x1: number, y1: number): number[] => [x0, y0, x1, y0, x1, y1, x0, y1];

let seed = 1;
const random = () => {
  seed = (seed * 48271) % 2147483647;
  return seed / 2147483647;
};

const cases: [string, number[][][]][] = [
  ['a disc', [[circle(0.5, 0.5, 0.4, 700)]]],
  ['the whole domain with holes', [[rectangle(0, 0, 1, 1), ...Array.from({ length: 40 }, (_, k) => circle(0.1 + 0.2 * (k % 5), 0.06 + 0.12 * Math.floor(k / 5), 0.03, 60))]]],
  ['two faces with a common edge', [[rectangle(0, 0, 0.5, 1)], [rectangle(0.5, 0, 1, 0.7)]]],
  ['a loop that leaves the domain', [[rectangle(-0.3, 0.2, 1.4, 0.8)]]],
  ['a disc of a ten-thousandth', [[circle(0.123, 0.877, 1e-4, 300)]]],
  ['a star of thin rays', [[Array.from({ length: 40 }, (_, k) => (2 * Math.PI * k) / 40).flatMap((a, k) => [0.5 + (k % 2 ? 0.45 : 0.02) * Math.cos(a), 0.5 + (k % 2 ? 0.45 : 0.02) * Math.sin(a)])]]],
];

it.each(cases)('%s', (_, faces) => {
  const trim = { faces };
  const tree = trimTree(trim)!;
  const ends = faces.flat(2);
  let differing = 0;
  for (let k = 0; k < 20_000; ++k) {
    // Half of them everywhere, half beside the loops.
    const near = 2 * Math.floor((random() * ends.length) / 2);
    const by = 10 ** (-4 * random());
    const [s, t] = k % 2 ? [random(), random()] : [ends[near]! + (random() - 0.5) * by, ends[near + 1]! + (random() - 0.5) * by];
    if (s < 0 || s > 1 || t < 0 || t > 1) continue;
    // Corners are rounded to single precision: nothing is asked nearer than that.
    const steady = [-1, 1].every((a) => [-1, 1].every((b) => shown(trim, s + a * 3e-7, t + b * 3e-7) === shown(trim, s, t)));
    if (steady && showsAt(tree, s, t) !== shown(trim, s, t)) ++differing;
  }
  expect(differing).toBe(0);
  expect(tree.segments.length / 4).toBeLessThan(8 * ends.length + 64);
});

it('of all of a surface is none', () => {
  expect(trimTree(null)).toBeNull();
});
