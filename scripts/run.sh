#!/usr/bin/env bash
# Builds the command line and sculpts the sample bonnet with it; the results go to out/. Then builds the studio and serves
# it on the loopback address until it is interrupted; SERVE=0 leaves that out.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh
mkdir -p out
build/release/knead sculpt samples/bonnet.step -o out/bonnet-sculpted.step --script samples/bonnet.json \
  --report out/bonnet-report.json --picture out/bonnet-displacement.svg

[ "${SERVE:-1}" != 0 ] || exit 0
scripts/studio.sh
exec node web/serve.mjs
