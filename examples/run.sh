#!/usr/bin/env bash
# Builds the photongrid program in build/ and draws the Cornell box to out/cornell_box.png.
#
#   examples/run.sh [--no-install] [options of `photongrid render`...]
#
# Installs missing Debian packages first (through sudo when not root); --no-install only says what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes
arguments=()
for argument in "$@"; do
  case $argument in
    --no-install) install=no ;;
    -h | --help)
      sed -n '2,6s/^# \{0,1\}//p' examples/run.sh
      exit 0
      ;;
    *) arguments+=("$argument") ;;
  esac
done
require_packages "$install" "${program_packages[@]}"

launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
mkdir -p build out
if ! cmake --preset release "${launcher[@]}" >build/configure.log 2>&1; then
  cat build/configure.log >&2
  exit 1
fi
cmake --build build --target photongrid_program
build/photongrid render examples/scenes/cornell_box.json -o out/cornell_box.png "${arguments[@]}" >/dev/null
echo "The picture lies in $PWD/out/cornell_box.png"
