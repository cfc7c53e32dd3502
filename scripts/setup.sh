#!/usr/bin/env bash
# Installs the Debian packages a goal needs, and only those that are missing.
#   scripts/setup.sh build | python | test | notebook | sanitizers | bench | instructions | format | lint | wasm | studio | web
set -euo pipefail

build=(g++ cmake ninja-build libeigen3-dev libfmt-dev nlohmann-json3-dev libcli11-dev libpng-dev libjpeg-dev zlib1g-dev)
# The benchmarks are built with the tests, so that they keep compiling. OCCT is the oracle the tests compare STEP files
# with; the product does not use it.
tests=(libgtest-dev libgmp-dev libbenchmark-dev libocct-data-exchange-dev)
# The Python package; the tests of it need SciPy, make environments and check types.
python=("${build[@]}" python3-dev pybind11-dev)
python_tests=("${python[@]}" python3-numpy python3-scipy python3-venv python3-pip mypy)
# To run a notebook and make a page of it.
notebook=(python3-nbconvert python3-ipykernel)
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
# And tested in a real browser: the system's, or the one that CHROMIUM names.
web=("${build[@]}" "${studio[@]}")
[ -x "${CHROMIUM:-}" ] || web+=(chromium)

case "${1:-}" in
  build) needed=("${build[@]}") ;;
  python) needed=("${python[@]}") ;;
  test) needed=("${build[@]}" "${tests[@]}" "${python_tests[@]}") ;;
  notebook) needed=("${python_tests[@]}" "${notebook[@]}") ;;
  sanitizers) needed=("${build[@]}" "${tests[@]}" "${sanitizers[@]}") ;;
  bench) needed=("${build[@]}" libbenchmark-dev "${peers[@]}") ;;
  instructions) needed=("${build[@]}" libbenchmark-dev valgrind) ;;
  format) needed=(clang-format) ;;
  wasm) needed=("${build[@]}" "${wasm[@]}") ;;
  studio) needed=("${build[@]}" "${studio[@]}") ;;
  web) needed=("${web[@]}") ;;
  lint) needed=("${build[@]}" "${tests[@]}" clang-tidy-19) ;;
  *) echo "usage: scripts/setup.sh build|python|test|notebook|sanitizers|bench|instructions|format|lint|wasm|studio|web" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: this system has no apt-get; these packages, by Debian's names, must be there: ${needed[*]}" >&2
  if command -v dnf >/dev/null; then
    declare -A fedora=([g++]=gcc-c++ [libeigen3-dev]=eigen3-devel [libfmt-dev]=fmt-devel [nlohmann-json3-dev]=json-devel
      [libcli11-dev]=cli11-devel [libpng-dev]=libpng-devel [libjpeg-dev]=libjpeg-turbo-devel [zlib1g-dev]=zlib-devel [libgtest-dev]=gtest-devel
      [libgmp-dev]=gmp-devel [libbenchmark-dev]=google-benchmark-devel [libocct-data-exchange-dev]=opencascade-devel
      [libsuitesparse-dev]=suitesparse-devel [python3-dev]=python3-devel [pybind11-dev]=pybind11-devel
      [python3-venv]=python3 [python3-pip]=python3-pip [mypy]=python3-mypy [clang-format]=clang-tools-extra [npm]=nodejs-npm)
    names=() without=()
    for package in "${needed[@]}"; do
      case $package in *-19*|wasi-libc) without+=("$package") ;; *) names+=("${fedora[$package]:-$package}") ;; esac
    done
    echo "setup: by Fedora's names, not tried: dnf install ${names[*]}" >&2
    [ ${#without[@]} -eq 0 ] || echo "setup: Fedora has no packages of these names and versions: ${without[*]}" >&2
  fi
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
# What this system does not have by these names is told before anything is installed.
unknown=()
for package in "${missing[@]}"; do
  apt-cache show --no-all-versions "$package" >/dev/null 2>&1 || unknown+=("$package")
done
if [ ${#unknown[@]} -gt 0 ]; then
  echo "setup: this system's package lists do not have: ${unknown[*]} (tried: Debian 12 and its names)" >&2
  case " ${unknown[*]} " in *" chromium "*)
    echo "setup: with another Chromium, say where it is: CHROMIUM=/path/to/chromium make test" >&2 ;;
  esac
  exit 1
fi
install_now() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" </dev/null; }
# Lists may be old enough to name versions that the mirror no longer holds.
install_now || { "${as_root[@]}" apt-get update -q && install_now; }
