#!/usr/bin/env bash
# Builds the command line and sculpts the sample bonnet with it; the results go to out/. Then builds the studio and serves
# it on the loopback address until it is interrupted; SERVE=0 leaves that out.
set -euo pipefail
cd "$(dirname "$0")/.."

echo "run: building the command line (a first time takes some minutes)"
scripts/build.sh
mkdir -p out
build/release/knead sculpt samples/bonnet.step -o out/bonnet-sculpted.step --script samples/bonnet.json \
  --report out/bonnet-report.json --picture out/bonnet-displacement.svg

[ "${SERVE:-1}" != 0 ] || exit 0
echo "run: the results are in out/; now building the studio (a first time takes some minutes), then serving it"
scripts/studio.sh
exec node web/serve.mjs
