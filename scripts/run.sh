#!/usr/bin/env bash
# Builds the command line and sculpts the sample bonnet with it. The results go to out/.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh
mkdir -p out
build/release/knead sculpt samples/bonnet.step -o out/bonnet-sculpted.step --script samples/bonnet.json \
  --report out/bonnet-report.json --picture out/bonnet-displacement.svg
