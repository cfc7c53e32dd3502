#!/usr/bin/env bash
# Takes the pictures of the studio in docs/pictures from the real page.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh web
scripts/studio.sh
node web/pictures.mjs
