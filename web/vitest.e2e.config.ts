import { availableParallelism } from 'node:os';
import { basename } from 'node:path';
import { fileURLToPath } from 'node:url';

import { defineConfig } from 'vitest/config';
import { BaseSequencer, type TestSpecification } from 'vitest/node';

import { rhinoWithoutEval } from './plugins/rhino_without_eval.mjs';
import { reporting } from './vitest.results';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

/** Begun first, so that the workers end together. */
const longest = ['brushes', 'studio', 'hand', 'groove', 'random', 'appearance', 'documents', 'analysis', 'across'];

class LongestFirst extends BaseSequencer {
  override async sort(files: TestSpecification[]): Promise<TestSpecification[]> {
    const rank = ({ moduleId }: TestSpecification) => (longest.indexOf(basename(moduleId, '.test.ts')) + longest.length + 1) % (longest.length + 1);
    return [...files].sort((a, b) => rank(a) - rank(b));
  }
}

// More browsers than cores that draw by software hinder each other.
const workers = Math.min(2, availableParallelism());
process.env.STUDIO_WORKERS = String(workers);

export default defineConfig({
  root: here('..'),
  cacheDir: here('node_modules/.vite'),
  server: { fs: { allow: [here('..')] } }, // the tests stand outside of this directory
  plugins: [rhinoWithoutEval({ forNode: true })],
  resolve: { alias: { '@studio': here('src'), 'playwright-core': here('node_modules/playwright-core') } },
  test: {
    ...reporting('studio_chromium'),
    globals: true,
    server: { deps: { inline: ['rhino3dm'] } },
    include: ['tests/web/e2e/*.test.ts'],
    globalSetup: here('../tests/web/e2e/setup.ts'),
    pool: 'forks',
    poolOptions: { forks: { minForks: workers, maxForks: workers } },
    sequence: { sequencer: LongestFirst },
    testTimeout: 120_000,
    hookTimeout: 120_000,
    // What is waited for comes late on a busy machine.
    expect: { poll: { timeout: 20_000 } },
  },
});
