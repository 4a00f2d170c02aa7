#!/usr/bin/env bash
# How wrong a picture is, and what it costs, for each kind of estimate: relMSE against `photongrid reference` and CPU seconds of
# the whole render on the serial backend, at the scenes' own photons and k. For docs/measures.md. Needs ./examples/run.sh first
# and /usr/bin/time (Debian: time).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=${PHOTONGRID:-build/photongrid}
[[ -x $program ]] || { echo "bench/estimator_errors.sh: $program is not there; run ./examples/run.sh first" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=128x96

echo "| scene | estimate | relMSE | CPU s | over the paper's |"
echo "|---|---|---|---|---|"
measure() {
  local scene=$1
  shift
  "$program" reference "examples/scenes/$scene.json" --size $size "$@" -o "$work/reference.exr" --quiet >/dev/null
  local first=
  for options in "--as-paper" "--as-paper --search exact_k" "--kernel constant --leaks none" "--kernel constant" "--kernel cone" "--kernel epanechnikov" "--kernel silverman" "--kernel silverman --leaks side,normals" "--kernel silverman --leaks side,disc"; do
    local seconds=()
    for _ in 1 2 3; do
      # shellcheck disable=SC2086
      /usr/bin/time -f %U -o "$work/time" "$program" render "examples/scenes/$scene.json" --backend serial --size $size --spp 4 $options -o "$work/picture.exr" --quiet >/dev/null
      seconds+=("$(cat "$work/time")")
    done
    local median error
    median=$(printf '%s\n' "${seconds[@]}" | sort -n | sed -n 2p)
    error=$("$program" compare "$work/picture.exr" "$work/reference.exr" | awk '$1 == "relMSE" { print $2 }')
    first=${first:-$median}
    echo "| $scene | \`$options\` | $error | $median | $(awk "BEGIN { printf \"%.2f\", $median / $first }") |"
  done
}
measure cornell_blocks --spp 1024
measure cornell_box --spp 1024
measure ring --spp 256 --paths 10000000
