const metres: Record<string, number> = {
  m: 1, mm: 1e-3, cm: 1e-2, dm: 0.1, km: 1e3, um: 1e-6, µm: 1e-6, nm: 1e-9, in: 0.0254, inch: 0.0254, '"': 0.0254, ft: 0.3048,
  foot: 0.3048, mil: 2.54e-5,
};

/** A typed length in units of the file: "3", "3mm", "0.1 in". Null where it is none, or the file's unit is not known. */
export function parseLength(text: string, fileUnit: string): number | null {
  const match = /^\s*([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[-+]?\d+)?)\s*([a-zµ"]*)\s*$/i.exec(text);
  if (!match) return null;
  const value = Number(match[1]!.replace(',', '.'));
  if (!Number.isFinite(value)) return null;
  if (!match[2]) return value;
  const typed = metres[match[2].toLowerCase()];
  const file = metres[fileUnit.toLowerCase()];
  return typed !== undefined && file !== undefined ? (value * typed) / file : null;
}
