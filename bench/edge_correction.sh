#!/usr/bin/env bash
# What edge correction (--edge-correction polygons) does to the error of a picture, and what it costs: relMSE against `photongrid
# reference` and CPU seconds of the whole render on the serial backend, at Table 1's photons and k. Prints Markdown. Needs
# ./examples/run.sh first; bench/run.sh --estimates builds and calls this.
#
#   bench/edge_correction.sh [--quick]       --quick: one scene, tiny, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/picture_error.sh

echo "| scene | estimate | relMSE, 4 eye rays | relMSE, 32 eye rays | CPU s, 4 eye rays |"
echo "|---|---|---|---|---|"
scenes=(cornell_blocks)
[[ $quick == yes ]] || scenes+=(cornell_box)
for scene in "${scenes[@]}"; do
  reference "$scene" --spp 1024
  for filter in constant silverman; do
    for options in "--leaks side" "--leaks side,min_cosine" "--leaks side,min_cosine --edge-correction polygons"; do
      options="--filter $filter $options"
      seconds=$(median_cpu_seconds "$scene" 4 "$options")
      error=$(relmse)
      cpu_seconds "$scene" 32 "$options" >/dev/null
      echo "| $scene | \`$options\` | $error | $(relmse) | $seconds |"
    done
  done
done
