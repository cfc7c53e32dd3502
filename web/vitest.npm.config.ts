import { fileURLToPath } from 'node:url';

import { defineConfig } from 'vitest/config';

import { reporting } from './vitest.results';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

// The npm package as it is packed (scripts/npm.sh), in a fresh directory.
export default defineConfig({
  root: here('..'),
  cacheDir: here('node_modules/.vite'),
  server: { fs: { allow: [here('..')] } },
  resolve: { alias: { 'playwright-core': here('node_modules/playwright-core'), 'esbuild': here('node_modules/esbuild'), 'vite': here('node_modules/vite') } },
  test: {
    ...reporting('npm'), globals: true, include: ['tests/npm/*.test.ts'], globalSetup: here('../tests/npm/setup.ts'), testTimeout: 120_000, hookTimeout: 120_000,
    pool: 'forks', poolOptions: { forks: { minForks: 2, maxForks: 2 } }, // they wait more than they compute
  },
});
