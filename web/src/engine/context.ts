/** What stands round the surfaces: the triangles of the other faces of the file, relative to the session's origin. */
export interface Context {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** Faces that could not be made triangles, and why. */
  skipped: { id: string; reason: string }[];
}

/** Of each face of a surface its loops, s and t in turn: it shows what an odd number of them encloses. Null: all. */
export type Trim = { faces: number[][][] } | null;
