/** Names of orders of derivatives and integrals, of functions and of Gramians. */

const times = ['', '', 'twice', 'three times', 'four times', 'five times', 'six times', 'seven times', 'eight times'];
const ordinal = (n: number): string => {
  const tail = n % 100 > 10 && n % 100 < 14 ? 'th' : ['th', 'st', 'nd', 'rd'][n % 10] ?? 'th';
  return `${n}${tail}`;
};

export function orderName(order: number, degree: number): string {
  if (order === 0) return 'Functions';
  if (order === -1) return 'Integrals';
  if (order < 0) return `Integrated ${times[-order] ?? `${-order} times`}`;
  const name = order === 1 ? 'Derivatives' : `${ordinal(order)} derivatives`;
  return order === degree + 1 ? `${name}: impulses` : name;
}

const small = (text: string, from: string): string => [...text].map((c) => from['0123456789'.indexOf(c)] ?? c).join('');
export const sub = (n: number): string => small(String(n), '₀₁₂₃₄₅₆₇₈₉');
export const sup = (n: number): string => small(String(n), '⁰¹²³⁴⁵⁶⁷⁸⁹');

/** N₃, N₃′, N₃⁽⁴⁾, ∫N₃, ∫²N₃ */
export function functionName(i: number, order: number): string {
  if (order < 0) return `∫${order < -1 ? sup(-order) : ''}N${sub(i)}`;
  return `N${sub(i)}${order <= 3 ? '′'.repeat(order) : `⁽${sup(order)}⁾`}`;
}

/** δ, δ′, δ⁽⁴⁾ */
export const impulseName = (k: number): string => `δ${k <= 3 ? '′'.repeat(k) : `⁽${sup(k)}⁾`}`;

export const gramianName = (a: number, b: number): string => `G${sup(a)}${a > 9 || b > 9 ? '˒' : ''}${sup(b)}`;

/** All digits, so that the same number is read back. */
export const exact = (value: number): string => (Number.isFinite(value) ? value.toPrecision(17).replace('e+', 'e') : '–');

/** A small number: two digits suffice to judge it. */
export const tiny = (value: number | null | undefined): string =>
  value === null || value === undefined || !Number.isFinite(value) ? '–' : value === 0 ? '0' : value.toExponential(1).replace('e+', 'e');

export function duration(seconds: number): string {
  const [factor, unit] = seconds < 1e-3 ? [1e6, 'µs'] : [1e3, 'ms'];
  return `${Number((seconds * factor).toPrecision(3))} ${unit}`;
}

/** A colour of its own for each of many functions, neighbours far apart. */
export const colour = (i: number, dark: boolean): string => `hsl(${(i * 137.508 + 172) % 360} ${dark ? '62% 62%' : '65% 38%'})`;
