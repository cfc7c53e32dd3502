import type { DisplayInfo, DisplayRange } from '../engine/displays';
import type { SessionInfo } from '../engine/session_types';

const least = 1e-9; // the end of colours of which nothing is larger

/** A number above x that is short to write, and so is a quarter of it. */
export function roundLimit(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-9);
  const digits = [1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10].find((d) => d * power >= x * (1 - 1e-6)) ?? 10;
  return Number((digits * power).toPrecision(2));
}

/** Where the colours of a display end by themselves: the limits that it gives, or round numbers that hold the range of the values. */
export function limitsOf(display: DisplayInfo, range: DisplayRange | null): [number, number] {
  if (display.limits) return display.limits;
  const upper = roundLimit(Math.max(range?.upper ?? 0, least));
  return [display.signed ? -upper : 0, upper];
}

const reasons: Record<string, (state: SessionInfo) => string> = {
  gap: ({ tools }) => (tools.length === 0 ? 'no tool in the scene' : 'no tool beside what is selected'),
  mask: () => 'nothing is masked',
  deviation: () => 'nothing has moved',
  energy: () => 'nothing is stretched or bent',
  mean: () => 'flat everywhere', gaussian: () => 'curved in one direction at most', largest: () => 'flat everywhere',
  thickness: () => 'no face on the other side',
};
const ofShells = ({ surfaces }: SessionInfo): string => (surfaces.some((s) => s.shell) ? 'the shell is at rest' : 'no surface is a shell');

/** Why a display shows nothing, its values being none or zero; null where it shows something. */
export function nothingToShow({ name }: DisplayInfo, range: DisplayRange | null, state: SessionInfo): string | null {
  if (name === 'draft' || (range && Math.max(Math.abs(range.least), Math.abs(range.greatest)) > least)) return null;
  return `Nothing to show: ${(reasons[name] ?? ofShells)(state)}.`;
}
