/** Small helpers that make elements; no markup is ever parsed, so that nothing in a file can become code. */

type Child = Node | string | null | undefined | false;
type Props<K extends keyof HTMLElementTagNameMap> = Partial<Omit<HTMLElementTagNameMap[K], 'style' | 'className'>> & {
  class?: string;
  aria?: Record<string, string>;
  data?: Record<string, string>;
};

/** A name from the engine as a title: "top_radius" is Top radius. */
export const title = (name: string): string => name.charAt(0).toUpperCase() + name.slice(1).replaceAll('_', ' ');

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, props: Props<K> = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  const { class: className, aria, data, ...rest } = props;
  if (className) element.className = className;
  for (const [name, value] of Object.entries(aria ?? {})) element.setAttribute(`aria-${name}`, value);
  for (const [name, value] of Object.entries(data ?? {})) element.dataset[name] = value;
  Object.assign(element, rest);
  for (const child of children) if (child) element.append(child);
  return element;
}

const paths: Record<string, string> = {
  open: 'M3 7V5h6l2 2h10v12H3zM3 10h18',
  gallery: 'M4 4h7v7H4zM13 4h7v7h-7zM4 13h7v7H4zM13 13h7v7h-7z',
  recent: 'M4 12a8 8 0 108-8 8 8 0 00-6.500 3.500M5 3.500v4.500h4.500M12 8v4.500l3 2',
  save: 'M12 4v11M7 11l5 5 5-5M4 20h16',
  undo: 'M8 5L4 9l4 4M4 9h10a6 6 0 010 12h-3',
  redo: 'M16 5l4 4-4 4M20 9H10a6 6 0 000 12h3',
  restart: 'M6 5v14M19 5L9 12l10 7z',
  play: 'M7 4.5v15l12-7.5z',
  pause: 'M8 5v14M16 5v14',
  step: 'M6 5v14l9-7zM18 5v14',
  rest: 'M3 6c3 0 3 9 6 9s3-4 6-4 3 2 6 2M3 20h18',
  fit: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M9 9h6v6H9z',
  four: 'M4 4h16v16H4zM12 4v16M4 12h16',
  parallel: 'M4 8h11v11H4zM9 5h11v11M4 8l5-3M15 8l5-3M15 19l5-3',
  section: 'M12 3v18M9 5L4 7.500v9L9 19M12 5h3l5 2.500v9L15 19h-3M15 8v8',
  turntable: 'M20 15c0 2.200-3.600 4-8 4s-8-1.800-8-4 3.600-4 8-4M12 3v12M10 8.500l2.500 2.500-2.500 2.500',
  theme: 'M12 4a8 8 0 100 16zM12 4a8 8 0 010 16',
  tour: 'M5 21V4M5 5c4-3 7 3 13 0v9c-6 3-9-3-13 0',
  more: 'M5 12h.5M12 12h.5M19 12h.5',
  help: 'M9 9a3 3 0 115 2c-1 1-2 1.500-2 3M12 18v.5',
  look: 'M5 4l6 16 2.500-6.500L20 11z',
  push: 'M12 3v9M8.500 9L12 12.500 15.500 9M3 14c5 0 4 6 9 6s4-6 9-6',
  pull: 'M12 13V4M8.500 7L12 3.500 15.500 7M3 20c5 0 4-5 9-5s4 5 9 5',
  grab: 'M4 12h16M12 4v16M4 12l3-3M4 12l3 3M20 12l-3-3M20 12l-3 3M12 4L9 7M12 4l3 3M12 20l-3-3M12 20l3-3',
  brush: 'M20 4L10.500 13.500M13 16c0 3-3 5-8 4 2-1 2-3 2.500-4.500A3 3 0 0113 16z',
  pin: 'M12 21s-6-6.500-6-11a6 6 0 0112 0c0 4.500-6 11-6 11zM12 12a2 2 0 100-4 2 2 0 000 4z',
  place: 'M12 20a7 7 0 100-14 7 7 0 000 14zM5 13h14M19 3v5M16.500 5.500h5',
  smooth: 'M3 15c3-7 5-7 7 0M13 13c1.500-1.500 3-2 8-2M3 20h18M5 5h10M12.500 2.500L15 5l-2.500 2.500',
  points: 'M4 17c5 0 5-10 16-10M6 15.500a1.700 1.700 0 11-3.400 0 1.700 1.700 0 013.400 0zM13.700 11.500a1.700 1.700 0 11-3.400 0 1.700 1.700 0 013.400 0zM21.400 7a1.700 1.700 0 11-3.400 0 1.700 1.700 0 013.400 0z',
  freeze: 'M12 3v18M4.200 7.500l15.600 9M19.800 7.500l-15.600 9M9.500 4.500L12 7l2.500-2.500M9.500 19.500L12 17l2.500 2.500',
  material: 'M14 4l6 6-8 8-6-6zM6 12l-2.500 5.500c-.5 1.500 1 3 2.500 2.500L12 18',
  edges: 'M4 20V6l14-2M4 20l14-3M4 6v14M18 4v13M2.500 6h3M2.500 20h3',
  measure: 'M3 15L15 3l6 6L9 21zM7 11l2.500 2.500M10 8l1.800 1.800M13 5l2.500 2.500',
  copy: 'M8 8h12v12H8zM16 8V4H4v12h4',
  trash: 'M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13',
  close: 'M6 6l12 12M18 6L6 18',
  move: 'M12 3v18M3 12h18M12 3L9.500 5.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500',
  turn: 'M19 8a8 8 0 10.500 7M19 3v5h-5',
  lab: 'M3 19c5 0 4-14 9-14s4 14 9 14M3 19h18M3 10c3 0 3 9 6 9M21 10c-3 0-3 9-6 9',
  dock: 'M4 5h16v14H4zM4 13h16',
  ellipse: 'M12 6c5 0 9 2.700 9 6s-4 6-9 6-9-2.700-9-6 4-6 9-6z',
  volcano: 'M3 20l6-11h6l6 11zM12 6V3M8 6L6.500 4M16 6l1.500-2',
  image: 'M4 5h16v14H4zM4 16l5-5 4 4 3-3 4 4M16 9.500h.5',
  scale: 'M4 20L20 4M14 4h6v6M10 20H4v-6',
};

export function icon(name: string): SVGSVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  svg.classList.add('icon');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', paths[name] ?? '');
  svg.append(path);
  return svg;
}

/** A button with an icon; its label is its accessible name and its tooltip. */
export function iconButton(name: string, label: string, onclick: () => void, text?: string): HTMLButtonElement {
  return h('button', { class: text ? 'button labelled' : 'button', type: 'button', title: label, onclick, aria: { label } },
    icon(name), text && h('span', {}, text));
}

export function field(label: string, control: HTMLElement, tip?: string): HTMLLabelElement {
  return h('label', { class: 'field', title: tip ?? '' }, h('span', { class: 'field-label' }, label), control);
}

export function select<T extends string>(label: string, options: readonly (readonly [T, string])[], value: T,
                                         change: (value: T) => void): HTMLSelectElement & { value: T } {
  const element = h('select', { aria: { label } },
    ...options.map(([v, text]) => h('option', { value: v, selected: v === value }, text))) as HTMLSelectElement & { value: T };
  element.addEventListener('change', () => change(element.value));
  return element;
}

export function toggle(label: string, on: boolean, change: (on: boolean) => void, tip?: string): HTMLButtonElement {
  return h('button', { class: on ? 'chip on' : 'chip', type: 'button', title: tip ?? '', onclick: () => change(!on),
    aria: { pressed: String(on) } }, label);
}

export function slider(label: string, value: number, [min, max]: [number, number], change: (value: number) => void): HTMLInputElement {
  const input = h('input', { type: 'range', min: String(min), max: String(max), step: 'any', value: String(value), aria: { label } });
  input.addEventListener('input', () => change(Number(input.value)));
  return input;
}
