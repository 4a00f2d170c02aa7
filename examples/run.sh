#!/usr/bin/env bash
# Builds the photongrid program in build/ and draws the Cornell box to out/cornell_box.png, or opens a window on it.
#
#   examples/run.sh [--no-install] [options of `photongrid render`...]
#   examples/run.sh --view [--no-install] [options of `photongrid view`...]
#
# Installs missing Debian packages first (through sudo when not root); --no-install only says what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes view=no
arguments=()
for argument in "$@"; do
  case $argument in
    --no-install) install=no ;;
    --view) view=yes ;;
    -h | --help)
      sed -n '2,7s/^# \{0,1\}//p' examples/run.sh
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
if [[ $view == yes ]]; then
  exec build/photongrid view examples/scenes/cornell_box.json "${arguments[@]}"
fi
build/photongrid render examples/scenes/cornell_box.json -o out/cornell_box.png "${arguments[@]}" >/dev/null
echo "The picture lies in $PWD/out/cornell_box.png"
