#!/usr/bin/env bash
# Tests the studio: TypeScript and the WebAssembly session in node, then the page in headless Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh web
scripts/build.sh
scripts/studio.sh
cd web
npm run --silent test
npm run --silent e2e
