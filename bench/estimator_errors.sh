#!/usr/bin/env bash
# How wrong a picture is, and what it costs, for each kind of estimate: relMSE against `photongrid reference` and CPU seconds of
# the whole render on the serial backend, at Table 1's photons and k. Prints Markdown. Needs ./examples/run.sh first;
# bench/run.sh --estimates builds and calls this.
#
#   bench/estimator_errors.sh [--quick]       --quick: one scene, tiny, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/picture_error.sh

echo "| scene | estimate | relMSE | CPU s | over the paper's |"
echo "|---|---|---|---|---|"
measure() {
  local scene=$1 options pairs
  reference "$@"
  for options in "--as-paper" "--as-paper --search exact_k" "--filter constant --leaks none" "--filter constant" "--filter cone" "--filter epanechnikov" "--filter silverman" "--filter silverman --leaks side,min_cosine" "--filter silverman --leaks side,flattening"; do
    # In turn with the paper's, since machines get slower and faster by the minute.
    pairs=$(for _ in $(times_measured); do echo "$(cpu_seconds "$scene" 4 --as-paper) $(cpu_seconds "$scene" 4 "$options")"; done)
    echo "| $scene | \`$options\` | $(relmse) | $(awk '{ print $2 }' <<<"$pairs" | median) | $(awk '{ printf "%.2f\n", ($1 > 0 ? $2 / $1 : 1) }' <<<"$pairs" | median) |"
  done
}
measure cornell_blocks --spp 1024
[[ $quick == no ]] || exit 0
measure cornell_box --spp 1024
measure ring --spp 256 --paths 10000000
