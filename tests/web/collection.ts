import { existsSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../..', import.meta.url));

/** The folder of files of other systems, which is no part of the project: KNEAD_SHARED, or `shared` beside the project if that is not set; empty: none. */
const folder = process.env.KNEAD_SHARED === undefined ? join(root, '../shared') : process.env.KNEAD_SHARED && resolve(root, process.env.KNEAD_SHARED);

/** A CAD file of the collection, or the folder of all without a name; null where it is missing. */
export function collected(name = ''): string | null {
  const path = join(folder, 'data/cad', name);
  return folder !== '' && existsSync(path) ? path : null;
}
