#!/usr/bin/env bash
# Time to visual convergence (3.1, figure 8): when the running picture's relMSE to the final one first stays below 1e-3, and when
# the final one is there; the whole picture, from the first photon on, without the time that kernels take to compile. Prints
# Markdown. The paper's glass ball looked converged after 4 s of 14.9 s of its radiance estimate.
#
#   bench/convergence.sh [--quick] [BACKEND...]      default: cpu vulkan; --quick: small pictures, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid
size=()
if [[ ${1:-} == --quick ]]; then
  size=(--size 64x48)
  shift
fi
backends=("$@")
((${#backends[@]})) || backends=(cpu vulkan)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

echo "| scene | backend | search | pictures | converged, s | final, s | share |"
echo "|---|---|---|---|---|---|---|"
for scene in glass_ball ring cornell_box; do
  for backend in "${backends[@]}"; do
    for search in at_least_k exact_k; do
      options=("${size[@]}" --backend "$backend" --shader-cache "$work/cache" --quiet -o "$work/picture.pfm" --progressive "$work/steps")
      [[ $search == exact_k ]] || options+=(--as-paper)
      for run in compiling measured; do
        rm -rf "$work/steps"
        "$build/photongrid" render "examples/scenes/$scene.json" "${options[@]}" --stats "$work/stats.json" >/dev/null
      done
      compile=$(awk '/^  "compile_ms":/ { print $2 + 0 }' "$work/stats.json")
      awk -F, -v scene="$scene" -v backend="$backend" -v search="$search" -v compile="${compile:-0}" '
        NR == 1 { next }
        { ms[NR] = $2 - compile; error[NR] = $3 }
        END {
          for (first = NR; first > 2 && error[first - 1] < 1e-3; --first) {}
          printf "| %s | %s | `%s` | %d | %.2f | %.2f | %.0f %% |\n", scene, backend, search, NR - 1, ms[first] / 1000, ms[NR] / 1000, 100 * ms[first] / ms[NR]
        }' "$work"/steps/*.csv
    done
  done
done
