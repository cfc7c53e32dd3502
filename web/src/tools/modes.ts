/** What the pointer does. */
export type Mode =
  | 'look' | 'push' | 'pull' | 'smooth' | 'grab' | 'brush' | 'points' | 'place' | 'pin' | 'freeze' | 'material' | 'edges' | 'measure';

/** Mode, what it does, key. */
export const modes: readonly (readonly [Mode, string, string])[] = [
  ['look', 'Look and select (V)', 'v'],
  ['push', 'Push: a ball into the clay (B). Alt pulls, Shift smooths', 'b'],
  ['pull', 'Pull: a ball from behind (U). Alt pushes, Shift smooths', 'u'],
  ['smooth', 'Smooth what is under the brush (S)', 's'],
  ['grab', 'Grab a point of the surface and drag it (G)', 'g'],
  ['brush', 'Brushes: inflate, flatten, pinch, crease, twist, mask and more (W)', 'w'],
  ['points', 'Control points: pick, drag, type (E)', 'e'],
  ['place', 'Place a tool (T)', 't'],
  ['pin', 'Pin: paint over control points, click points of the surface (P). Alt frees', 'p'],
  ['freeze', 'Freeze: paint what may not move (I). Alt thaws', 'i'],
  ['material', 'Paint another material (A)', 'a'],
  ['edges', 'Edges: click one to hold it (D)', 'd'],
  ['measure', 'Measure distances, angles and radii (Q)', 'q'],
];

export const brushModes: readonly Mode[] = ['push', 'pull', 'smooth', 'grab'];
export const paintModes: readonly Mode[] = ['pin', 'freeze', 'material'];
