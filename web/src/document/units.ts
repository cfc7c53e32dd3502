const metres: Record<string, number> = {
  m: 1, mm: 1e-3, cm: 1e-2, dm: 0.1, km: 1e3, um: 1e-6, µm: 1e-6, nm: 1e-9, in: 0.0254, inch: 0.0254, inches: 0.0254, '"': 0.0254,
  '″': 0.0254, ft: 0.3048, foot: 0.3048, feet: 0.3048, "'": 0.3048, '′': 0.3048, yd: 0.9144, yard: 0.9144, mile: 1609.344, mil: 2.54e-5,
  thou: 2.54e-5, microinch: 2.54e-8, 'µin': 2.54e-8,
};

/** A typed number: "3", "-.5", "2,5", "1e-3", "3/4", "1 1/2". Null if it is not a number. */
export function parseNumber(text: string): number | null {
  const fraction = /^\s*([-+]?)(?:(\d+)\s+)?(\d+)\s*[/⁄]\s*(\d+)\s*$/.exec(text);
  if (fraction) {
    const [, sign, whole, numerator, denominator] = fraction;
    const value = Number(whole ?? 0) + Number(numerator) / Number(denominator);
    return Number.isFinite(value) ? (sign === '-' ? -value : value) : null;
  }
  if (!/^\s*[-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[-+]?\d+)?\s*$/i.test(text)) return null;
  const value = Number(text.trim().replace(',', '.'));
  return Number.isFinite(value) ? value : null;
}

/** A typed length in units of the file: "3", "3mm", "0.1 in", "1 1/2 in". Null if it is not a length or the file's unit is unknown. */
export function parseLength(text: string, fileUnit: string): number | null {
  const [, number, unit] = /^(.*?)\s*([a-zµ]*|["'″′])\s*$/is.exec(text.replace(/e(?=[-+]?\d)/i, '\u0001'))!;
  const value = parseNumber(number!.replace('\u0001', 'e'));
  if (value === null || !unit || (unit === 'units' && unitInWords(fileUnit) === 'units')) return value;
  const typed = metres[unit.toLowerCase()];
  const file = metres[fileUnit.toLowerCase()];
  if (typed === undefined || file === undefined) return null;
  return typed === file ? value : (value * typed) / file;
}

/** Units of the engine whose names a person writes otherwise. */
const written: Partial<Record<string, string>> = { inch: 'in', foot: 'ft', yard: 'yd', um: 'µm', microinch: 'µin', unknown: 'units' };

/** How a person writes the unit of a file: "in" for "inch", "units" where the file has none. */
export const unitInWords = (unit: string): string => written[unit] ?? unit;

/** Up to four significant digits, as short as possible. */
export function format(value: number): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2).replace(/\.?0+e/, 'e').replace('e+', 'e');
  return String(Number(value.toPrecision(4)));
}
