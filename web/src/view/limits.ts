import type { DisplayInfo } from '../engine/displays';

/** A number above x that is short to write, and so is a quarter of it. */
export function roundLimit(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-9);
  const digits = [1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10].find((d) => d * power >= x * (1 - 1e-6)) ?? 10;
  return Number((digits * power).toPrecision(2));
}

/** Ignores the outermost hundredth, which poles and corners would dominate. */
function largestValue(fields: Float32Array[]): number {
  const sizes: number[] = [];
  for (const field of fields) {
    for (let k = 0; k < field.length; k += 3) if (Number.isFinite(field[k])) sizes.push(Math.abs(field[k]!));
  }
  sizes.sort((a, b) => a - b);
  return Math.max(sizes[Math.floor(0.99 * (sizes.length - 1))] ?? 0, 1e-9);
}

/** Where the colours of a display end: the limits that it gives, or those of the values. */
export function limitsOf(display: DisplayInfo, fields: Float32Array[]): [number, number] {
  if (display.limits) return display.limits;
  const upper = roundLimit(display.share * largestValue(fields));
  return [display.signed ? -upper : 0, upper];
}
