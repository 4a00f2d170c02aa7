#!/usr/bin/env bash
# What edge correction (--edge-correction polygons) does to the error of a picture, and what it costs: relMSE against `photongrid
# reference` and CPU seconds of the whole render on the serial backend, at the scenes' own photons and k. For docs/measures.md.
# Needs ./examples/run.sh first and /usr/bin/time (Debian: time).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=${PHOTONGRID:-build/photongrid}
[[ -x $program ]] || { echo "bench/edge_correction.sh: $program is not there; run ./examples/run.sh first" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=128x96

echo "| scene | estimate | relMSE, 4 eye rays | relMSE, 32 eye rays | CPU s, 4 eye rays |"
echo "|---|---|---|---|---|"
error() {
  # shellcheck disable=SC2086
  "$program" render "$1" --backend serial --size $size --spp "$2" $3 -o "$work/picture.exr" --quiet >/dev/null
  "$program" compare "$work/picture.exr" "$work/reference.exr" | awk '$1 == "relMSE" { print $2 }'
}
for name in cornell_blocks cornell_box; do
  scene=examples/scenes/$name.json
  "$program" reference "$scene" --size $size --spp 1024 -o "$work/reference.exr" --quiet >/dev/null
  for kernel in constant silverman; do
    for options in "--leaks side" "--leaks side,normals" "--leaks side,normals --edge-correction polygons"; do
      options="--kernel $kernel $options"
      seconds=()
      for _ in 1 2 3; do
        # shellcheck disable=SC2086
        /usr/bin/time -f %U -o "$work/time" "$program" render "$scene" --backend serial --size $size --spp 4 $options -o "$work/picture.exr" --quiet >/dev/null
        seconds+=("$(cat "$work/time")")
      done
      echo "| $name | \`$options\` | $(error "$scene" 4 "$options") | $(error "$scene" 32 "$options") | $(printf '%s\n' "${seconds[@]}" | sort -n | sed -n 2p) |"
    done
  done
done
