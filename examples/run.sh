#!/usr/bin/env bash
# Builds the photongrid program in build/ and draws the Cornell box to out/cornell_box.png, or opens a window on it.
#
#   examples/run.sh [--no-install] [options of `photongrid render`...]
#   examples/run.sh --view [--no-install] [options of `photongrid view`...]
#
# Installs missing Debian packages first (through sudo when not root); --no-install only says what is missing. The first
# picture needs the backend cpu alone. --view, and --backend gl, gl-osmesa, vulkan or serial, install and build what they
# need when they are asked for; then build/photongrid has it too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes view=no last=
arguments=() modules=() options=()
packages=("${base_packages[@]}")
# want NAME [PACKAGE...]: the module of that name, and what it is made of
want() {
  modules+=("$1")
  shift
  packages+=("$@")
}
for argument in "$@"; do
  case $argument in
    --no-install) install=no ;;
    --view) view=yes ;;
    -h | --help)
      sed -n '2,9s/^# \{0,1\}//p' examples/run.sh
      exit 0
      ;;
    *) arguments+=("$argument") ;;
  esac
  [[ $last != --backend ]] || argument=--backend=$argument
  case $argument in
    --backend=gl | --backend=gl-osmesa)
      want gl "${gl_packages[@]}"
      options+=(-DPHOTONGRID_GL=ON)
      ;;
    --backend=vulkan)
      want vulkan "${vulkan_packages[@]}"
      options+=(-DPHOTONGRID_VULKAN=ON)
      ;;
    --backend=serial) want serial ;;
  esac
  last=$argument
done
if [[ $view == yes ]]; then
  want window "${window_packages[@]}"
  options+=(-DPHOTONGRID_VIEW=ON)
fi
[[ " ${modules[*]} " == *" gl "* ]] || optional_packages=()
require_packages "$install" "${packages[@]}"

launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
mkdir -p build out
if ! cmake --preset release "${options[@]}" "${launcher[@]}" >build/configure.log 2>&1; then
  cat build/configure.log >&2
  exit 1
fi
targets=(photongrid_program)
for module in "${modules[@]}"; do
  if ! grep -q "photongrid_module_$module\b" build/build.ninja; then
    [[ $module != serial ]] || continue # a build without cpu has it in the program
    echo "The module of $module cannot be built here:" >&2
    grep '^-- photongrid: ' build/configure.log >&2
    exit 1
  fi
  [[ -e build/photongrid-modules/$module.so ]] || echo "Building the module of $module, which is asked for the first time"
  targets+=("photongrid_module_$module")
done
cmake --build build --target "${targets[@]}"
if [[ $view == yes ]]; then
  exec build/photongrid view examples/scenes/cornell_box.json "${arguments[@]}"
fi
build/photongrid render examples/scenes/cornell_box.json -o out/cornell_box.png "${arguments[@]}" >/dev/null
echo "The picture lies in $PWD/out/cornell_box.png"
