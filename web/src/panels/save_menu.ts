import type { App } from './app';

/** Name, what it is, what it does. */
export const saveEntries = (app: App): [string, string, () => void][] => [
  ['STEP file', 'the file as it was opened, with the sculpted surfaces in it', () => void app.saving.step()],
  ['Rhino file', '.3dm: the one that was opened with the sculpted surfaces in it, or a new one', () => void app.saving.rhino()],
  ['Knead document', 'where it began and every command, to go on later', () => void app.saving.knead()],
  ['Mesh, STL', 'triangles as fine as the picture, for printing', () => void app.saving.mesh('stl')],
  ['Mesh, OBJ', 'the same as text, for other programs', () => void app.saving.mesh('obj')],
  ['Mesh, PLY', 'the same, binary', () => void app.saving.mesh('ply')],
  ['Mesh, glTF', 'a mesh per surface, in metres, for viewers and the web', () => void app.saving.mesh('gltf')],
  ['Script', 'the commands alone, for the command line', () => void app.saving.script()],
  ['Picture', 'the view as PNG, as it is on the screen', () => void app.saving.picture(1)],
  ['Picture, twice as large', 'the view as PNG, two pixels for one', () => void app.saving.picture(2)],
];
