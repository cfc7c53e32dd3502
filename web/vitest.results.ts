import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import type { ViteUserConfig } from 'vitest/config';

type Reporting = Pick<NonNullable<ViteUserConfig['test']>, 'reporters'>;

/** Where KNEAD_TEST_RESULTS names a folder, a run also writes what it found there: `NAME.json`, as Vitest's JSON reporter does. */
export function reporting(name: string): Reporting {
  const folder = process.env.KNEAD_TEST_RESULTS;
  if (!folder) return { reporters: ['default'] };
  const outputFile = join(resolve(fileURLToPath(new URL('..', import.meta.url)), folder), `${name}.json`);
  return { reporters: ['default', ['json', { outputFile }]] };
}
