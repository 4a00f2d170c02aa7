#!/usr/bin/env bash
# The paper's figure 7: its three scenes by sorting, by stencil routing, and by software, here the reference renderer. Writes
# docs/figure7/SCENE-{sort,route,reference}.png and prints a Markdown table with the relMSE against the reference.
#
#   bench/figure7.sh [OPTION of "photongrid render"...]
#
# 256 pixels wide, in one pass with Table 1's counts and 4 eye rays each: as many eye rays as the paper's size.
# PHOTONGRID names another program than build/photongrid.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
program=${PHOTONGRID:-build/photongrid}
[[ -x $program ]] || { echo "bench/figure7.sh: $program: no such program; build it first: examples/run.sh" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p docs/figure7

# relmse NAME: of $work/NAME.exr against the scene's reference
relmse() {
  "$program" compare "$work/$1.exr" "$work/$scene.exr" | sed -n 's/^relMSE *//p'
}

# scene, size, eye paths and light paths of the reference
scenes=("glass_ball 256x192 128 30000000" "ring 256x192 64 60000000" "cornell_box 256x256 128 20000000")
echo "| scene | sort | route | reference |"
echo "|---|---|---|---|"
for line in "${scenes[@]}"; do
  read -r scene size spp paths <<<"$line"
  reference=("$program" reference "examples/scenes/$scene.json" --caustics bins --size "$size" --spp "$spp" --paths "$paths" --quiet)
  "${reference[@]}" -o "$work/$scene.exr" -o "docs/figure7/$scene-reference.png" >/dev/null
  "${reference[@]}" --seed 2 -o "$work/again.exr" >/dev/null
  row="| $scene |"
  for map in sort route; do
    # shellcheck disable=SC2046
    "$program" render "examples/scenes/$scene.json" --backend serial --map "$map" --size "$size" \
      $(paper_counts "$scene") --spp 4 "$@" --quiet -o "$work/$map.exr" -o "docs/figure7/$scene-$map.png" >/dev/null
    row+=" ![$scene, $map](../figure7/$scene-$map.png) relMSE $(relmse "$map") |"
  done
  echo "$row ![$scene, reference](../figure7/$scene-reference.png) another seed: relMSE $(relmse again) |"
done
