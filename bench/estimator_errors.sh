#!/usr/bin/env bash
# How wrong a picture is, and what it costs, for each kind of estimate: relMSE against `photongrid reference` and CPU seconds of
# the whole render on the serial backend, at the scenes' own photons and k. For docs/measures.md. Needs ./examples/run.sh first
# and /usr/bin/time (Debian: time).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/picture_error.sh

echo "| scene | estimate | relMSE | CPU s | over the paper's |"
echo "|---|---|---|---|---|"
measure() {
  local scene=$1 first='' seconds
  reference "$@"
  for options in "--as-paper" "--as-paper --search exact_k" "--kernel constant --leaks none" "--kernel constant" "--kernel cone" "--kernel epanechnikov" "--kernel silverman" "--kernel silverman --leaks side,normals" "--kernel silverman --leaks side,disc"; do
    seconds=$(median_cpu_seconds "$scene" 4 "$options")
    first=${first:-$seconds}
    echo "| $scene | \`$options\` | $(relmse) | $seconds | $(awk "BEGIN { printf \"%.2f\", $seconds / $first }") |"
  done
}
measure cornell_blocks --spp 1024
measure cornell_box --spp 1024
measure ring --spp 256 --paths 10000000
