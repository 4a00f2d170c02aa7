#!/usr/bin/env bash
# What including photongrid costs: seconds to compile a file with `g++ -O2`, medians of three in turn, and the stripped size of the
# smallest program with a map and an estimate. From an installed tree, by pkg-config. Exits with 1 where the core's headers
# take 1.5 s or more.
#
#   PHOTONGRID_BUILD=build bench/inclusion.sh [--smoke]      --smoke: once, and of the backends serial only
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
runs=3 backends=(serial cpu gl vulkan)
if [[ ${1:-} == --smoke ]]; then
  runs=1 backends=(serial)
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "${PHOTONGRID_BUILD:-build}" --component dev --prefix "$work/prefix" >/dev/null
export PKG_CONFIG_PATH=$work/prefix/share/pkgconfig CCACHE_DISABLE=1

# include NAME PACKAGE HEADER...: a file that includes headers and does nothing
names=() packages=()
include() {
  names+=("$1")
  packages+=("$2")
  shift 2
  printf '#include <%s>\n' "$@" >"$work/${#names[@]}.cpp"
  echo 'int main() {}' >>"$work/${#names[@]}.cpp"
}
# program NAME PACKAGE HEADER TYPE: the smallest program on a backend
program() {
  names+=("$1")
  packages+=("$2")
  cat >"$work/${#names[@]}.cpp" <<CPP
#include <photongrid/backends/$3>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/own_photons.hpp>
struct photon { glm::vec3 position, power; };
int main()
{
    photongrid::$4 device;
    const std::vector<photon> photons{{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {1, 1, 1}}, {{0, 1, 0}, {1, 1, 1}}};
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, photons), 2);
    const auto points = photongrid::upload_points(device, std::vector<glm::vec3>{{0.2f, 0.3f, 0}});
    return device.download(photongrid::knn_grid_estimate(device, map, points, {.k = 2}).irradiance)[0].x > 0 ? 0 : 1;
}
CPP
}
include "GLM alone" glm glm/glm.hpp
include "core: one algorithm" photongrid photongrid/estimate/knn_grid_estimate.hpp
include "core: maps, estimates, lists" photongrid photongrid/map/map_builders.hpp photongrid/estimate/knn_grid_estimate.hpp photongrid/estimate/knn_neighbours.hpp photongrid/map/own_photons.hpp
include "core: everything" photongrid photongrid/render/render.hpp photongrid/map/map_file.hpp photongrid/map/own_photons.hpp
headers=${#names[@]}
for backend in "${backends[@]}"; do
  program "$backend" "photongrid-$backend" "$backend/$backend.hpp" "${backend}_backend"
done
if [[ " ${backends[*]} " == *" cpu "* ]]; then
  program "cpu, by kernels" photongrid-cpu cpu/cpu_by_kernels.hpp cpu_by_kernels
fi

for ((run = 0; run < runs; ++run)); do
  for ((n = 1; n <= ${#names[@]}; ++n)); do
    read -ra flags <<<"$(pkg-config --cflags "${packages[n - 1]}")"
    begin=$(date +%s%N)
    g++ -std=c++20 -O2 "${flags[@]}" -c "$work/$n.cpp" -o "$work/$n.o" || exit 2 # broken, not too slow
    echo $((($(date +%s%N) - begin) / 1000000)) >>"$work/$n.ms"
  done
done

seconds() { printf '%d.%02d' $(($1 / 1000)) $(($1 % 1000 / 10)); }
echo "| included | compiled, s | over GLM, s | stripped program, kB |"
echo "|---|---|---|---|"
status=0
for ((n = 1; n <= ${#names[@]}; ++n)); do
  ms=$(sort -n "$work/$n.ms" | sed -n "$(((runs + 1) / 2))p")
  if ((n == 1)); then
    glm=$ms
  fi
  size=
  if ((n > headers)); then
    read -ra libraries <<<"$(pkg-config --libs "${packages[n - 1]}")"
    g++ "$work/$n.o" -s -o "$work/$n.out" "${libraries[@]}" || exit 2
    size=$(($(stat -c %s "$work/$n.out") / 1000))
  fi
  printf '| %s | %s | %s | %s |\n' "${names[n - 1]}" "$(seconds "$ms")" "$(seconds $((ms - glm)))" "$size"
  if ((n > 1 && n <= headers - 1 && ms >= 1500)); then
    status=1
  fi
done
printf '\nThe core'\''s maps, estimates and lists in less than 1.5 s: %s\n' "$( ((status == 0)) && echo PASS || echo FAIL)"
exit $status
