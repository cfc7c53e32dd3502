/** The script that `knead snake` takes (docs/snakes.md), and what the panel says of its fields. */

export type Place = [number, number];

export interface ImageEnergy {
  smoothing: number;
  line: number;
  edge: number;
  termination: number;
  flow: number;
  flow_smoothness: number;
  flow_iterations: number;
  region: number;
  relative_region: boolean;
  distance: number;
}

export interface Settings {
  degree: number;
  control_points: number;
  units: number;
  alpha: number;
  beta: number;
  gamma: number;
  band: number;
  local: number;
  end_tension: number;
  redistribute: number;
  balloon: number;
  max_move: number;
  max_iterations: number;
  motion: number;
  refine: number;
  max_control_points: number;
}

export interface Spring {
  at: number;
  to: Place;
  strength: number;
}

export interface Volcano {
  at: Place;
  strength: number;
  radius: number;
}

export interface Start {
  shape: 'ellipse' | 'points';
  centre?: Place;
  radii?: Place;
  points?: Place[];
  closed?: boolean;
  hold_ends?: boolean;
  springs?: Spring[];
}

export interface Script {
  image: ImageEnergy;
  settings: Settings;
  mask: string;
  volcanoes: Volcano[];
  snakes: Start[];
}

/** As text, with the numbers that say something. */
export function scriptText({ image, settings, mask, volcanoes, snakes }: Script, spaces?: number): string {
  const all = { knead: 2, image, ...(mask ? { mask } : {}), settings: { ...settings, ...(volcanoes.length > 0 ? { volcanoes } : {}) }, snakes };
  return JSON.stringify(all, null, spaces);
}

export const noEnergy: ImageEnergy = { smoothing: 1, line: 0, edge: 0, termination: 0, flow: 0, flow_smoothness: 0.2, flow_iterations: 200, region: 0, relative_region: false, distance: 0 };

/** The parameter counts to 400 whatever the image's size, so that stretch and bend mean the same. */
const usual: Settings = {
  degree: 3, control_points: 40, units: 400, alpha: 1, beta: 300, gamma: 0.1, band: 0, local: 0.5, end_tension: 0, redistribute: 10, balloon: 0, max_move: 1, max_iterations: 2500,
  motion: 0.02, refine: 0, max_control_points: 1000,
};

export interface Preset {
  name: string;
  about: string;
  image: Partial<ImageEnergy>;
  settings: Partial<Settings>;
  /** Force per distance by which the hand draws. */
  spring: number;
  /** Force of a new volcano at its radius. */
  volcano: number;
}

export const presets: readonly Preset[] = [
  { name: 'Regions', about: 'Bright from dark: works from far away, for closed contours', image: { smoothing: 1, region: 1 }, settings: {}, spring: 0.3, volcano: 1 },
  { name: 'Edges', about: 'To the strongest edge nearby: start close to it', image: { smoothing: 3, edge: 1 }, settings: { units: 0, alpha: 0.015, beta: 10, gamma: 0.001, motion: 0.1 }, spring: 0.1, volcano: 0.02 },
  { name: 'Edges, from afar', about: 'The gradient vector flow points to edges from all around', image: { smoothing: 2, flow: 1 }, settings: { units: 0, alpha: 0.015, beta: 10, gamma: 0.5, motion: 0.05 }, spring: 1, volcano: 1 },
  { name: 'Bright lines', about: 'Along what is bright, as writing on a dark ground; a negative intensity follows dark lines', image: { smoothing: 1.5, line: 5 },
    settings: { units: 0, alpha: 0.01, beta: 0.1, gamma: 0.05, motion: 0.05 }, spring: 0.3, volcano: 0.3 },
];

export const presetOf = ({ image, settings }: Preset): { image: ImageEnergy; settings: Settings } => ({ image: { ...noEnergy, ...image }, settings: { ...usual, ...settings } });

export interface Field<K extends string> {
  key: K;
  label: string;
  about: string;
  /** Of whole numbers. */
  whole?: boolean;
}

/** What of the energy is a number. */
export type ImageNumber = Exclude<keyof ImageEnergy, 'relative_region'>;

export const imageFields: readonly Field<ImageNumber>[] = [
  { key: 'smoothing', label: 'Smoothing', about: 'σ of the Gaussian in pixels that the image is blurred with first. More of it drowns noise and reaches farther; less follows small things.' },
  { key: 'region', label: 'Regions', about: 'Grows over what is like the mean of its inside and retreats from what is like the outside (Chan and Vese). For closed snakes; reaches across the image.' },
  { key: 'edge', label: 'Edges', about: 'Weight of the slope of the brightness: draws to strong edges within about two σ. Negative: away from edges.' },
  { key: 'flow', label: 'Edges, from afar', about: 'Weight of the gradient vector flow (Xu and Prince): the direction to edges, carried far from them and into hollows.' },
  { key: 'line', label: 'Intensity', about: 'Weight of the brightness itself: positive is drawn to bright lines, negative to dark ones.' },
  { key: 'termination', label: 'Corners', about: 'Weight of the curvature of lines of equal brightness: draws to corners and ends of lines.' },
  { key: 'distance', label: 'Mask', about: 'Weight of the nearness to the white of a mask image, which is to be opened first.' },
];

export const moreImageFields: readonly Field<ImageNumber>[] = [
  { key: 'flow_smoothness', label: 'Flow smoothness', about: 'μ of the gradient vector flow: more spreads it farther and smooths it, as noise asks for.' },
  { key: 'flow_iterations', label: 'Flow iterations', about: 'Of the gradient vector flow: it reaches about so many pixels at most.', whole: true },
];

export const snakeFields: readonly Field<keyof Settings>[] = [
  { key: 'alpha', label: 'Stretch α', about: 'Resists being stretched: more makes the contour shorter. Counted in the unit of the parameter.' },
  { key: 'beta', label: 'Bend β', about: 'Resists being bent: more makes it rounder, and keeps it from crossing itself.' },
  { key: 'balloon', label: 'Balloon', about: 'Pressure outwards on closed snakes; negative shrinks them. It carries them over what is weak on their way.' },
  { key: 'gamma', label: 'Viscosity γ', about: 'Force per speed: more makes it slower and steadier. It rises by itself where a snake turns to and fro.' },
  { key: 'control_points', label: 'Control points', about: 'Of each snake. Few make it smooth and fast, many let it follow small things.', whole: true },
];

export const moreFields: readonly Field<keyof Settings>[] = [
  { key: 'degree', label: 'Degree', about: 'Of the B-spline, 2 to 7.', whole: true },
  { key: 'units', label: 'Parameter length', about: 'What the parameter counts to, and with it stretch and bend. 0: the length of the start in pixels.' },
  { key: 'band', label: 'Band', about: 'Width in pixels of the outside that the regions are compared with. 0: all of the image.' },
  { key: 'local', label: 'Local outside', about: 'With a band: the share of the outside that each place takes along its own normal alone, 0 to 1. Keeps a snake from flowing over a bridge to its neighbour.' },
  { key: 'max_move', label: 'Largest move', about: 'Pixels that a control point moves in an iteration at most.' },
  { key: 'motion', label: 'Rest below', about: 'A snake rests when its control points are within so many pixels of where they were ten iterations ago.' },
  { key: 'max_iterations', label: 'Iterations', about: 'After so many a snake ends, at rest or not; Run lets it make as many more.', whole: true },
  { key: 'refine', label: 'Refine', about: 'Once it rests, spans are halved where that changes the contour by more than so many pixels. 0: never.' },
  { key: 'max_control_points', label: 'Refine up to', about: 'So many control points, of each snake.', whole: true },
  { key: 'redistribute', label: 'Spread evenly', about: 'After so many iterations a closed snake that is stretched unevenly is spread evenly along itself. 0: never.', whole: true },
  { key: 'end_tension', label: 'End tension', about: 'Of open snakes whose ends are free: the share of their first stretch that pulls the ends outwards. 0: they shrink, 1: they keep their length.' },
];

/** Of the places of a stroke those that are at least `apart` from the one before, and the last. */
export function thinned(places: readonly Place[], apart: number): Place[] {
  const kept: Place[] = [];
  for (const p of places) {
    const last = kept.at(-1);
    if (!last || Math.hypot(p[0] - last[0], p[1] - last[1]) >= apart) kept.push(p);
  }
  const last = places.at(-1), end = kept.at(-1);
  if (last && end && (last[0] !== end[0] || last[1] !== end[1])) kept.push(last);
  return kept.map(([x, y]) => [Math.round(100 * x) / 100, Math.round(100 * y) / 100]);
}
