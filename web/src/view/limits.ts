import type { DisplayInfo, DisplayRange } from '../engine/displays';

/** A number above x that is short to write, and so is a quarter of it. */
export function roundLimit(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-9);
  const digits = [1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10].find((d) => d * power >= x * (1 - 1e-6)) ?? 10;
  return Number((digits * power).toPrecision(2));
}

/** Where the colours of a display end by themselves: the limits that it gives, or round numbers that hold the range of the values. */
export function limitsOf(display: DisplayInfo, range: DisplayRange | null): [number, number] {
  if (display.limits) return display.limits;
  const upper = roundLimit(Math.max(range?.upper ?? 0, 1e-9));
  return [display.signed ? -upper : 0, upper];
}
