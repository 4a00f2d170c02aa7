#!/usr/bin/env bash
# Whole pictures of the three scenes with Table 1's counts and our estimate, without the time that kernels take to compile, and
# POV-Ray's of the ring and the glass ball: same size, as many photons sent at what makes the caustic as we store, two threads on a machine of two cores, no antialiasing.
# Prints a Markdown table; exits 1 where one is too slow.
#
#   bench/pictures.sh [--quick | REPETITIONS]      default: 5; --quick: small pictures, once, without POV-Ray, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid bench/povray_ring
declare -A photons=([ring]=16000 [glass_ball]=5000)
repetitions=${1:-5} size=()
if [[ $repetitions == --quick ]]; then
  repetitions=1 size=(--size 64x48) photons=()
else
  need_povray
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
median() { sort -n | awk '{ v[NR] = $1 } END { printf "%.2f", v[int((NR + 1) / 2)] }'; }
# ours SCENE BACKEND: seconds of one run
ours() {
  # shellcheck disable=SC2046,SC2086
  "$build/photongrid" render "examples/scenes/$1.json" "${size[@]}" --spp 1 $(paper_counts "$1") $plain_estimate --backend "$2" --shader-cache "$work/cache" --stats "$work/stats.json" --quiet -o "$work/picture.pfm" >/dev/null
  seconds_of "$work/stats.json"
}
# theirs SCENE PHOTONS: seconds of one run
theirs() {
  "$build/bench/povray_ring" export "examples/scenes/$1.json" "$2" >"$work/$1.pov"
  local begin=$EPOCHREALTIME
  povray "+I$work/$1.pov" "+O$work/$1.exr" +FE +W512 +H384 -D -A -GA +WT2 >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }
  awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.3f\n", b - a }'
}
declare -A wanted=([cornell_box,cpu]=2.5 [ring,cpu]=0.4 [glass_ball,cpu]=0.4 [cornell_box,vulkan]=8 [ring,vulkan]=1.5 [glass_ball,vulkan]=1.5)
failed=0
echo "| scene | cpu, s | wanted | | vulkan, s | wanted | | POV-Ray, s | over cpu | |"
echo "|---|---|---|---|---|---|---|---|---|---|"
for scene in cornell_box ring glass_ball; do
  : >"$work/cpu" >"$work/vulkan" >"$work/povray"
  ours "$scene" vulkan >/dev/null # compiles
  for ((r = 0; r < repetitions; ++r)); do
    ours "$scene" cpu >>"$work/cpu"
    ours "$scene" vulkan >>"$work/vulkan"
    [[ -z ${photons[$scene]:-} ]] || theirs "$scene" "${photons[$scene]}" >>"$work/povray"
  done
  row="| $scene |"
  for backend in cpu vulkan; do
    seconds=$(median <"$work/$backend") most=${wanted[$scene,$backend]}
    verdict=$(awk -v s="$seconds" -v m="$most" 'BEGIN { print (s <= m ? "PASS" : "FAIL") }')
    row+=" $seconds | $most | $verdict |"
    [[ $verdict == PASS ]] || failed=1
    [[ $backend != cpu ]] || cpu=$seconds
  done
  if [[ -n ${photons[$scene]:-} ]]; then
    seconds=$(median <"$work/povray")
    ratio=$(awk -v a="$seconds" -v b="$cpu" 'BEGIN { printf "%.1f", a / b }')
    verdict=$(awk -v r="$ratio" 'BEGIN { print (r >= 1 ? "PASS" : "FAIL") }')
    row+=" $seconds | $ratio | $verdict |"
    [[ $verdict == PASS ]] || failed=1
  else
    row+=" | | |"
  fi
  echo "$row"
done
exit $failed
