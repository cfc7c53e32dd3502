import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  root: here('..'),
  cacheDir: here('node_modules/.vite'),
  resolve: { alias: { '@studio': here('src'), three: here('node_modules/three') } },
  test: { globals: true, include: ['tests/web/*.test.ts'], exclude: ['**/e2e/**'], testTimeout: 60_000 },
});
