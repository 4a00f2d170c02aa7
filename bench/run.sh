#!/usr/bin/env bash
# Speed against that of others, in one run. Prints Markdown with PASS or FAIL per row and fails where a row does.
#
#   bench/run.sh --peers [--no-install]     neighbour searches and sorts against CGAL, FLANN, nanoflann, std::sort, Highway, TBB
#   bench/run.sh --smoke [--no-install]     the same on the smallest data, to see that it runs; ratios do not count
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes what=
for argument in "$@"; do
  case $argument in
    --peers | --smoke) what=${argument#--} ;;
    --no-install) install=no ;;
    *)
      sed -n '2,5s/^# \{0,1\}//p' bench/run.sh >&2
      exit 2
      ;;
  esac
done
[[ -n $what ]] || { sed -n '2,5s/^# \{0,1\}//p' bench/run.sh >&2; exit 2; }
require_packages "$install" "${program_packages[@]}" libcgal-dev libflann-dev libnanoflann-dev

# gl and vulkan take no part, so they need not be there.
cmake -S . -B build-bench -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DPHOTONGRID_BENCH=ON -DPHOTONGRID_TESTS=OFF -DPHOTONGRID_GL=OFF -DPHOTONGRID_VULKAN=OFF >&2
cmake --build build-bench --target knn_peers knn_peers_portable sort_peers >&2

version() { dpkg-query --show --showformat '${Package} ${Version}, ' "$@" 2>/dev/null || true; }
echo "Machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; $(date +%F); $(g++ --version | head -n 1); $(version libcgal-dev libflann-dev libnanoflann-dev libhwy-dev libtbb-dev)photongrid $(git rev-parse --short HEAD 2>/dev/null || echo "of no repository")"
echo
failed=0
if [[ $what == smoke ]]; then
  build-bench/bench/knn_peers --sets 1 --seconds 0.05 || failed=$?
  build-bench/bench/sort_peers 1 65536 || failed=$((failed > $? ? failed : $?))
  # 1 is too slow; anything else is wrong or broken.
  exit $((failed > 1 ? failed : 0))
fi
title() { printf '\n### %s\n\n' "$1"; }
title "Nearest neighbours, one thread"
build-bench/bench/knn_peers || failed=1
title "Nearest neighbours, two threads"
build-bench/bench/knn_peers --threads 2 || failed=1
title "Nearest neighbours, points in random order, half of each ratio wanted"
build-bench/bench/knn_peers --shuffle || failed=1
title "Nearest neighbours, a plain build (-O2, no -march): both sides, run-time dispatch on ours"
build-bench/bench/knn_peers_portable || failed=1
title "Sorting pairs, one thread"
build-bench/bench/sort_peers 1 || failed=1
exit $failed
