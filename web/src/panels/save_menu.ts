import { fileFormats } from '@knead/generated';
import type { App } from './app';

const meshFormats = fileFormats.filter((format) => format.content === 'triangles');

/** The entry that is there while a file of the disk is open. */
export const samePlace = 'Same file';

/** The entry that is there while a Rhino file is open. */
export const otherKind = 'STEP file';

/** Name, description, action. */
export const saveEntries = (app: App): [string, string, () => void][] => [
  [samePlace, 'the one that was opened, on the disk, with the sculpted surfaces in it', () => void app.saving.inPlace()],
  ['CAD file', 'the file as it was opened, with the sculpted surfaces in it; a new one is STEP', () => void app.saving.copy()],
  [otherKind, 'the sculpted surfaces alone, for other CAD programs', () => void app.saving.step()],
  ['Rhino file', '.3dm: the one that was opened with the sculpted surfaces in it, or a new one', () => void app.saving.rhino()],
  ['Knead document', 'where it began and every command, to go on later', () => void app.saving.knead()],
  ...meshFormats.map(({ id, name, holds }): [string, string, () => void] => [`Mesh, ${name}`, holds, () => void app.saving.mesh(id)]),
  ['Script', 'the commands alone, for the command line', () => void app.saving.script()],
  ['Picture', 'the view as PNG, as it is on the screen', () => void app.saving.picture(1)],
  ['Picture, twice as large', 'the view as PNG, two pixels for one', () => void app.saving.picture(2)],
];
