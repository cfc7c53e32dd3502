import type { Assembly, Part } from '../engine/context';

/** A product of an assembly. Products of one name within the same one are one node, which counts them. */
export interface AssemblyNode {
  name: string;
  within: Map<string, AssemblyNode>;
  /** Parts with geometry of their own that stand here: numbers of parts and of their places. */
  places: { part: number; place: number }[];
}

const node = (name: string): AssemblyNode => ({ name, within: new Map(), places: [] });

/** The names of a part's places, as commands and `knead info` have them: those that are equal are counted from the second on. */
export function placeNames({ places }: Part): string[] {
  const known = new Map<string, number>();
  return places.map(({ path }) => {
    const count = (known.get(path) ?? 0) + 1;
    known.set(path, count);
    return count === 1 ? path : `${path}:${count}`;
  });
}

/** The product tree, from the paths of all places. */
export function assemblyTree({ parts }: Assembly): AssemblyNode {
  const root = node('');
  parts.forEach(({ name, places }, part) => places.forEach(({ path }, place) => {
    const names = path === '' ? [name] : path.split('/');
    let at = root;
    for (const each of names) {
      if (!at.within.has(each)) at.within.set(each, node(each));
      at = at.within.get(each)!;
    }
    at.places.push({ part, place });
  }));
  return root;
}
