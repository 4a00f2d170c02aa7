#!/usr/bin/env bash
# Speed and error, measured. Prints Markdown; fails where a row misses what it must reach.
#
#   bench/run.sh [--algorithms] [--peers] [--paper] [--interactive] [--estimates] [--error] [--convergence] [--inclusion] [--files] [--write] [--no-install]     some of it, or all
#   bench/run.sh --gpu [--no-install]               each part that a device runs, on the hardware devices of vulkan and gl; refuses software
#   bench/run.sh --smoke [--no-install]             all of it on little data, to see that it runs
#
#   --algorithms  each algorithm on each backend by number of photons and entropy of keys: JSON and plots in out/algorithms/
#   --peers       neighbour searches and sorts against CGAL, FLANN, nanoflann, std::sort, Highway's vqsort, TBB; sorting passes
#                 on vulkan and gl against plain ones; whole pictures, the ring and the ball against POV-Ray; plots in out/clustered_peers/
#   --paper       the paper's Tables 1 and 2, what leaving out finished elements gains, our defaults beside the paper's method
#   --interactive how soon a change is seen, and when a picture looks converged
#   --estimates   error and cost of searches, filters, leak policies and edge correction, on whole pictures
#   --error       time against relMSE of every kind of estimate: CSV and plots in out/error/
#   --convergence time to error against other programs, which bench/peers.sh builds in $PHOTONGRID_PEERS: CSV and plots in
#                 out/time_to_error/
#   --inclusion   what including the headers costs a user's compiler, and the size of the smallest programs
#   --files       how fast scene files are read, and with how much memory
#   --write       puts what is printed, and the Cornell box's plot, into docs/ too (bench/write_measures.sh)
#
# Whether another commit drew the same pictures as this tree, and as fast: bench/against.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

usage() {
  sed -n '2,22s/^# \{0,1\}//p' bench/run.sh >&2
  exit 2
}
build=build-bench
install=yes gpu=no smoke=no write=no parts=()
for argument in "$@"; do
  case $argument in
    --algorithms | --peers | --paper | --interactive | --estimates | --error | --convergence | --inclusion | --files)
      parts+=("${argument#--}")
      ;;
    --gpu) gpu=yes ;;
    --smoke) smoke=yes ;;
    --write) write=yes ;;
    --no-install) install=no ;;
    *) usage ;;
  esac
done
((${#parts[@]})) || parts=(algorithms peers paper interactive estimates error convergence inclusion files)
asked() { [[ " ${parts[*]} " == *" $1 "* ]]; }
packages=("${program_packages[@]}" "${smoke_packages[@]}" "${bench_packages[@]}")
[[ $smoke == yes ]] || ! asked peers || packages+=(povray)
require_packages "$install" "${packages[@]}"

export NODEVICE_SELECT=1 # the implicit layer has crashed processes that start side by side
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S . -B $build -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DPHOTONGRID_BENCH=ON -DPHOTONGRID_TESTS=OFF "${launcher[@]}" >&2
cmake --build $build >&2
export PHOTONGRID_BUILD=$build PHOTONGRID=$build/photongrid

version() { dpkg-query --show --showformat '${Package} ${Version}, ' "$@" 2>/dev/null || true; }
machine() {
  echo "Machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; $(date +%F); $(g++ --version | head -n 1); $(version libcgal-dev libflann-dev libnanoflann-dev libhwy-dev libtbb-dev mesa-vulkan-drivers povray)photongrid $(git rev-parse --short HEAD 2>/dev/null || echo "of no repository")"
}
title() { printf '\n### %s\n\n' "$1"; }
if [[ $write == yes ]]; then
  if [[ $smoke == yes || $gpu == yes ]]; then
    usage
  fi
  mkdir -p out
  status=0
  bench/run.sh --no-install "${parts[@]/#/--}" | tee out/measured.md || status=$?
  if ((status > 1)); then
    exit $status # something is broken: what was printed is not whole
  fi
  bench/write_measures.sh out/measured.md
  [[ ! -e .git ]] || bench/write_measures.sh --mark
  if asked error; then
    cp out/error/cornell_box.svg docs/error_cornell_box.svg
  fi
  exit $status
fi
failed=0
# must COMMAND...: an exit status of 1 is a row that is too slow; more is something broken
must() {
  local status=0
  "$@" || status=$?
  if [[ $smoke == yes && $status == 1 ]]; then
    status=0 # times do not count
  fi
  failed=$((failed > status ? failed : status))
}
# loses_a_quarter_at_most NATIVE PLAIN: what knn_peers and knn_peers_portable printed, set by set
loses_a_quarter_at_most() {
  awk -F ' *[|] *' '
    FNR == 1 { ++file }
    $2 !~ /^S[1-5]$/ { next }
    file == 1 { native[$2] = $6; next }
    file == 2 && !shown++ { print "| set | native, 1000/s | plain, 1000/s | plain over native | wanted | |\n|---|---|---|---|---|---|" }
    { share = $6 / native[$2]; printf "| %s | %s | %s | %.2f | 0.75 | %s |\n", $2, native[$2], $6, share, (share >= 0.75 ? "PASS" : "FAIL"); slow += (share < 0.75) }
    END { exit (slow > 0) }' "$1" "$2"
}

# time_to_error OPTION...: against the other programs that there are
# shellcheck disable=SC2317 # `must` calls it
time_to_error() {
  command -v python3 >/dev/null || { echo "bench/run.sh: SKIPPED time to error against other programs: no python3" >&2; return; }
  python3 bench/time_to_error.py "$@"
}

machine
if [[ $gpu == yes ]]; then
  # `photongrid devices` prints each device of a backend, then, indented, whether it is hardware and its limits.
  mapfile -t backends < <($build/photongrid devices | awk '/^[a-z]/ { name = $1 } /^ +hardware,/ && !seen[name]++ && name ~ /^(vulkan|gl)$/ { print name }')
  if ((${#backends[@]} == 0)); then
    echo "bench/run.sh --gpu: no hardware device of vulkan or gl here; \`photongrid devices\` lists what there is" >&2
    exit 2
  fi
  echo
  $build/photongrid devices
  for backend in "${backends[@]}"; do
    title "Algorithms on $backend"
    must bench/algorithms.sh "--benchmark_filter=/$backend/" --benchmark_min_time=0.1
    title "Nearest neighbours on $backend"
    must $build/bench/knn_peers --backend "$backend"
    title "Exact k against at least k on $backend"
    must $build/bench/search_times 3 "$backend"
    title "Waiting on $backend (3.4)"
    must $build/bench/interactive examples/scenes/cornell_box.json 9 "$backend"
  done
  if ((${#backends[@]} == 2)); then # these measure both
    title "Sorting passes on vulkan and gl"
    must $build/bench/sort_passes
    title "Finished elements (3.3, 4.3)"
    must $build/bench/unfinished
  fi
  if [[ " ${backends[*]} " == *" vulkan "* ]]; then
    title "Table 2"
    must $build/bench/kernel_costs
  fi
  title "Table 1"
  must bench/table1.sh "${backends[@]}"
  title "Whole pictures, by stage, as the device's clock has them"
  for backend in "${backends[@]}"; do
    for scene in cornell_box ring glass_ball terrace; do
      for run in first second third; do
        $build/photongrid render "examples/scenes/$scene.json" --backend "$backend" --passes 1 --time-passes --stats $build/stats.json -o $build/picture.pfm --quiet >/dev/null
        echo "$scene, $backend, $run run: $(awk '/"(trace_photons|build_map|trace_rays|radiance_estimate)":/ { name = $1 } $1 == "\"ms\":" && name != "" { gsub(",", "", $2); printf "%s %.2f ms; ", name, $2; name = "" }' $build/stats.json)"
      done
    done
  done
  title "Time to visual convergence (3.1)"
  must bench/convergence.sh "${backends[@]}"
  title "The window (3.4)"
  must bench/window.sh "${backends[@]}"
  title "Time against error"
  must bench/error.sh "${backends[@]}"
  exit $failed
fi
if [[ $smoke == yes ]]; then
  must bench/algorithms.sh '--benchmark_filter=photons:4096/ands:0/' --benchmark_min_time=0.001
  must $build/bench/sort_passes 4096
  must bench/pictures.sh --quick
  must $build/bench/kernel_costs
  must $build/bench/unfinished --quick
  must $build/bench/scene_files 1 1 1
  must $build/bench/hashed_routing --quick
  must bench/convergence.sh --quick cpu
  must bench/defaults.sh --quick
  must bench/lamps.sh --quick
  must bench/final_gather.sh --quick
  must bench/inclusion.sh --smoke
  must $build/bench/interactive examples/scenes/cornell_box.json 1 cpu
  must bench/window.sh cpu
  must $build/bench/search_times 1 vulkan 1000
  must $build/bench/mesh_pictures --triangles 1000
  must $build/bench/mesh_pictures --triangles 1100 --places 4
  must $build/bench/knn_peers --sets 1 --seconds 0.05
  must $build/bench/knn_peers_portable --sets 1 --seconds 0.05
  must bench/clustered_peers.sh --photons 2000 --k 10 --seconds 0.01
  must $build/bench/clustered_maps --photons 2000 --k 10 --seconds 0.005 --sets sphere,nested
  must $build/bench/sort_peers 1 65536
  must bench/estimator_errors.sh --quick
  must bench/edge_correction.sh --quick
  must bench/error.sh --quick
  must time_to_error --quick
  exit $failed
fi
if asked inclusion; then
  title "What including it costs"
  must bench/inclusion.sh
fi
if asked files; then
  title "Reading scene files"
  must $build/bench/scene_files
fi
if asked algorithms; then
  title "Algorithms"
  must bench/algorithms.sh --benchmark_min_time=0.1
fi
if asked peers; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  title "Nearest neighbours, one thread"
  must $build/bench/knn_peers >"$work/native"
  cat "$work/native"
  title "Nearest neighbours, two threads"
  must $build/bench/knn_peers --threads 2
  title "Nearest neighbours, points in random order, half of each ratio wanted"
  must $build/bench/knn_peers --shuffle
  title "Nearest neighbours, a plain build (-O2, no -march): both sides, run-time dispatch on ours"
  must $build/bench/knn_peers_portable >"$work/plain"
  cat "$work/plain"
  title "A plain build against a native one"
  must loses_a_quarter_at_most "$work/native" "$work/plain"
  title "Nearest neighbours, the same build without AVX-512, half of each ratio wanted"
  must $build/bench/knn_peers_portable --avx2
  title "Nearest neighbours on vulkan and gl, S3, two threads"
  must $build/bench/knn_peers --backend vulkan --threads 2 --sets 3
  echo
  must $build/bench/knn_peers --backend gl --threads 2 --sets 3
  title "Nearest neighbours among photons in clusters, one thread"
  must bench/clustered_peers.sh
  title "Grids and blocks for photons in clusters"
  must $build/bench/clustered_maps
  title "Exact k against at least k, by grid"
  must $build/bench/search_times
  title "Sorting pairs, one thread"
  must $build/bench/sort_peers 1
  title "Sorting passes on vulkan and gl"
  must $build/bench/sort_passes
  title "Whole pictures"
  must bench/pictures.sh
  title "The ring's caustic against POV-Ray"
  must bench/povray_ring.sh
fi
if asked paper; then
  title "Table 1"
  must bench/table1.sh cpu serial vulkan gl
  title "Table 2"
  must $build/bench/kernel_costs
  title "Finished elements (3.3, 4.3)"
  must $build/bench/unfinished
  title "Defaults beside the paper's method"
  must bench/defaults.sh
fi
if asked interactive; then
  title "Time to visual convergence (3.1)"
  must bench/convergence.sh
  title "Waiting (3.4)"
  must $build/bench/interactive examples/scenes/cornell_box.json 9 cpu vulkan
  title "The window (3.4)"
  must bench/window.sh
fi
if asked estimates; then
  title "Error and cost of each kind of estimate"
  must bench/estimator_errors.sh
  title "Edge correction"
  must bench/edge_correction.sh
  title "One lamp and a hundred"
  must bench/lamps.sh
  title "Indirect light and caustics: one map, a final gather, shrinking radii"
  must bench/final_gather.sh
fi
if asked error; then
  title "Time against error"
  must bench/error.sh
fi
if asked convergence; then
  title "Time to error against other programs"
  must time_to_error
fi
exit $failed
