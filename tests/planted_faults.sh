#!/usr/bin/env bash
# Do the tests see what they should? Plants one fault at a time in a copy of the sources, builds the serial tests and
# expects them to fail. Run by tests/run.sh --full; needs the packages that it installs.
#
#   tests/planted_faults.sh [FAULT...]     only those whose name contains one of these words
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$PWD/build-faults
mkdir -p "$work"
rm -rf "$work/tree"
mkdir "$work/tree"
tar -c --exclude='./build*' --exclude=./out --exclude=./.git . | tar -x -C "$work/tree"

# name | file | what to replace | by what (plain text, which must be there)
faults=(
  "sort loses ties|include/photongrid/kernels/bitonic_step.glsl|(mine.x == partner.x && mine.y < partner.y)|mine.x == partner.x"
  "sort ignores values|include/photongrid/kernels/bitonic_step.glsl| \|\| (mine.x == partner.x && mine.y < partner.y)|"
  "index off by one|include/photongrid/kernels/first_in_cell.glsl|keys_below(i + 1u) - first|keys_below(i + 1u) - first + (first > 3u ? 1u : 0u)"
  "index takes equal keys|include/photongrid/kernels/first_in_cell.glsl|.x < key|.x <= key"
  "routing keeps one less|backends/serial/serial.hpp|arrived[d] < capacity|arrived[d] + 1 < capacity"
  "routing drops surplus power|include/photongrid/kernels/routed_cell.glsl|scale.y = total.y / sum.y|scale.y = 1.0f"
  "routing draws in order of id|include/photongrid/kernels/route_photon.glsl|permuted(i, args.photons, args.seed)|i"
  "search ends a ring early|include/photongrid/kernels/knn_visit.glsl|reach * reach > limit2)|reach * reach > 0.25f * limit2)"
  "search takes all within the maximum radius|include/photongrid/kernels/knn_visit.glsl|d2 <= (held < args.wanted ? args.max_radius2 : radius2)|d2 <= args.max_radius2"
  "search skips the last photon|include/photongrid/kernels/knn_visit.glsl|end = final.x + final.y;|end = final.x + final.y - (final.y > 4u ? 1u : 0u);"
  "cells without clamp at the top|include/photongrid/kernels/grid.glsl|f = f < last ? f : last;|f = f < last + 1.0f ? f : last + 1.0f;"
  "wrong normalisation|include/photongrid/kernels/knn_result.glsl|3.14159265f|3.0f"
  "direct light stored too|include/photongrid/kernels/tally_path.glsl|frame == 1u|frame == 0u"
  "power not divided by survival|include/photongrid/kernels/bounce_photon.glsl|(material.x / survival)|material.x"
  "one path forgotten|include/photongrid/trace_photons.hpp|p.emitted = t.emitted;|p.emitted = t.emitted - 1;"
  "Fresnel without polarisation|include/photongrid/kernels/scene_hit.glsl|0.5f * (parallel * parallel + perpendicular * perpendicular)|parallel * parallel"
  "lamp twice as bright|include/photongrid/kernels/direct_light.glsl|3.18309886e-1f * share|6.36619772e-1f * share"
)

cmake -S "$work/tree" -B "$work/build" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DPHOTONGRID_TESTS=ON -DPHOTONGRID_GL=OFF -DPHOTONGRID_VULKAN=OFF
suite() { cmake --build "$work/build" --target on_serial >"$work/log" 2>&1 && RC_PARAMS=seed=20031 "$work/build/tests/on_serial" --gtest_filter='-*long_*:*scene_files*' >"$work/log" 2>&1; }
echo "== no fault"
suite || { tail -n 30 "$work/log"; echo "planted_faults: the tests fail without any fault" >&2; exit 1; }

caught=0 missed=0
for fault in "${faults[@]}"; do
  name=${fault%%|*} rest=${fault#*|}
  file=${rest%%|*} rest=${rest#*|}
  # The separator is a bar, so bars inside are written \|.
  rest=${rest//\\|/$'\001'}
  from=${rest%%|*} to=${rest#*|}
  from=${from//$'\001'/|} to=${to//$'\001'/|}
  wanted=yes
  for word in "$@"; do
    wanted=no
    if [[ $name == *$word* ]]; then wanted=yes; break; fi
  done
  [[ $wanted == yes ]] || continue
  text=$(cat "$work/tree/$file")
  if [[ $text != *"$from"* ]]; then
    echo "planted_faults: '$name': $file no longer holds: $from" >&2
    exit 1
  fi
  printf '%s\n' "${text/"$from"/"$to"}" >"$work/tree/$file"
  if suite; then
    echo "MISSED  $name"
    missed=$((missed + 1))
  else
    echo "caught  $name: $(grep -oE '^\[  FAILED  \] [^ ,]+' "$work/log" | sed 's/.*\.//' | sort -u | tr '\n' ' ' | cut -c 1-110)"
    grep -q '\[  FAILED  \]' "$work/log" || tail -n 3 "$work/log" | sed 's/^/        /'
    caught=$((caught + 1))
  fi
  printf '%s\n' "$text" >"$work/tree/$file"
done
echo "$caught passed, $missed failed"
((missed == 0))
