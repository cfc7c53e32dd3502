#!/usr/bin/env bash
# Builds the engine for WebAssembly, its types, and the tools of web/package-lock.json: what the studio and the npm package stand on.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh studio
scripts/configure.sh wasm
cmake --build build/wasm --target knead_studio knead_types "$@"
node web/scripts/types.mjs build/wasm/bindings/wasm/knead_types.wasm bindings/npm/src/generated.ts web/src/panels/help/generated.ts

cd web
# What the lock file names, and again only when it changes.
if ! cmp -s package-lock.json node_modules/.installed; then
  npm ci --no-audit --no-fund --loglevel=error
  cp package-lock.json node_modules/.installed
fi
