#!/usr/bin/env bash
# Time against error of every way to estimate: searches, filters, k, numbers of photons, map builders, backends; on the three
# scenes with the paper's eye rays and shadow rays (against `photongrid reference`) and on fields of light with a known answer.
# Writes scenes.csv, fields.csv and plots (SVG and PNG, gnuplot) to out/error/. The last column says whether a row is on its
# scene's Pareto front: none is both faster and more exact.
#
#   bench/error.sh [--quick] [BACKEND...]       --quick: a few rows, to see that it runs; BACKEND: those beside cpu, default serial gl vulkan
#
# bench/run.sh --error installs what is missing, builds and calls this.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
quick=no
if [[ ${1:-} == --quick ]]; then
  quick=yes
  shift
fi
backends=("$@")
((${#backends[@]})) || backends=(serial gl vulkan)
source bench/programs.sh
need photongrid bench/field_errors
program=$build/photongrid
fields=$build/bench/field_errors
out=out/error
mkdir -p $out
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=128x96

# with_front < CSV with a header, seconds and relmse last but one and last: adds a column "front"
with_front() {
  awk -F, -v OFS=, '
    NR == 1 { print $0, "front"; next }
    { row[NR] = $0; place[NR] = $1; seconds[NR] = $(NF - 1); error[NR] = $NF }
    END {
      for (r = 2; r <= NR; ++r) {
        front = 1
        for (o = 2; front && o <= NR; ++o)
          if (place[o] == place[r] && seconds[o] <= seconds[r] && error[o] <= error[r] && (seconds[o] < seconds[r] || error[o] < error[r]))
            front = 0
        print row[r], front
      }
    }'
}

# figure KEY: the first number at KEY in the last run's statistics
figure() { awk -v key="\"$1\":" '$1 == key { gsub(",", "", $2); print $2; exit }' "$work/stats.json"; }

# row SCENE BACKEND MAP SEARCH FILTER K PHOTONS [OPTION...]: renders, and prints a line of CSV; seconds are the four stages', kernels compiled apart
row() {
  local scene=$1 backend=$2 map=$3 search=$4 filter=$5 k=$6 photons=$7
  local samples
  samples=$(paper_count "$scene" light_samples)
  shift 7
  # shellcheck disable=SC2086
  "$program" render "examples/scenes/$scene.json" --backend "$backend" --size $size --map "$map" --search "$search" --filter "$filter" --k "$k" --photons "$photons" --grid auto --spp 1 $one_map ${samples:+--light-samples $samples} $plain_estimate --stats "$work/stats.json" -o "$work/picture.exr" --quiet "$@" >/dev/null
  local seconds relmse
  seconds=$(awk '$1 == "\"ms\":" && inside { gsub(",", "", $2); sum += $2 } $1 == "\"stages\":" { inside = 1 } $1 == "\"estimate\":" { inside = 0 } END { printf "%.5f", sum / 1000 }' "$work/stats.json")
  relmse=$("$program" compare "$work/picture.exr" "$out/$scene-reference.exr" | awk '$1 == "relMSE" { print $2 }')
  echo "$scene,$backend,$map,$search,$filter,$k,$photons,$seconds,$relmse"
}

scene_rows() {
  echo "scene,backend,map,search,filter,k,photons,seconds,relmse"
  local scene photons k factor divisor search filter backend radius
  for scene in cornell_box ring glass_ball; do
    if [[ ! -e $out/$scene-reference.exr ]]; then
      "$program" reference "examples/scenes/$scene.json" --size $size --spp $([[ $quick == yes ]] && echo 16 || echo 512) --paths $([[ $quick == yes ]] && echo 100000 || echo 10000000) -o "$out/$scene-reference.exr" --quiet >/dev/null
    fi
    # The paper's.
    photons=$(paper_count "$scene" photons)
    k=$(paper_count "$scene" k)
    for factor in 1 4 16; do
      for divisor in 16 4 1; do
        [[ $quick == no || $factor$divisor == 116 ]] || continue
        local n=$((photons * factor / 4)) m=$((k / divisor))
        ((m >= 2)) || continue
        row $scene cpu sort exact_k silverman $m $n
        radius=$(figure mean_radius)
        for search in exact_k at_least_k fixed_radius; do
          local more=()
          [[ $search == fixed_radius ]] && more=(--max-radius "$radius")
          for filter in constant cone epanechnikov silverman; do
            [[ $search$filter != exact_ksilverman ]] || continue
            row $scene cpu sort $search $filter $m $n "${more[@]}"
          done
        done
        row $scene cpu route exact_k silverman $m $n
        ((factor < 16)) || continue # software GPUs take their time
        for backend in "${backends[@]}"; do
          row $scene $backend sort exact_k silverman $m $n
        done
      done
    done
  done
}

[[ $quick == yes ]] && rm -f $out/*-reference.exr
scene_rows | with_front >$out/scenes.csv
"$fields" $([[ $quick == yes ]] && echo --quick) "${backends[@]}" | awk -F, -v OFS=, 'NR == 1 { print $1, $2, $3, $4, $5, $6, $7, "seconds", $10; next } { print $1, $2, $3, $4, $5, $6, $7, $8 + $9, $10 }' | with_front >$out/fields.csv
[[ $quick == yes ]] && rm -f $out/*-reference.exr # drawn with few samples

# plot CSV PLACE TITLE: one picture, backends by colour, the front as a line
plot() {
  local csv=$1 place=$2 title=$3 kind
  awk -F, -v OFS=, -v place="$place" 'NR == 1 || $1 == place' "$csv" >"$work/plot.csv"
  awk -F, '$NF == 1' "$work/plot.csv" | sort -t, -k8,8g >"$work/front.csv"
  for kind in svg png; do
    gnuplot <<END
set terminal $([[ $kind == svg ]] && echo 'svg size 720,480 font "sans,13" background "white"' || echo 'pngcairo size 1080,720 font "sans,18"')
set output "$out/$place.$kind"
set datafile separator ","
set logscale xy
set format x "%g"
set format y "10^{%T}"
set xlabel "seconds"
set ylabel "relMSE"
set title "$title"
set key outside right top
set grid
plot "< grep ',serial,' $work/plot.csv" using 8:9 with points pt 4 lc rgb "#888888" title "serial", \
  "< grep ',gl,' $work/plot.csv" using 8:9 with points pt 6 lc rgb "#2a7fff" title "gl", \
  "< grep ',vulkan,' $work/plot.csv" using 8:9 with points pt 8 lc rgb "#c03030" title "vulkan", \
  "< grep ',cpu,sort,at_least_k,' $work/plot.csv" using 8:9 with points pt 1 lc rgb "#d08020" title "cpu, at\\\\_least\\\\_k", \
  "< grep ',cpu,sort,fixed_radius,' $work/plot.csv" using 8:9 with points pt 2 lc rgb "#309030" title "cpu, fixed\\\\_radius", \
  "< grep ',cpu,.*,exact_k,' $work/plot.csv" using 8:9 with points pt 7 ps 0.8 lc rgb "#000000" title "cpu, exact\\\\_k", \
  "$work/front.csv" using 8:9 with lines lw 1.5 lc rgb "#000000" title "Pareto front"
END
  done
}
for scene in cornell_box ring glass_ball; do
  plot $out/scenes.csv $scene "${scene//_/ }, $size, the whole picture"
done
for field in even ramp waves disc; do
  plot $out/fields.csv $field "$field: 4,096 points, map and search"
done
# front CSV: how many rows of each backend and search no other row beats
front() { awk -F, 'NR > 1 && $NF == 1 { print $2 " `" $4 "`" }' "$1" | sort | uniq -c | sort -rn | awk '{ printf "%s%s %s of %s", separator, $1, $3, $2; separator = ", " }'; }
echo "On the Pareto fronts of the scenes: $(front $out/scenes.csv). Of the fields: $(front $out/fields.csv)."
echo
echo "Rows: $(($(wc -l <$out/scenes.csv) - 1)) in $out/scenes.csv, $(($(wc -l <$out/fields.csv) - 1)) in $out/fields.csv; plots: $out/*.svg, $out/*.png"
