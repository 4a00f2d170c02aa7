#!/usr/bin/env bash
# Time to visual convergence (3.1, figure 8): when the running picture first stays within 1e-3 of the final one in relMSE, when it
# looks like it (a structural similarity of 0.98), and when the final one is there; the whole picture, from the first photon on,
# without the time that kernels take to compile. Prints Markdown. The paper's glass ball looked converged after 4 s of 14.9 s of
# its radiance estimate, without the tracing and the map.
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

echo "| scene | backend | search | pictures | relMSE < 0.001, s | SSIM > 0.98, s | final, s | share by SSIM |"
echo "|---|---|---|---|---|---|---|---|"
for scene in glass_ball ring cornell_box; do
  for backend in "${backends[@]}"; do
    for search in at_least_k exact_k; do
      options=("${size[@]}" --backend "$backend" --shader-cache "$work/cache" --quiet -o "$work/picture.pfm" --progressive "$work/steps")
      if [[ $search == exact_k ]]; then options+=(--passes 1); else options+=(--as-paper); fi
      for run in compiling measured; do
        rm -rf "$work/steps"
        "$build/photongrid" render "examples/scenes/$scene.json" "${options[@]}" --stats "$work/stats.json" >/dev/null
      done
      compile=$(awk '/^  "compile_ms":/ { print $2 + 0 }' "$work/stats.json")
      awk -F, -v scene="$scene" -v backend="$backend" -v search="$search" -v compile="${compile:-0}" '
        NR == 1 { next }
        { ms[NR] = $2 - compile; error[NR] = $3; likeness[NR] = $4 }
        END {
          for (near = NR; near > 2 && error[near - 1] < 1e-3; --near) {}
          for (alike = NR; alike > 2 && likeness[alike - 1] > 0.98; --alike) {}
          printf "| %s | %s | `%s` | %d | %.2f | %.2f | %.2f | %.0f %% |\n", scene, backend, search, NR - 1, ms[near] / 1000, ms[alike] / 1000, ms[NR] / 1000, 100 * ms[alike] / ms[NR]
        }' "$work"/steps/*.csv
    done
  done
done
