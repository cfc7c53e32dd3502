import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, relative, sep } from 'node:path';

/** All files below a directory, as paths with slashes. */
function filesOf(directory) {
  return readdirSync(directory, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => relative(directory, join(entry.parentPath ?? entry.path, entry.name)).split(sep).join('/'))
    .sort();
}

/**
 * Vite plugin: writes the hashes of all files of the build into the service worker.
 * \param lazy which of them are kept only when they are first used.
 */
export const offline = ({ lazy }) => ({
  name: 'offline',
  apply: 'build',
  writeBundle({ dir }) {
    const worker = join(dir, 'service-worker.js');
    const files = {};
    for (const path of filesOf(dir)) {
      if (path !== 'service-worker.js') files[path] = createHash('sha256').update(readFileSync(join(dir, path))).digest('hex');
    }
    const text = JSON.stringify(files);
    const manifest = { version: createHash('sha256').update(text).digest('hex').slice(0, 16), files, lazy: Object.keys(files).filter((path) => lazy.test(path)) };
    const code = readFileSync(worker, 'utf8');
    const filled = code.replace(/(["'`])"KNEAD FILES"\1/, () => JSON.stringify(JSON.stringify(manifest)));
    if (filled === code) throw new Error('the service worker has no place for the files');
    writeFileSync(worker, filled);
  },
});
