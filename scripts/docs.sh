#!/usr/bin/env bash
# Writes the tables of rooms anew, from src/rooms.txt, and those of commands in docs/scripts.md, from what the engine says of them.
set -euo pipefail
cd "$(dirname "$0")/.."

written=$(mktemp)
rewrite() {  # rewrite PAGE PROGRAM: by awk
  awk "$2" "$1" >"$written"
  cmp -s "$written" "$1" || cp "$written" "$1"
}
for page in README.md CONTRIBUTING.md; do
  rewrite $page '
    /^<!-- rooms -->/ {
      print "<!-- rooms -->\n| room | what lives there |\n|---|---|"
      while ((getline line < "src/rooms.txt") > 0)
        if (line ~ /^[a-z]+: /) { sub(/: /, "` | ", line); print "| `" line " |" }
      skip = 1
    }
    /^<!-- end of rooms -->/ { skip = 0 }
    !skip
  '
done

scripts/setup.sh build
scripts/configure.sh release
cmake --build build/release --target knead_cli
rewrite docs/scripts.md '
  /^<!-- fields of / { print; system("build/release/knead commands " $4 " --table"); skip = 1; next }
  /^<!-- end of fields -->/ { skip = 0 }
  !skip
'
rm "$written"
