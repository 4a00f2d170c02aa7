#!/usr/bin/env bash
# Indirect light from the photon map and by a final gather: relMSE against the reference renderer, of pixels and of means over
# 4 x 4 pixels, in which noise counts less and blur the same; and the time of the picture on cpu. Prints Markdown. Pictures of
# 128 x 128 pixels are left in out/final_gather.
#
#   bench/final_gather.sh [--quick] [PHOTONGRID]      --quick: a reference with few paths, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
paths=2048
if [[ ${1:-} == --quick ]]; then
  paths=4
  shift
fi
program=${1:-build/photongrid}
[[ -x $program ]] || { echo "$0: $program is not there; examples/run.sh builds it" >&2; exit 2; }
out=out/final_gather
mkdir -p "$out"

echo "| scene | indirect light | k | eye rays | seconds | relMSE | relMSE of 4 x 4 | bias of the mean |"
echo "|---|---|---|---|---|---|---|---|"
for scene in cornell_blocks cornell_box; do
  file=examples/scenes/$scene.json
  "$program" reference "$file" --size 128x128 --spp "$paths" --quiet -o "$out/$scene.exr" >/dev/null
  while read -r indirect k spp rays; do
    options=(--size 128x128 --indirect "$indirect" --k "$k" --spp "$spp" --gather-rays "$rays" --backend cpu --quiet)
    picture=$out/$scene-$indirect-$k.exr
    "$program" render "$file" "${options[@]}" -o "$picture" --stats "$out/stats.json" >/dev/null
    error=$("$program" compare "$picture" "$out/$scene.exr" | awk '/^relMSE/ { print $2 }')
    smooth=$("$program" compare "$picture" "$out/$scene.exr" --average 4 | awk '/^relMSE/ { print $2 }')
    mean=$("$program" error "$picture" "$out/$scene.exr" --stats "$out/error.json" -o "$out/error.png" >/dev/null &&
      awk '/"bias"/ { print $2 + 0; exit }' "$out/error.json")
    [[ $indirect == map ]] || indirect="gather, $rays rays"
    printf '| %s | %s | %d | %d | %.2f | %.5f | %.5f | %+.4f |\n' \
      "$scene" "$indirect" "$k" "$spp" "$(seconds_of "$out/stats.json")" "$error" "$smooth" "$mean"
  done <<<"map 200 16 1
map 750 16 1
gather 50 16 16
gather 200 16 16"
done
