#!/usr/bin/env bash
# Formats every tracked or new C++ source, or with --check fails where one is not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh format
mode=(-i)
[ "${1:-}" != --check ] || mode=(--dry-run --Werror)
git ls-files -z --cached --others --exclude-standard -- '*.hpp' '*.cpp' | xargs -0 -r clang-format "${mode[@]}"
