/** What the session says about itself: the JSON of bindings/wasm/studio_state.cpp. Lengths in file units. */

export type Vector3 = [number, number, number];

export interface Command {
  do: string;
  [field: string]: unknown;
}

export interface SurfaceInfo {
  id: string;
  name: string;
  unit: string;
  degree: [number, number];
  net: [number, number];
  rational: boolean;
  lower: Vector3;
  upper: Vector3;
  /** Coefficients 11, 12, 22; null where one varies over the surface. */
  alpha: (number | null)[];
  beta: (number | null)[];
  mass: number | null;
  damping: number | null;
  rest: 'shape' | 'none';
  hold: number;
  pins: number;
  /** The pinned control points, [i, j]. */
  pinned: [number, number][];
  constraints: Command[];
  moved: number;
}

/** A surface in full precision; control point (i, j) is number i · net[1] + j. */
export interface SurfaceNumbers {
  degree: [number, number];
  net: [number, number];
  knots_u: number[];
  knots_v: number[];
  weights: number[] | null;
  points: Vector3[];
}

export interface ToolInfo {
  name: string;
  shape: string;
  radius?: number;
  minor?: number;
  height?: number;
  top_radius?: number;
  rounding?: number;
  thickness?: number;
  sizes?: Vector3;
  semi_axes?: [number, number];
  exponents?: [number, number];
  mode: 'collision' | 'proximity' | 'imprint';
  stiffness: number;
  range: number;
  rigid: boolean;
  friction: number;
  plasticity: number;
  direction: 'pull' | 'push';
  position: Vector3;
  /** x, y, z, w */
  rotation: [number, number, number, number];
  scale: Vector3;
  size: number | null;
}

export interface StepInfo {
  time: number;
  energy: number;
  stretch: number;
  bend: number;
  kinetic: number;
  contact: number;
  residual: number;
  displacement: number;
  gap: number;
  violation: number;
  iterations: number;
  converged: boolean;
  limited: boolean;
  note: string;
}

export interface SessionInfo {
  name: string;
  fresh: boolean;
  selection: number[];
  surfaces: SurfaceInfo[];
  tools: ToolInfo[];
  forces: Command[];
  load: Command;
  evolve: { do: 'evolve'; mode: 'acm' | 'static' | 'dynamic'; lambda: number; time_step: number; weight: string };
  limit: number | null;
  raw: boolean;
  coupled: boolean;
  refine: 'auto' | 'never';
  seams: { continuity: string; gap: number; reason: string }[];
  notes: string[];
  steps: number;
  last: StepInfo | null;
  undo: boolean;
  redo: boolean;
}

/** What went wrong, where, and what would be right. */
export interface EngineErrorInfo {
  kind: string;
  what: string;
  where: string;
  remedy: string;
  message: string;
}

export class EngineError extends Error {
  constructor(readonly info: EngineErrorInfo) {
    super(info.message);
    this.name = 'EngineError';
  }
}

export const fields = ['none', 'deviation', 'mean', 'gaussian', 'gap', 'energy'] as const;
export type Field = (typeof fields)[number];

/** A surface to draw; positions relative to the session's origin. */
export interface Picture {
  surface: number;
  counts: [number, number];
  positions: Float32Array;
  normals: Float32Array;
  values: Float32Array;
  s: Float32Array;
  t: Float32Array;
  linesU: Uint32Array;
  linesV: Uint32Array;
  net: Float32Array;
  /** Per control point: 0 free, 1 does not move, 2 bound to others (pinned surface points, kept curves). */
  held: Uint8Array;
}

/** By the ids of the library's list of formats, `Engine.formats()`. */
export type MeshFormat = 'stl' | 'obj' | 'ply' | 'gltf';

/** A file format, as the library describes it. */
export interface FileFormat {
  id: string;
  name: string;
  endings: string[];
  media_type: string;
  content: 'surfaces' | 'triangles';
  holds: string;
  opens: boolean;
}
