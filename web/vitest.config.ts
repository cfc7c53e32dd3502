import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

import { rhinoWithoutEval } from './plugins/rhino_without_eval.mjs';
import { reporting } from './vitest.results';

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  root: here('..'),
  cacheDir: here('node_modules/.vite'),
  server: { fs: { allow: [here('..')] } }, // the tests stand outside of this directory
  plugins: [rhinoWithoutEval({ forNode: true })],
  resolve: { alias: { '@knead': here('../bindings/npm/src'), '@studio': here('src'), three: here('node_modules/three'), typescript: here('node_modules/typescript/lib/typescript.js') } },
  test: {
    ...reporting('studio_node'),
    globals: true, server: { deps: { inline: ['rhino3dm'] } }, include: ['tests/web/*.test.ts'], exclude: ['**/e2e/**'], testTimeout: 60_000,
  },
});
