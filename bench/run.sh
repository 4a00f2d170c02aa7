#!/usr/bin/env bash
# Speed and error, measured. Prints Markdown; fails where a row misses what it must reach.
#
#   bench/run.sh [--algorithms] [--peers] [--paper] [--interactive] [--estimates] [--error] [--convergence]
#                [--inclusion] [--files] [--write] [--no-install]     some of it, or all
#   bench/run.sh --gpu [--write] [--no-install]     each part that a device runs, on the hardware devices of vulkan and
#                                                   gl; refuses software
#   bench/run.sh --smoke [--no-install]             all of it on little data, to see that it runs
#
#   --algorithms  each algorithm on each backend by number of photons and entropy of keys: JSON and plots in out/algorithms/
#   --peers       neighbour searches and sorts against CGAL, FLANN, nanoflann, std::sort, Highway's vqsort, TBB; sorting passes
#                 on vulkan and gl against plain ones; whole pictures, the ring and the ball against POV-Ray; plots in out/clusters/
#   --paper       the paper's Tables 1 and 2, what leaving out finished elements gains, our defaults beside the paper's method
#   --interactive how soon a change is seen, and when a picture looks converged
#   --estimates   error and cost of searches, filters, leak policies and edge correction, on whole pictures
#   --error       time against relMSE of every kind of estimate: CSV and plots in out/error/
#   --convergence time to error against other programs, those that the folder $PHOTONGRID_PEERS has: CSV and plots in
#                 out/time_to_error/; scenes' settings against a random search
#   --inclusion   what including the headers costs a user's compiler, and the size of the smallest programs
#   --files       how fast scene files are read, and with how much memory
#   --write       puts what is printed into bench/results/ and docs/reference/measures.md too (bench/results.py), and the
#                 Cornell box's plot into docs/
#
# Whether another commit drew the same pictures as this tree, and as fast: bench/against.py.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

usage() {
  sed -n '2,25s/^# \{0,1\}//p' bench/run.sh >&2
  exit 2
}
build="build-bench"
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
# title TITLE COMMAND: a section begins, which COMMAND prints
title() { printf '\n### %s\n\nCommand: %s\n\n' "$1$([[ $gpu == no ]] || echo ', hardware GPU')" "$2"; }
if [[ $write == yes ]]; then
  [[ $smoke == no ]] || usage
  command -v python3 >/dev/null || { echo "bench/run.sh --write: no python3; apt-get install python3" >&2; exit 2; }
  git rev-parse HEAD >/dev/null 2>&1 || { echo "bench/run.sh --write: not a repository; measures name their commit" >&2; exit 2; }
  again=("${parts[@]/#/--}")
  [[ $gpu == no ]] || again=(--gpu)
  mkdir -p out
  status=0
  bench/run.sh --no-install "${again[@]}" | tee out/measured.md || status=$?
  if ((status > 1)); then
    exit $status # something is broken: what was printed is not whole
  fi
  bench/results.py take out/measured.md || status=$?
  bench/results.py page
  if [[ $gpu == no ]] && asked error; then
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
# measure TITLE COMMAND...: a section of a command that must hold
measure() {
  title "$1" "${*:2}"
  must "${@:2}"
}
# loses_a_quarter_at_most NATIVE PLAIN: what `search` of both programs printed, set by set
# shellcheck disable=SC2317 # `must` calls it
loses_a_quarter_at_most() {
  awk -F ' *[|] *' '
    FNR == 1 { ++file }
    $2 !~ /^S[1-5]$/ { next }
    file == 1 { native[$2] = $6; next }
    file == 2 && !shown++ { print "| set | native, 1000/s | plain, 1000/s | plain over native | wanted | |\n|---|---|---|---|---|---|" }
    { share = $6 / native[$2]; printf "| %s | %s | %s | %.2f | 0.75 | %s |\n", $2, native[$2], $6, share, (share >= 0.75 ? "PASS" : "FAIL"); slow += (share < 0.75) }
    END { exit (slow > 0) }' "$1" "$2"
}
bench=$build/bench/photongrid_bench native=$build/bench/photongrid_bench_native sections=bench/sections.py
box=examples/scenes/cornell_box.json

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
    measure "Algorithms on $backend" $sections algorithms "--benchmark_filter=/$backend/" --benchmark_min_time=0.1
    measure "Nearest neighbours on $backend" $native search --backend "$backend"
    measure "Exact k against at least k on $backend" $bench grids --backends "$backend"
    measure "Waiting on $backend (3.4)" $bench interactive $box "$backend"
  done
  if ((${#backends[@]} == 2)); then # these measure both
    measure "Sorting passes on vulkan and gl" $bench passes
    measure "Finished elements (3.3, 4.3)" $bench unfinished
  fi
  if [[ " ${backends[*]} " == *" vulkan "* ]]; then
    measure "Table 2" $bench kernels
  fi
  measure "Table 1" $sections table1 "${backends[@]}"
  measure "Whole pictures, by stage, as the device's clock has them" $sections stages "${backends[@]}"
  measure "Time to visual convergence (3.1)" $sections convergence "${backends[@]}"
  measure "The window (3.4)" $sections window "${backends[@]}"
  measure "Time against error" $sections error "${backends[@]}"
  exit $failed
fi
if [[ $smoke == yes ]]; then
  for section in algorithms clusters defaults edges error estimates gather inclusion lamps panes pictures strips \
    water window; do
    must $sections $section --quick
  done
  must $sections convergence --quick cpu
  must $sections table1 --quick serial
  must $bench files --ply 1 --obj 1 --glb 1
  must $bench grids --repetitions 1 --backends vulkan --points 1000
  must $bench interactive $box cpu --repetitions 1
  must $bench kernels
  must $bench maps --photons 2000 --k 10 --seconds 0.005 --sets sphere,nested
  must $bench passes --pairs 4096
  must $bench pictures --triangles 1000
  must $bench pictures --triangles 1100 --places 4
  must $bench unfinished --quick
  must $bench search --sets 1 --seconds 0.05
  must $native search --sets 1 --seconds 0.05
  must $native sort --most 65536
  must python3 bench/time_to_error.py --quick
  must python3 bench/best_settings.py --size 16 --seconds 0.2 --tries 2 --repeats 1 --spp 4 $box
  exit $failed
fi
if asked inclusion; then
  measure "What including it costs" $sections inclusion
fi
if asked files; then
  measure "Reading scene files" $bench files
fi
if asked algorithms; then
  measure "Algorithms" $sections algorithms --benchmark_min_time=0.1
fi
if asked peers; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  measure "Nearest neighbours, one thread" $native search >"$work/native"
  cat "$work/native"
  measure "Nearest neighbours, two threads" $native search --threads 2
  measure "Nearest neighbours, points in random order, half of each ratio wanted" $native search --shuffle
  measure "Nearest neighbours, a plain build (no -march): both sides, run-time dispatch on ours" $bench search >"$work/plain"
  cat "$work/plain"
  title "A plain build against a native one" "bench/run.sh --peers"
  must loses_a_quarter_at_most "$work/native" "$work/plain"
  measure "Nearest neighbours, the same build without AVX-512, half of each ratio wanted" $bench search --avx2
  measure "Nearest neighbours on vulkan and gl, S3, two threads" $native search --backend vulkan --threads 2 --sets 3
  echo
  must $native search --backend gl --threads 2 --sets 3
  measure "Nearest neighbours among photons in clusters, one thread" $sections clusters
  measure "Grids and blocks for photons in clusters" $bench maps
  measure "Exact k against at least k, by grid" $bench grids
  measure "Sorting pairs, one thread" $native sort
  measure "Sorting passes on vulkan and gl" $bench passes
  measure "Whole pictures" $sections pictures
  measure "The ring's caustic against POV-Ray" $sections ring
fi
if asked paper; then
  measure "Table 1" $sections table1 cpu serial vulkan gl
  measure "Table 2" $bench kernels
  measure "Finished elements (3.3, 4.3)" $bench unfinished
  measure "Defaults beside the paper's method" $sections defaults
fi
if asked interactive; then
  measure "Time to visual convergence (3.1)" $sections convergence
  measure "Waiting (3.4)" $bench interactive $box cpu vulkan
  measure "The window (3.4)" $sections window
fi
if asked estimates; then
  measure "Error and cost of each kind of estimate" $sections estimates
  measure "Edge correction" $sections edges
  measure "Brightness along edges" $sections strips
  measure "One lamp and a hundred" $sections lamps
  measure "Surfaces under a pane of glass" $sections panes
  measure "A glass of water with ice" $sections water
  measure "Indirect light and caustics: one map, a final gather, shrinking radii" $sections gather
fi
if asked error; then
  measure "Time against error" $sections error
fi
if asked convergence; then
  measure "Time to error against other programs" python3 bench/time_to_error.py
  measure "Automatic numbers against a random search" python3 bench/best_settings.py
fi
exit $failed
