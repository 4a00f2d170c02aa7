#!/usr/bin/env bash
# Ways to compute indirect light and caustics: relMSE against the reference renderer, of pixels and of means over 4 x 4
# pixels, in which noise counts less and blur the same; the mean's relative bias; the time of the picture on cpu, and the
# number of its photon paths. All have 16 eye rays a pixel. Prints Markdown. Pictures of 128 x 128 pixels are left in
# out/final_gather.
#
#   bench/final_gather.sh [--quick]      --quick: a reference with few paths, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
paths=2048
if [[ ${1:-} == --quick ]]; then
  paths=4
  shift
fi
need photongrid
program=$build/photongrid
out=out/final_gather
mkdir -p "$out"

# A scene, the options of its reference, and ways to draw it.
cornell_blocks=("--passes 1 --spp 16" "--passes 1 --spp 16 --k 200" "--passes 1 --spp 16 --indirect gather --k 50"
  "--spp 1 --passes 16 --k 50 --radii per_pass" "--spp 1 --passes 16 --k 50 --radii shrinking"
  "--spp 1 --passes 16 --k 50 --radii shrinking --indirect gather")
cornell_box=("--passes 1 --spp 16 --caustic-photons 0" "--passes 1 --spp 16 --caustic-photons 0 --k 200"
  "--passes 1 --spp 16"
  "--passes 1 --spp 16 --indirect gather --k 50 --caustic-photons 0" "--passes 1 --spp 16 --indirect gather --k 50"
  "--spp 1 --passes 16 --k 50 --caustic-photons 0 --radii per_pass" "--spp 1 --passes 16 --k 50 --radii per_pass"
  "--spp 1 --passes 16 --k 50 --radii shrinking"
  "--spp 1 --passes 16 --k 50 --radii shrinking --indirect gather")
ring=("--passes 1 --spp 16 --caustic-photons 0 --emission power" "--passes 1 --spp 16 --caustic-photons 0"
  "--passes 1 --spp 16"
  "--spp 1 --passes 16 --k 30 --caustic-photons 0 --emission power --radii per_pass"
  "--spp 1 --passes 16 --k 30 --caustic-photons 0 --radii per_pass"
  "--spp 1 --passes 16 --radii shrinking")
glass_ball=("${ring[@]}")
echo "| scene | options | photon paths | seconds | relMSE | relMSE of 4 x 4 | bias of the mean |"
echo "|---|---|---|---|---|---|---|"
for scene in cornell_blocks cornell_box ring glass_ball; do
  file=examples/scenes/$scene.json reference=$out/$scene.exr picture=$out/picture.exr
  "$program" reference "$file" --size 128x128 --spp "$paths" --caustics bins --paths $((paths * 30000)) --quiet \
    -o "$reference" >/dev/null
  declare -n ways=$scene
  for way in "${ways[@]}"; do
    read -ra options <<<"$way"
    "$program" render "$file" --size 128x128 "${options[@]}" --backend cpu --quiet -o "$picture" \
      --stats "$out/stats.json" >/dev/null
    error=$("$program" compare "$picture" "$reference" | awk '/^relMSE/ { print $2 }')
    smooth=$("$program" compare "$picture" "$reference" --average 4 | awk '/^relMSE/ { print $2 }')
    "$program" error "$picture" "$reference" --stats "$out/error.json" -o "$out/error.png" >/dev/null
    bias=$(awk '/"bias"/ { print $2 + 0; exit }' "$out/error.json")
    emitted=$(awk '/"emitted"/ { print $2 + 0; exit }' "$out/stats.json")
    printf '| %s | `%s` | %d | %.2f | %.5f | %.5f | %+.4f |\n' \
      "$scene" "$way" "$emitted" "$(seconds_of "$out/stats.json")" "$error" "$smooth" "$bias"
  done
done
