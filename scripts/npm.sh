#!/usr/bin/env bash
# Packs the engine as the npm package knead-cad: out/dist/knead-cad-VERSION.tgz
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/engine.sh
node bindings/npm/build.mjs build/wasm/bindings/wasm/knead_studio.wasm out/npm/knead-cad
mkdir -p out/dist
(cd out/npm/knead-cad && npm pack --silent --pack-destination ../../dist)
