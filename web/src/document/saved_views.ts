/** A view that the user keeps with the document; lengths in file units, from the file's origin. */
export interface SavedView {
  name: string;
  position: [number, number, number];
  target: [number, number, number];
  /** What is upwards on the screen. */
  up: [number, number, number];
  /** What is seen of the plane through the target. */
  height: number;
  parallel: boolean;
}

const isPlace = (x: unknown): boolean => Array.isArray(x) && x.length === 3 && x.every((c) => typeof c === 'number' && Number.isFinite(c));

/** Throws an Error whose message says which view is wrong. */
export function readViews(views: unknown): SavedView[] {
  if (!Array.isArray(views)) throw new Error('"views": this is no list');
  return views.map((view: unknown, k): SavedView => {
    const v = (typeof view === 'object' && view !== null ? view : {}) as Record<string, unknown>;
    const wrong = (field: string, right: string) => new Error(`views[${k}].${field}: write ${right}`);
    if (typeof v.name !== 'string' || v.name === '') throw wrong('name', 'a name');
    for (const field of ['position', 'target', 'up']) if (!isPlace(v[field])) throw wrong(field, 'three numbers');
    if (String(v.position) === String(v.target)) throw wrong('position', 'a place other than the target');
    if (typeof v.height !== 'number' || !(v.height > 0 && v.height < Infinity)) throw wrong('height', 'a number > 0');
    if (typeof v.parallel !== 'boolean') throw wrong('parallel', 'true or false');
    const { name, position, target, up, height, parallel } = v as unknown as SavedView;
    return { name, position, target, up, height, parallel };
  });
}
