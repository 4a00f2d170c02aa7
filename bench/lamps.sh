#!/usr/bin/env bash
# Direct light of one lamp and of a hundred, of which each shadow ray chooses one: a floor with a ball and a box, lit by
# lamps of the same power in all. Prints a Markdown table: seconds of a whole picture without compiling kernels, medians
# of runs in turn; and the error of each picture (relMSE) against one of 16 times as many samples. Exits 1 where a
# hundred lamps take over 3 times as long as one.
#
#   bench/lamps.sh [BACKEND [REPETITIONS]]      default: cpu 5
#   bench/lamps.sh --quick                      tiny pictures, once, to see that it runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source bench/programs.sh
need photongrid
backend=${1:-cpu} repetitions=${2:-5} size=160,120 samples=4
if [[ $backend == --quick ]]; then
  backend=cpu repetitions=1 size=32,24
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# lamps KIND SIDE: a scene of SIDE x SIDE lamps, 100 W together
lamps() {
  awk -v kind="$1" -v side="$2" -v size="$size" 'BEGIN {
    print "{\"photongrid\": 1, \"name\": \"lamps\", \"units\": {\"length\": \"m\", \"power\": \"W\"},"
    print "\"camera\": {\"position\": [0, 1.6, -4], \"look_at\": [0, 0.4, 0], \"vertical_fov\": 45},"
    print "\"materials\": {\"white\": {\"type\": \"lambertian\", \"reflectance\": 0.7}},"
    print "\"shapes\": [{\"type\": \"polygon\", \"vertices\": [[-3, 0, -3], [-3, 0, 3], [3, 0, 3], [3, 0, -3]], \"material\": \"white\"},"
    print "{\"type\": \"sphere\", \"center\": [0, 0.5, 0], \"radius\": 0.5, \"material\": \"white\"},"
    print "{\"type\": \"box\", \"corner\": [1, 0, 0.3], \"edge_u\": [0.6, 0, 0], \"edge_v\": [0, 0.8, 0], \"edge_w\": [0, 0, 0.6], \"material\": \"white\"}],"
    print "\"lights\": ["
    for (i = 0; i < side * side; ++i) {
      x = -2.8 + 5.6 * (i % side + 0.5) / side
      z = -2.8 + 5.6 * (int(i / side) + 0.5) / side
      place = kind == "point" ? "\"position\": [" x ", 2.5, " z "]" : "\"corner\": [" x ", 2.5, " z "], \"edge_u\": [0.1, 0, 0], \"edge_v\": [0, 0, 0.1]"
      print (i ? "," : "") "{\"type\": \"" kind "\", " place ", \"power\": " 100 / (side * side) "}"
    }
    print "], \"render\": {\"size\": [" size "], \"photons\": 1000, \"k\": 20, \"max_radius\": 1}}"
  }'
}
# drawn SCENE SAMPLES PICTURE: draws a scene and prints the seconds that took
drawn() {
  "$build/photongrid" render "$work/$1.json" --backend "$backend" --shader-cache "$work/cache" --spp "$2" --stats "$work/stats.json" --quiet -o "$3" >/dev/null
  seconds_of "$work/stats.json"
}

failed=0
echo "$backend, $samples samples a pixel, ${size/,/ x }."
echo
echo "| lamps | one, s | a hundred, s | ratio | at most | relMSE of one | of a hundred | |"
echo "|---|---|---|---|---|---|---|---|"
for kind in rectangle point; do
  for side in 1 10; do
    lamps $kind $side >"$work/$side.json"
    drawn $side $((16 * samples)) "$work/$side-many.pfm" >/dev/null
  done
  for ((run = 0; run <= repetitions; ++run)); do # the first run compiles
    for side in 1 10; do
      drawn $side $samples "$work/$side.pfm" >>"$work/$kind-$side-times"
    done
  done
  one=$(tail -n +2 "$work/$kind-1-times" | median) many=$(tail -n +2 "$work/$kind-10-times" | median)
  for side in 1 10; do
    error[side]=$("$build/photongrid" compare "$work/$side.pfm" "$work/$side-many.pfm" | awk '$1 == "relMSE" { print $2 }')
  done
  verdict=$(awk -v a="$one" -v b="$many" 'BEGIN { print b <= 3 * a ? "PASS" : "FAIL" }')
  [[ $verdict == PASS ]] || failed=1
  echo "| $kind | $one | $many | $(awk -v a="$one" -v b="$many" 'BEGIN { printf "%.2f", b / a }') | 3 | ${error[1]} | ${error[10]} | $verdict |"
done
exit $failed
