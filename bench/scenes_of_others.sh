#!/usr/bin/env bash
# Draws the scenes of other programs' authors, and compares pictures with those that their renderer made.
#
#   bench/scenes_of_others.sh FOLDER [PHOTONGRID]
#
# FOLDER has cornell-box, water-caustic and veach-ajar, each with pbrt/scene-v4.pbrt and pbrt/TungstenRender.exr
# (Benedikt Bitterli's rendering resources). Pictures of 1024 x 1024 pixels (Veach Ajar: 1280 x 720) are left in
# out/scenes_of_others. They have the filter of that renderer, a tent, and errors are those of means over 4 x 4 pixels.
# The depths are those of the scenes' integrators.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-} program=${2:-build/photongrid}
if [[ ! -d $folder ]]; then
  echo "scenes_of_others.sh: SKIPPED: \"$folder\" is no folder of scenes" >&2
  exit 0
fi
mkdir -p out/scenes_of_others
draw() { # NAME SIZE OPTIONS...
  local name=$1 size=$2
  shift 2
  local scene=$folder/$name/pbrt/scene-v4.pbrt picture=out/scenes_of_others/$name
  if [[ ! -e $scene ]]; then
    echo "scenes_of_others.sh: SKIPPED: there is no $scene" >&2
    return
  fi
  echo "--- $name: $size $*"
  "$program" check "$scene"
  local begin=$SECONDS
  "$program" render "$scene" --backend cpu --size "$size" --pixel-filter tent "$@" --quiet -o "$picture.exr" -o "$picture.png"
  echo "$((SECONDS - begin)) s"
  "$program" compare "$picture.exr" "$folder/$name/pbrt/TungstenRender.exr" --average 4
}
draw cornell-box 1024x1024 --spp 16 --light-samples 8 --photons 2000000 --k 1000
draw water-caustic 1024x1024 --spp 16 --photons 8000000 --k 200 --photon-depth 9 --depth 9
draw veach-ajar 1280x720 --spp 16 --photons 1000000 --k 200 --photon-depth 13 --depth 13
