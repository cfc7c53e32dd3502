#!/usr/bin/env bash
# Builds the studio, static files that any host can serve: web/dist
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh studio
scripts/configure.sh wasm
cmake --build build/wasm --target knead_studio knead_lab knead_snake knead_types
for module in engine/knead_studio panels/lab/knead_lab panels/snakes/knead_snake; do
  built=build/wasm/bindings/wasm/${module##*/}.wasm
  cmp -s "$built" "web/src/$module.wasm" || cp "$built" "web/src/$module.wasm"
done
node web/scripts/types.mjs build/wasm/bindings/wasm/knead_types.wasm web/src/engine/generated.ts

cd web
# What the lock file names, and again only when it changes.
if ! cmp -s package-lock.json node_modules/.installed; then
  npm ci --no-audit --no-fund --loglevel=error
  cp package-lock.json node_modules/.installed
fi
inputs=(index.html package-lock.json vite.config.ts tsconfig.json src public ../samples/bonnet.step)
# The engine in two modules; what a session calls first is what the page loads first.
engine=src/engine
if [ ! -f $engine/knead_core.wasm ] || [ -n "$(find $engine/knead_studio.wasm scripts/split.mjs -newer $engine/knead_core.wasm -print -quit)" ]; then
  node scripts/split.mjs $engine/knead_studio.wasm $engine/knead_core.wasm $engine/knead_rest.wasm
fi
if [ ! -f dist/index.html ] || [ -n "$(find "${inputs[@]}" -newer dist/index.html -print -quit)" ]; then
  npm run --silent build
  node scripts/pack.mjs dist
fi
