type Attributes = Record<string, string | number | null | undefined>;

/** An SVG element; attributes that are null or undefined are left out. */
export function s<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): SVGElementTagNameMap[K] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  set(element, attributes);
  element.append(...children);
  return element;
}

export function set(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined) element.removeAttribute(name);
    else element.setAttribute(name, String(value));
  }
}

/** Round numbers inside [low, high], about as many as wanted. */
export function ticks(low: number, high: number, wanted: number): number[] {
  const length = high - low;
  if (!(length > 0) || !Number.isFinite(length)) return [];
  const raw = length / Math.max(1, wanted);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((f) => f * power).find((f) => f >= raw * 0.999) ?? raw;
  const all: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && all.length < 100; ++k) all.push(Number((k * step).toPrecision(12)));
  return all;
}
