/** What the session says about itself. Lengths in file units. */
import type { AnyCommand, EngineErrorInfo, fileFormats } from './generated';

// Made by the build from the engine's own descriptions (scripts/studio.sh).
export type { EngineErrorInfo, SessionInfo, StepInfo, SurfaceInfo, ToolInfo } from './generated';

export type Vector3 = [number, number, number];

/** What the session can be asked to do. */
export type Command = AnyCommand;

/** A surface in full precision; control point (i, j) is number i · net[1] + j. */
export interface SurfaceNumbers {
  degree: [number, number];
  net: [number, number];
  knots_u: number[];
  knots_v: number[];
  weights: number[] | null;
  points: Vector3[];
}

export class EngineError extends Error {
  constructor(readonly info: EngineErrorInfo) {
    super(info.message);
    this.name = 'EngineError';
  }
}

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

/** Coefficients of a material, as commands name them, in the order of the session. */
export const coefficients = ['alpha11', 'alpha12', 'alpha22', 'beta11', 'beta12', 'beta22'] as const;
export type Coefficient = (typeof coefficients)[number];

/** A material by samples over the domain: (i, j) is sample i counts[1] + j, at fractions i / (counts[0] - 1), j / (counts[1] - 1). */
export interface MaterialSamples {
  counts: [number, number];
  values: Record<Coefficient, Float64Array>;
}

/** The shape of a tool as triangles in its own frame, unscaled. */
export interface ToolPicture {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** Both of its sides can be seen. */
  open: boolean;
  /** A square of side 1 stands for all of a plane. */
  unbounded: boolean;
}

/** Ids of the formats of triangles, by the library's list of formats. */
export type MeshFormat = Extract<(typeof fileFormats)[number], { content: 'triangles' }>['id'];

