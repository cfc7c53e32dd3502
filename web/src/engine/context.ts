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

/** Takes apart the bytes of bindings/wasm/studio_context.hpp; null where there is nothing. */
export function readContext(bytes: Uint8Array): Context | null {
  if (bytes.length < 8) return null;
  const buffer = bytes.slice().buffer as ArrayBuffer;
  const [points, triangles] = new Uint32Array(buffer, 0, 2) as unknown as [number, number];
  let at = 8;
  const floats = () => {
    const array = new Float32Array(buffer, at, 3 * points);
    at += array.byteLength;
    return array;
  };
  const positions = floats();
  const normals = floats();
  const indices = new Uint32Array(buffer, at, 3 * triangles);
  at += indices.byteLength;
  const skipped = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, at))) as Context['skipped'];
  return { positions, normals, indices, skipped };
}
