#!/usr/bin/env bash
# Writes the tables of commands in docs/scripts.md anew, from what the engine says of them.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
scripts/configure.sh release
cmake --build build/release --target knead_cli
page=docs/scripts.md
written=$(mktemp)
awk '
  /^<!-- fields of / { print; system("build/release/knead commands " $4 " --table"); skip = 1; next }
  /^<!-- end of fields -->/ { skip = 0 }
  !skip
' "$page" >"$written"
cmp -s "$written" "$page" || cp "$written" "$page"
rm "$written"
