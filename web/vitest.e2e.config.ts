import { availableParallelism } from 'node:os';
import { fileURLToPath } from 'node:url';

import { defineConfig } from 'vitest/config';

import { rhinoWithoutEval } from './plugins/rhino_without_eval.mjs';
import { reporting } from './vitest.results';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

// Each has a browser of its own.
const workers = Math.min(2, availableParallelism());
process.env.STUDIO_WORKERS = String(workers);

export default defineConfig({
  root: here('..'),
  cacheDir: here('node_modules/.vite'),
  server: { fs: { allow: [here('..')] } }, // the tests stand outside of this directory
  plugins: [rhinoWithoutEval({ forNode: true })],
  resolve: { alias: { '@knead': here('../bindings/npm/src'), '@studio': here('src'), 'playwright-core': here('node_modules/playwright-core') } },
  test: {
    ...reporting('studio_chromium'),
    globals: true,
    server: { deps: { inline: ['rhino3dm'] } },
    include: ['tests/web/e2e/*.test.ts'],
    globalSetup: here('../tests/web/e2e/setup.ts'),
    pool: 'forks',
    // Files share nothing but the modules that they read; longest first, by what they took last or by their size.
    poolOptions: { forks: { minForks: workers, maxForks: workers, isolate: false } },
    testTimeout: 120_000,
    hookTimeout: 120_000,
    // What is waited for comes late on a busy machine.
    expect: { poll: { timeout: 20_000 } },
  },
});
