#!/usr/bin/env bash
# Builds the whole library for WebAssembly: build/wasm/libknead.a and src/image/libknead_image.a
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh wasm
scripts/configure.sh wasm
cmake --build build/wasm
