#!/usr/bin/env bash
# The paper's Table 1 on this machine: three scenes, both map builders, every backend asked for. Prints Markdown.
#
#   bench/table1.sh [BACKEND...]      default: serial vulkan gl
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=${PHOTONGRID:-build/photongrid}
[[ -x $program ]] || { echo "bench/table1.sh: build the program first: examples/run.sh" >&2; exit 1; }
backends=("$@")
((${#backends[@]})) || backends=(serial vulkan gl)
stats=$(mktemp -d)
trap 'rm -rf "$stats"' EXIT

# figure FILE SECTION KEY: the number at SECTION's KEY in a statistics file
figure() {
  awk -v section="\"$2\":" -v key="\"$3\":" '$1 == section { inside = 1 } inside && $1 == key { gsub(",", "", $2); print $2; exit }' "$1"
}

echo "Seconds; stages without compiling kernels, totals with it."
echo
echo "| scene | map | backend | trace photons | build map | trace rays | radiance estimate | total | mean photons used | peak MB |"
echo "|---|---|---|---|---|---|---|---|---|---|"
for scene in glass_ball ring cornell_box; do
  for map in sort route; do
    for backend in "${backends[@]}"; do
      file=$stats/$scene-$map-$backend.json
      "$program" render "examples/scenes/$scene.json" --backend "$backend" --map "$map" --as-paper --quiet -o "$stats/picture.pfm" --stats "$file" >/dev/null
      printf '| %s | %s | %s |' "$scene" "$map" "$backend"
      for stage in trace_photons build_map trace_rays radiance_estimate; do
        printf ' %.2f |' "$(awk -v ms="$(figure "$file" "$stage" ms)" 'BEGIN { print ms / 1000 }')"
      done
      awk -v total="$(sed -n 's/^ *"total_ms": *\([0-9.]*\).*/\1/p' "$file")" -v count="$(figure "$file" estimate mean_count)" \
        -v peak="$(sed -n 's/^ *"peak_memory_bytes": *\([0-9]*\).*/\1/p' "$file")" 'BEGIN { printf " %.2f | %.0f | %.0f |\n", total / 1000, count, peak / 1e6 }'
    done
  done
done
