#!/usr/bin/env bash
# Builds the studio, static files that any host can serve: web/dist
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/engine.sh knead_lab knead_snake
for module in engine/knead_studio panels/lab/knead_lab panels/snakes/knead_snake; do
  built=build/wasm/bindings/wasm/${module##*/}.wasm
  cmp -s "$built" "web/src/$module.wasm" || cp "$built" "web/src/$module.wasm"
done
cd web
inputs=(index.html package-lock.json vite.config.ts tsconfig.json src public ../bindings/npm/src ../samples/bonnet.step)
# The engine in two modules; what a session calls first is what the page loads first.
engine=src/engine
if [ ! -f $engine/knead_core.wasm ] || [ -n "$(find $engine/knead_studio.wasm scripts/split.mjs -newer $engine/knead_core.wasm -print -quit)" ]; then
  node scripts/split.mjs $engine/knead_studio.wasm $engine/knead_core.wasm $engine/knead_rest.wasm
fi
if [ ! -f dist/index.html ] || [ -n "$(find "${inputs[@]}" -newer dist/index.html -print -quit)" ]; then
  npm run --silent build
  node scripts/pack.mjs dist
fi
