#!/usr/bin/env bash
# Compares pictures with those of other programs. The exit status is 1 if one misses a relMSE of at most twice the noise of
# both pictures, of means over 4 x 4 pixels.
#
#   tests/pictures_of_others.sh cycles [SAMPLES] [PHOTONGRID]
#   tests/pictures_of_others.sh blender [SAMPLES] [PHOTONGRID]
#   tests/pictures_of_others.sh tungsten FOLDER [PHOTONGRID]      PHOTONGRID: build/photongrid unless given
#
# cycles: converts scenes to glTF, draws them with Blender's path tracer, Cycles, and compares the pictures with those of
# `photongrid reference`: another program's light, by way of our own files. Needs the Debian packages blender and
# python3-numpy. Pictures of 256 x 256 pixels are left in out/cycles. 256 samples unless given.
#
# blender: scenes that Blender makes and exports (tests/blender_scenes.py), drawn by Cycles and, with nothing set, by
# `photongrid render`: lights, textures, skies, instances, metal and glass as people's files have them. Means over 16 x 16
# pixels may differ by 3 % of theirs plus a tenth of the picture's. Of `plastic` the difference is only told: until Blender 4 its Principled surfaces reflect more
# light than glTF's. Left in out/blender. 512 samples unless given.
#
# tungsten: scenes of others and the pictures that their renderer made. FOLDER has cornell-box, water-caustic and veach-ajar,
# each with pbrt/scene-v4.pbrt and pbrt/TungstenRender.exr (Benedikt Bitterli's rendering resources). Pictures of
# 1024 x 1024 pixels (Veach Ajar: 1280 x 720) are left in out/scenes_of_others, with the filter of that renderer, a tent,
# and the depths of the scenes' integrators. The noise of a photon map's picture is told from two seeds (`compare
# --again`), that of a picture of paths from itself (`compare --noise`). No relMSE is wanted of the Cornell box's map, which
# has bias besides, and of Veach Ajar, whose pbrt file is another scene than its picture.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
what=${1:-} given=${2:-} program=${3:-build/photongrid} missed=0

# judge NAME RELMSE OURS THEIRS: whether a picture's relMSE is at most twice the noise of both pictures
judge() {
  awk -v name="$1" -v error="$2" -v ours="$3" -v theirs="$4" 'BEGIN {
    most = 2 * (ours + theirs)
    printf "%s: relMSE %.2g; noise of ours %.2g, of the other %.2g; ", name, error, ours, theirs
    printf "wanted at most %.2g: ", most
    print (error <= most ? "PASS" : "FAIL")
    exit error > most
  }'
}

if [[ $what == cycles ]]; then
  samples=${given:-256}
  if ! command -v blender >/dev/null; then
    echo "pictures_of_others.sh: SKIPPED: no blender (Debian packages blender, python3-numpy)" >&2
    exit 0
  fi
  out=$PWD/out/cycles
  mkdir -p "$out"
  for name in cornell_blocks cornell_box; do
    scene=examples/scenes/$name.json
    "$program" convert "$scene" "$out/$name.gltf" >/dev/null
    blender -b --factory-startup -P tests/cycles.py -- "$out/$name.gltf" "$out/$name-cycles.exr" 256 256 "$samples" \
      >"$out/$name.log" 2>&1 || { cat "$out/$name.log" >&2; exit 2; }
    "$program" reference "$scene" --size 256x256 --spp "$samples" --quiet -o "$out/$name.exr" >/dev/null
    read -r error theirs ours < <("$program" compare "$out/$name-cycles.exr" "$out/$name.exr" --average 4 --noise |
      awk '/^relMSE/ { error = $2 } /^noise/ { print error, $2, $4 }')
    judge "$name" "$error" "$ours" "$theirs" || missed=1
  done
  exit $missed
fi
if [[ $what == blender ]]; then
  samples=${given:-512}
  if ! command -v blender >/dev/null || ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    echo "pictures_of_others.sh: SKIPPED: no blender, or no numpy (Debian packages blender, python3-numpy)" >&2
    exit 0
  fi
  out=$PWD/out/blender
  mkdir -p "$out"
  for name in sun lamps emission textures glass plastic; do
    paths=$samples
    [[ $name != lamps ]] || paths=$((2 * samples)) # its metal makes bright specks
    blender -b --factory-startup -P tests/blender_scenes.py -- $name "$out" 128 "$paths" >"$out/$name.log" 2>&1 &&
      [[ -e $out/$name-cycles.pfm ]] || { cat "$out/$name.log" >&2; exit 2; }
    sky=()
    [[ ! -e $out/$name.hdr ]] || sky=(--environment "$out/$name.hdr")
    "$program" render "$out/$name.glb" "${sky[@]}" --size 128x128 --passes 48 --quiet -o "$out/$name.pfm" \
      -o "$out/$name.png" >/dev/null
    said=$(/usr/bin/python3 tests/blender_scenes.py "$out/$name.pfm" "$out/$name-cycles.pfm")
    verdict=PASS
    if [[ $name == plastic ]]; then
      verdict=told
    elif awk "BEGIN { exit !(${said%% *} > 0.03) }"; then
      verdict=FAIL missed=1
    fi
    echo "$name: largest difference, of the whole, (block, channel), ours, theirs: $said: $verdict"
  done
  exit $missed
fi
[[ $what == tungsten ]] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
folder=$given
if [[ ! -d $folder ]]; then
  echo "pictures_of_others.sh: SKIPPED: \"$folder\" is no folder of scenes" >&2
  exit 0
fi
out=out/scenes_of_others
mkdir -p "$out"
relmse() { "$program" compare "$1" "$2" --average 4 | tee /dev/stderr | sed -n 's/^relMSE *//p'; } # shows all of it
seeds() { "$program" compare "$1" "$3" --average 4 --again "$2" | sed -n 's/^seeds *\([^ ]*\) of.*/\1/p'; }
noise() { "$program" compare "$1" "$1" --average 4 --noise | sed -n 's/^noise *\([^ ]*\) and.*/\1/p'; }
# draw SCENE PICTURE OPTIONS...: PICTURE.exr and .png
draw() {
  local scene=$1 picture=$2 begin=$SECONDS
  shift 2
  "$program" "$@" "$scene" --pixel-filter tent --quiet -o "$picture.exr" -o "$picture.png"
  echo "$((SECONDS - begin)) s: $*"
}
# is_there NAME: whether the folder has that scene
is_there() {
  echo "--- $1"
  [[ -e $folder/$1/pbrt/scene-v4.pbrt ]] || { echo "pictures_of_others.sh: SKIPPED: there is no $1" >&2; return 1; }
}
# draw_map NAME OPTIONS...: by a photon map, with two seeds
draw_map() {
  local name=$1 scene=$folder/$1/pbrt/scene-v4.pbrt
  shift
  draw "$scene" "$out/$name" render --backend cpu --size 1024x1024 "$@"
  draw "$scene" "$out/$name-2" render --backend cpu --size 1024x1024 "$@" --seed 2
}
if is_there cornell-box; then
  "$program" check "$folder/cornell-box/pbrt/scene-v4.pbrt"
  draw_map cornell-box --spp 16 --light-samples 8 --photons 2000000 --k 1000
  "$program" compare "$out/cornell-box.exr" "$folder/cornell-box/pbrt/TungstenRender.exr" --average 4 \
    --again "$out/cornell-box-2.exr"
  draw "$folder/cornell-box/pbrt/scene-v4.pbrt" "$out/cornell-box-paths" reference --size 1024x1024 --spp 64
  theirs=$folder/cornell-box/pbrt/TungstenRender.exr
  judge cornell-box-paths "$(relmse "$out/cornell-box-paths.exr" "$theirs")" "$(noise "$out/cornell-box-paths.exr")" \
    "$(noise "$theirs")" || missed=1
fi
if is_there water-caustic; then
  "$program" check "$folder/water-caustic/pbrt/scene-v4.pbrt"
  draw_map water-caustic --spp 16 --photons 8000000 --k 200 --photon-depth 9 --depth 9
  theirs=$folder/water-caustic/pbrt/TungstenRender.exr
  judge water-caustic "$(relmse "$out/water-caustic.exr" "$theirs")" \
    "$(seeds "$out/water-caustic.exr" "$out/water-caustic-2.exr" "$theirs")" "$(noise "$theirs")" || missed=1
fi
if is_there veach-ajar; then
  scene=$folder/veach-ajar/pbrt/scene-v4.pbrt
  options=(render --backend cpu --size 1280x720 --spp 16 --photons 1000000 --k 200 --photon-depth 13 --depth 13)
  "$program" check "$scene"
  draw "$scene" "$out/veach-ajar" "${options[@]}"
  "$program" compare "$out/veach-ajar.exr" "${scene%/*}/TungstenRender.exr" --average 4
  # With the matte floor of the picture in the place of the file's, of aluminium.
  matte=$out/veach-ajar-matte
  mkdir -p "$matte"
  ln -sfn "$(realpath "${scene%/*}/models")" "$matte/models"
  ln -sfn "$(realpath "${scene%/*}/textures")" "$matte/textures"
  sed '/^MakeNamedMaterial "Floor"/,/"rgb eta"/c\
Texture "squares" "spectrum" "checkerboard" "rgb tex1" [ 0.5 0.5 0.5 ] "rgb tex2" [ 0.15 0.15 0.15 ]\
    "float uscale" [ 20 ] "float vscale" [ 20 ]\
MakeNamedMaterial "Floor" "string type" [ "diffuse" ] "texture reflectance" [ "squares" ]' "$scene" \
    >"$matte/scene-v4.pbrt"
  draw "$matte/scene-v4.pbrt" "$matte" "${options[@]}" --allow-outside
  "$program" compare "$matte.exr" "${scene%/*}/TungstenRender.exr" --average 4
fi
exit $missed
