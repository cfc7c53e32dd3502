#!/usr/bin/env bash
# Installs the Debian packages a goal needs, and only those that are missing.
#   scripts/setup.sh build | test | sanitizers | bench | instructions | format | lint | wasm | studio | web
set -euo pipefail

build=(g++ cmake ninja-build libeigen3-dev libfmt-dev nlohmann-json3-dev libcli11-dev libpng-dev libjpeg62-turbo-dev)
# The benchmarks are built with the tests, so that they keep compiling. OCCT is the oracle the tests compare STEP files
# with; the product does not use it.
tests=(libgtest-dev libgmp-dev libbenchmark-dev libocct-data-exchange-dev)
# Address and undefined-behaviour sanitizers by a second compiler; llvm names the functions in their reports.
sanitizers=(clang-19 libclang-rt-19-dev llvm-19)
# What benchmarks measure beside the library.
peers=(libocct-data-exchange-dev libsuitesparse-dev)
# The library for WebAssembly, and node to run it.
wasm=(clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 wasi-libc nodejs)
# The studio is built by node's tools, whose versions are those of web/package-lock.json. Node from elsewhere brings npm.
# wasm-split of binaryen takes the engine apart.
studio=("${wasm[@]}" binaryen)
command -v npm >/dev/null || studio+=(npm)
# And tested in a real browser.
web=("${build[@]}" "${studio[@]}" chromium)

case "${1:-}" in
  build) needed=("${build[@]}") ;;
  test) needed=("${build[@]}" "${tests[@]}") ;;
  sanitizers) needed=("${build[@]}" "${tests[@]}" "${sanitizers[@]}") ;;
  bench) needed=("${build[@]}" libbenchmark-dev "${peers[@]}") ;;
  instructions) needed=("${build[@]}" libbenchmark-dev valgrind) ;;
  format) needed=(clang-format) ;;
  wasm) needed=("${build[@]}" "${wasm[@]}") ;;
  studio) needed=("${build[@]}" "${studio[@]}") ;;
  web) needed=("${web[@]}") ;;
  lint) needed=("${build[@]}" "${tests[@]}" clang-tidy-19) ;;
  *) echo "usage: scripts/setup.sh build|test|sanitizers|bench|instructions|format|lint|wasm|studio|web" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: this is no Debian system; these packages, by Debian's names, must be there: ${needed[*]}" >&2
  exit 0
fi

missing=()
for package in "${needed[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

install=(apt-get install -y --no-install-recommends "${missing[@]}")
if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=(sudo)
else
  echo "setup: packages are missing and this user can neither be root nor use sudo. As root, run:" >&2
  echo "  ${install[*]}" >&2
  exit 1
fi

echo "setup: installing ${missing[*]}"
# Package lists are fetched only where the present ones do not lead to every package.
if ! apt-get install -s --no-install-recommends "${missing[@]}" >/dev/null 2>&1; then
  "${as_root[@]}" apt-get update -q
fi
install_now() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" </dev/null; }
# Lists may be old enough to name versions that the mirror no longer holds.
install_now || { "${as_root[@]}" apt-get update -q && install_now; }
