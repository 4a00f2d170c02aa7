#!/usr/bin/env bash
# Converts scenes to glTF, draws them with Blender's path tracer, Cycles, and compares the pictures with those of
# `photongrid reference`: another program's light, by way of our own files.
#
#   bench/cycles.sh [PHOTONGRID] [SAMPLES]
#
# Needs the Debian packages blender and python3-numpy. Pictures of 256 x 256 pixels are left in out/cycles. Errors are
# those of means over 4 x 4 pixels; wanted is at most twice the noise of both pictures, as they have it by themselves.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
program=${1:-build/photongrid} samples=${2:-256}
if ! command -v blender >/dev/null; then
  echo "cycles.sh: SKIPPED: no blender (Debian packages blender, python3-numpy)" >&2
  exit 0
fi
out=$PWD/out/cycles
mkdir -p "$out"
missed=0
for name in cornell_blocks cornell_box; do
  scene=examples/scenes/$name.json
  "$program" convert "$scene" "$out/$name.gltf" >/dev/null
  blender -b --factory-startup -P bench/cycles.py -- "$out/$name.gltf" "$out/$name-cycles.exr" 256 256 "$samples" \
    >"$out/$name.log" 2>&1 || { cat "$out/$name.log" >&2; exit 2; }
  "$program" reference "$scene" --size 256x256 --spp "$samples" --quiet -o "$out/$name.exr" >/dev/null
  read -r error theirs ours < <("$program" compare "$out/$name-cycles.exr" "$out/$name.exr" --average 4 --noise |
    awk '/^relMSE/ { error = $2 } /^noise/ { print error, $2, $4 }')
  judge "$name" "$error" "$ours" "$theirs" || missed=1
done
exit $missed
