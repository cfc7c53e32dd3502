#!/usr/bin/env bash
# Builds the studio and times its steps, in node and in headless Chromium, and the first stroke of a fresh page.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh web
scripts/studio.sh
node web/bench/steps.mjs
node web/bench/browser.mjs
node web/bench/first.mjs
