#!/usr/bin/env bash
# Builds the programs that bench/time_to_error.py compares with, outside the repository:
#   bench/peers.sh [FOLDER]      default: $PHOTONGRID_PEERS
# FOLDER/NAME holds a program's sources; what is not there is cloned from where its authors have it, at the commit that
# was measured. A program without sources, or that does not build, is skipped, which is said. Needs git, cmake and a
# C++ compiler, no packages besides.
set -uo pipefail
folder=${1:-${PHOTONGRID_PEERS:-}}
[[ -n $folder ]] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$folder/log"
folder=$(cd "$folder" && pwd)
jobs=${JOBS:-$(nproc)}

skip() { echo "peers.sh: SKIPPED: $*" >&2; }
# sources NAME ADDRESS COMMIT: the program's sources, in the folder NAME
sources() {
  if [[ ! -e $folder/$1/.git ]]; then
    if ! git clone --quiet "$2" "$folder/$1" || ! git -C "$folder/$1" checkout --quiet "$3"; then
      skip "no sources of $1 from $2"
      return 1
    fi
  fi
}
# built NAME COMMAND...: with the output in log/NAME
built() {
  local name=$1
  shift
  "$@" >>"$folder/log/$name" 2>&1 || { skip "$name does not build; see $folder/log/$name"; return 1; }
}

build_smallvcm() {
  sources SmallVCM https://github.com/SmallVCM/SmallVCM a13690f03d3414f76ba32b5f0e259e6e5d10ed7b || return
  # Its scenes are built in: this makes it read one, and lets the size, the depth and the radius be set.
  local copy=$folder/build-smallvcm
  rm -rf "$copy"
  cp -r "$folder/SmallVCM/src" "$copy"
  sed -i 's|^class Scene$|#include "smallvcm_scene.hpp"\n&|; /mSceneName = GetSceneName(aBoxMask/a if (read_photongrid_scene(*this, aResolution)) return;' "$copy/scene.hxx"
  sed -i 's|= Vec2i(512, 512)|= Vec2i(int(photongrid_setting("PHOTONGRID_SIZE", 512)))|; s|mMaxPathLength = 10;|mMaxPathLength = int(photongrid_setting("PHOTONGRID_DEPTH", 10));|; s|= 0.003f;|= photongrid_setting("PHOTONGRID_RADIUS", 0.003f);|; s|= 0.75f;|= photongrid_setting("PHOTONGRID_ALPHA", 0.75f);|' "$copy/config.hxx"
  # Its matte triangles are black behind.
  sed -i 's|oResult.normal = mNormal;|oResult.normal = Dot(mNormal, aRay.dir) > 0 ? -mNormal : mNormal;|' "$copy/geometry.hxx"
  built smallvcm g++ -O3 -march=native -std=c++11 -fopenmp -I "$here" -o "$folder/smallvcm" "$copy/smallvcm.cxx"
}

build_tungsten() {
  sources tungsten https://github.com/tunabrain/tungsten 88ea02044dbaf20472a8173b6752460b50c096d8 || return
  # Its list of processors ends before those of today; a Haswell has all the instructions that it uses.
  built tungsten cmake -S "$folder/tungsten" -B "$folder/build-tungsten" -DCMAKE_BUILD_TYPE=Release -DTARGET_ARCHITECTURE=haswell &&
    built tungsten cmake --build "$folder/build-tungsten" --target tungsten -j "$jobs" && ln -sf build-tungsten/tungsten "$folder/tungsten-program"
}

build_pbrt() {
  local source=$folder/pbrt-v3
  sources pbrt-v3 https://github.com/mmp/pbrt-v3 13d871faae88233b327d04cda24022b8bb0093ee || return
  sources pbrt-v3/src/ext/openexr https://github.com/wjakob/openexr 84793a726d77ad6cb9a510011c3907df809c32a4 || return
  sources pbrt-v3/src/ext/glog https://github.com/google/glog 4d391fe692ae6b9e0105f473945c415a3ce5a401 || return
  sources pbrt-v3/src/ext/ptex https://github.com/wdas/ptex 4cd8e9a6db2b06e478dfbbd8c26eb6df97f84483 || return
  mkdir -p "$source/src/ext/zlib/doc" # it uses the system's zlib where there is one, but looks for this folder
  built pbrt-v3 cmake -S "$source" -B "$folder/build-pbrt-v3" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-march=native &&
    built pbrt-v3 cmake --build "$folder/build-pbrt-v3" --target pbrt_exe -j "$jobs" && ln -sf build-pbrt-v3/pbrt "$folder/pbrt"
}

for program in smallvcm tungsten pbrt; do
  : >"$folder/log/$program" 2>/dev/null
  build_$program && echo "$folder: $program"
done
