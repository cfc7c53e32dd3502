import type { DisplayInfo, SettingValue } from '../engine/displays';
import type { Convention } from './conventions';
import type { Look } from './looks';
import type { ViewName } from './viewport';

/** What is shown and how; kept in the browser between visits. */
export interface Display {
  surface: boolean;
  isocurves: boolean;
  knotLines: boolean;
  net: boolean;
  points: boolean;
  normals: boolean;
  grid: boolean;
  /** The other faces of the file. */
  context: boolean;
  /** Only the parts of surfaces that the faces of the file show. */
  trimmed: boolean;
  /** What a surface without colours is made of. */
  look: Look;
  /** In place of look and colours. */
  stripes: 'none' | 'zebra' | 'highlight';
  /** Of stripes, degrees: how they are turned about the line of sight (zebra) or about z, and how far apart they are. */
  stripeAngle: number;
  stripeSpacing: number;
  /** Cuts across an axis of the file, drawn as lines. */
  sections: 'none' | 'x' | 'y' | 'z';
  /** File units, from the file's origin; 0: a round length that follows from the size. */
  sectionSpacing: number;
  /** Curvature combs of the selected surfaces, on curves along which u runs, v, or both; or where sections cut. */
  combs: 'none' | 'u' | 'v' | 'both' | 'sections';
  combCurves: number;
  /** Pieces of every knot span. */
  combTeeth: number;
  /** Length of a tooth of the largest curvature, of the size of what is shown. */
  combScale: number;
  /** What stands out is brightened, what lies in a hollow darkened. */
  relief: boolean;
  /** The back of surfaces is tinted. */
  sides: boolean;
  /** Normals point the other way, to the eye. */
  flipped: boolean;
  /** What colours the surfaces; null: nothing. */
  colour: DisplayInfo | null;
  /** The user's settings of displays, by their names. */
  colourSettings: Record<string, Record<string, SettingValue>>;
  /** Values of full colour, below and above. */
  limits: [number, number];
  /** The limits follow from the values or the display. */
  autoLimits: boolean;
  pointSize: number;
  fourViews: boolean;
  /** Which view is shown if there are not four. */
  view: ViewName;
  /** The free view is a parallel projection. */
  parallel: boolean;
  /** What the mouse does to a view. */
  convention: Convention;
  detail: number;
}

export const defaultDisplay: Display = {
  surface: true,
  isocurves: true,
  knotLines: false,
  net: false,
  points: false,
  normals: false,
  grid: true,
  context: true,
  trimmed: true,
  look: 'studio',
  stripes: 'none',
  stripeAngle: 0,
  stripeSpacing: 15,
  sections: 'none',
  sectionSpacing: 0,
  combs: 'none',
  combCurves: 7,
  combTeeth: 6,
  combScale: 0.15,
  relief: true,
  sides: false,
  flipped: false,
  colour: null,
  colourSettings: {},
  limits: [-1, 1],
  autoLimits: true,
  pointSize: 4,
  fourViews: false,
  view: 'perspective',
  parallel: false,
  convention: 'knead',
  detail: 96,
};

/** Up to which magnitude the values of the colours are neutral; 0: only zero is. */
export function toleranceOf({ colour, colourSettings }: Display): number {
  if (!colour?.tolerance) return 0;
  const value = colourSettings[colour.name]?.[colour.tolerance];
  return typeof value === 'number' ? Math.abs(value) : 0;
}

export interface Palette {
  background: number;
  front: number;
  back: number;
  isocurve: number;
  isocurveOpacity: number;
  section: number;
  comb: number;
  knotLine: number;
  net: number;
  point: number;
  held: number;
  grid: number;
  gridStrong: number;
  tool: number;
  toolSelected: number;
  context: number;
}

export type Theme = 'light' | 'dark';

export const palettes: Record<Theme, Palette> = {
  dark: {
    background: 0x15181c, front: 0xa9bccd, back: 0xb8a08a, isocurve: 0x0d1116, isocurveOpacity: 0.38, section: 0xb3261e, comb: 0xf0a35a, knotLine: 0xe8eef4,
    net: 0x8fa3b5, point: 0xe6edf3, held: 0xf0a35a, grid: 0x252a31, gridStrong: 0x363d47, tool: 0x8b97a5,
    toolSelected: 0x3fb6a8, context: 0x596069,
  },
  light: {
    background: 0xf1f3f5, front: 0xb4c4d3, back: 0xc9b29d, isocurve: 0x1a2733, isocurveOpacity: 0.3, section: 0xb3261e, comb: 0x9a3412, knotLine: 0x14202b,
    net: 0x5b6b7a, point: 0x1d2a36, held: 0xc8641a, grid: 0xdfe3e7, gridStrong: 0xc6ccd3, tool: 0x7b8794,
    toolSelected: 0x0f8f82, context: 0xb9bec4,
  },
};
