#!/usr/bin/env bash
# Tests the npm package alone, as `make test` does: its tarball, in a fresh directory, in node and in headless Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh web
scripts/build.sh
scripts/npm.sh
cd web
npm run --silent package
