import type { Assembly } from '../engine/context';

/** A product of an assembly. Products of one name within the same one are one node, which counts them. */
export interface AssemblyNode {
  name: string;
  within: Map<string, AssemblyNode>;
  /** Parts with geometry of their own that stand here: numbers of parts and of their places. */
  places: { part: number; place: number }[];
}

const node = (name: string): AssemblyNode => ({ name, within: new Map(), places: [] });

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
