#!/usr/bin/env bash
# Compares this tree with another commit: whether pictures are still the same, byte for byte, and nothing has become slower.
# Prints Markdown; fails where a picture differs or a row is slower.
#
#   bench/against.sh [REV] [--pictures] [--speed] [--quick] [--built BASE_PROGRAM HEAD_PROGRAM]
#
#   REV         the other commit, the base; default: d8c29df
#   --pictures  every scene on every backend with every kind of estimate, small: PFM and PNG byte for byte, and an EXR's pixels and
#               layers (its notes may differ). What may differ is in bench/against_exceptions.txt
#   --speed     whole pictures by stage, sorts and searches, both trees in turn: medians, and what base takes over what head takes,
#               0.97 wanted, of the medians or of the least times: other work on the machine only adds. What misses it is measured
#               twice more. Stages of less than 5 ms get no verdict, the whole picture does
#   --quick     fewer pictures (under two minutes), little to measure (to see that it runs)
#   --built     builds nothing and takes these programs; sorts and searches where they are built too, in bench/ beside a program
#               or in build-bench/ beside its folder
#
# Both draw the scenes as they are in REV. Without --pictures and --speed: both. Unless --built is given, REV is checked out in build-against/tree; both trees are built in their build/
# (the preset release) and, for --speed, their build-bench/.
# Exit status: 1 where a picture differs or a row is too slow, 2 where something is broken.
# It is one file because pictures and times are compared for the same two trees, programs and options.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() { sed -n '2,20s/^# \{0,1\}//p' bench/against.sh; }
die() {
  echo "bench/against.sh: $*" >&2
  exit 2
}
rev='' pictures=no speed=no quick=no built=no
declare -A program
while (($#)); do
  case $1 in
    --pictures) pictures=yes ;;
    --speed) speed=yes ;;
    --quick) quick=yes ;;
    --built)
      (($# >= 3)) || die "--built wants two programs, BASE_PROGRAM HEAD_PROGRAM"
      built=yes program[base]=$(cd "$here" && realpath "$2") program[head]=$(cd "$here" && realpath "$3")
      shift 2
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    *)
      [[ -z $rev && $1 != -* ]] || { usage >&2 && exit 2; }
      rev=$1
      ;;
  esac
  shift
done
[[ $pictures == yes || $speed == yes ]] || pictures=yes speed=yes
asked=${rev:-d8c29df}
rev=$(git rev-parse --verify --quiet "$asked^{commit}") || die "$asked: no such commit here"
scenes=(cornell_box cornell_blocks ring glass_ball)

# What the base calls options that have been renamed since; a line for each word.
option_for_base() {
  local word
  for word; do
    if [[ $old_words == yes ]]; then
      case $word in
        --filter) word=--kernel ;;
        *min_cosine* | *flattening*) word=${word//min_cosine/normals} word=${word//flattening/disc} ;;
      esac
    fi
    echo "$word"
  done
}

export NODEVICE_SELECT=1 # the implicit layer has crashed processes that start side by side
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# --- both programs ---
# build_tree FOLDER
build_tree() {
  local launcher=() targets='search_times algorithms'
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  (
    cd "$1"
    export CCACHE_BASEDIR=$PWD # what is the same in both trees compiles once
    cmake --preset release --log-level=WARNING "${launcher[@]}"
    cmake --build build --target photongrid_program
    if [[ $speed == yes ]]; then
      cmake -S . -B build-bench -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DPHOTONGRID_BENCH=ON -DPHOTONGRID_TESTS=OFF "${launcher[@]}"
      if [[ $quick == no && $(cmake --build build-bench --target help) == *$'\nknn_peers:'* ]]; then
        targets+=' knn_peers' # wants CGAL, FLANN and nanoflann
      fi
      # shellcheck disable=SC2086
      cmake --build build-bench --target $targets
    fi
  ) >&2
}
if [[ $built == no ]]; then
  tree=build-against/tree
  if [[ -e $tree/.git ]]; then
    git -C $tree checkout --quiet --detach "$rev"
  else
    mkdir -p build-against
    git worktree add --quiet --force --detach $tree "$rev"
  fi
  build_tree $tree
  build_tree .
  program=([base]=$PWD/$tree/build/photongrid [head]=$PWD/build/photongrid)
fi
for side in base head; do
  [[ -x ${program[$side]} ]] || die "${program[$side]}: no such program"
  mkdir "$work/$side"
done
for scene in "${scenes[@]}"; do
  git show "$rev:examples/scenes/$scene.json" >"$work/base/$scene.json"
  cp "$work/base/$scene.json" "$work/head/$scene.json"
done
old_words=no # of November 2026
[[ $("${program[base]}" render --help) == *--filter* ]] || old_words=yes
base_routes_power=no # before --surplus, routed maps redistributed power alone
[[ $("${program[base]}" render --help) == *--surplus* ]] || base_routes_power=yes
echo "base: $(git log -1 --format='%h %s' "$rev")"
echo "head: $(git log -1 --format='%h %s')$(git diff --quiet HEAD || echo ', and what is not committed')"
if [[ $built == yes ]]; then
  echo "Programs: ${program[base]} and ${program[head]}"
fi
failed=0

# --- pictures ---
# draw SIDE SCENE BACKEND OPTION...: picture.{pfm,png,exr} in the side's folder, and its exit status; "reference" is a backend here
draw() {
  local side=$1 scene=$2 backend=$3 status=0
  shift 3
  local folder=$work/$side options=("$@")
  if [[ $backend == reference ]]; then
    options=(reference "$folder/$scene.json" --spp 4 --paths 100000 "${options[@]}")
  else
    options=(render "$folder/$scene.json" --backend "$backend" --shader-cache "$folder/cache" "${options[@]}")
    [[ " $* " == *' --photons '* ]] || options+=(--photons 2000)
  fi
  options+=(--size 64x48 --quiet -o "$folder/picture.pfm" -o "$folder/picture.png" -o "$folder/picture.exr")
  if [[ $side == base ]]; then
    mapfile -t options < <(option_for_base "${options[@]}")
  elif [[ $base_routes_power == yes && " $* " == *' --map route '* ]]; then
    options+=(--surplus power)
  fi
  rm -f "$folder"/picture.*
  "${program[$side]}" "${options[@]}" >"$folder/log" 2>&1 || status=$?
  echo $status >"$folder/status"
}
# pixels_at EXR: where its blocks of pixels begin. Magic and version, attributes (name, type, size, value), a 0, then the table of
# the blocks' places.
pixels_at() {
  od -An -v -tu1 -w1 -N 65536 "$1" | awk '
    function word(at) { return b[at] + 256 * (b[at + 1] + 256 * (b[at + 2] + 256 * b[at + 3])) }
    { b[NR - 1] = $1 }
    END {
      for (at = 8; b[at]; at += 4 + word(at))
        for (text = 0; text < 2; ++text)
          while (b[at++]) {}
      print word(at + 1)
    }'
}
same_exr() { cmp -s <(tail -c +$(($(pixels_at "$1") + 1)) "$1") <(tail -c +$(($(pixels_at "$2") + 1)) "$2"); }
# difference: of the two pictures drawn last, in words; nothing where they are the same
difference() {
  local base=$work/base/picture head=$work/head/picture files='' pixels header
  if ! cmp -s "$base.pfm" "$head.pfm"; then
    if [[ $(head -n 2 "$base.pfm" | tail -n 1) != $(head -n 2 "$head.pfm" | tail -n 1) ]]; then
      echo "another size"
      return
    fi
    header=$(head -n 3 "$base.pfm" | wc -c)
    pixels=$({ cmp -l "$base.pfm" "$head.pfm" || true; } | awk -v header="$header" '{ at = int(($1 - 1 - header) / 12); n += !(at in seen); seen[at] } END { print n + 0 }')
    echo -n "$pixels of $((($(wc -c <"$base.pfm") - header) / 12)) pixels, relMSE $("${program[head]}" compare "$head.pfm" "$base.pfm" | awk '$1 == "relMSE" { print $2 }')"
    return
  fi
  cmp -s "$base.png" "$head.png" || files+=" PNG"
  same_exr "$base.exr" "$head.exr" || files+=" EXR"
  [[ -z $files ]] || echo "the same light, but not its${files/G E/G and E}"
}
# exception NAME: the number of the first line of bench/against_exceptions.txt whose pattern is the picture's; fails without one
exception() {
  local i
  for i in "${!patterns[@]}"; do
    # shellcheck disable=SC2053 # a pattern
    if [[ $1 == ${patterns[i]} ]]; then
      echo "$i"
      return
    fi
  done
  return 1
}
patterns=() reasons=() met=()
while IFS= read -r line; do
  [[ $line =~ ^[[:space:]]*(#|$) ]] && continue
  [[ $line =~ ^(.*[^[:space:]])[[:space:]]*\|[[:space:]]*(.+)$ ]] || die "bench/against_exceptions.txt: \"$line\": expected PATTERN | REASON"
  patterns+=("${BASH_REMATCH[1]}") reasons+=("${BASH_REMATCH[2]}")
done <bench/against_exceptions.txt

all=0 same=0 differ=0 excepted=0 absent=0
# picture SCENE BACKEND [OPTION...]: draws it with both and prints a row
picture() {
  local name="$*" cells="| $1 | $2 | ${3:+\`${*:3}\`} |" status what='' line side
  draw base "$@" &
  draw head "$@"
  wait $!
  status="$(<"$work/base/status") $(<"$work/head/status")"
  if [[ $status == "4 4" ]]; then
    absent=$((absent + 1))
    echo "$cells not drawn: $(head -n 1 "$work/head/log") |"
    return
  fi
  all=$((all + 1))
  if [[ $status == "0 0" ]]; then
    what=$(difference)
  else
    what="exit statuses $status"
    for side in base head; do
      [[ $(<"$work/$side/status") == 0 ]] || what+="; $side: $(head -n 1 "$work/$side/log")"
    done
  fi
  if [[ -z $what ]]; then
    same=$((same + 1))
    what=same
  elif [[ $status == *" 0" ]] && line=$(exception "$name"); then
    excepted=$((excepted + 1)) met[line]=yes
    what="differs: $what; known: ${reasons[line]}"
  else
    differ=$((differ + 1))
    what="**differs**: $what"
  fi
  echo "$cells $what |"
}
if [[ $pictures == yes ]]; then
  # Options of every scene on every backend; of one scene on every backend; of one scene on one.
  everywhere=("" "--as-paper" "--map route" "--as-paper --map route" "--aov" "--spp 2" "--only caustic" "--depth 2" "--depth 2 --as-paper --map route")
  once=(
    "--seed 7" "--photons 100000" "--photons 100000 --map route" "--grid auto --k 8" "--map route --slots 2" "--exposure 1 --depth 2 --light-samples 1"
    "--search at_least_k" "--search fixed_radius --max-radius 0.2" "--as-paper --search exact_k" "--as-paper --search fixed_radius --max-radius 0.2 --map route"
    "--filter constant" "--filter cone" "--filter epanechnikov --bias paper" "--filter cone --search at_least_k --aov"
    "--leaks none" "--leaks side,min_cosine=0.7" "--leaks side,flattening=2 --map route"
    "--leaks side,min_cosine --edge-correction polygons" "--leaks side,min_cosine --edge-correction polygons --filter constant --search at_least_k"
    "--only direct" "--only indirect"
  )
  others=("cpu --threads 1" "cpu --threads 3" "cpu --threads 3 --photons 100000" "gl-osmesa" "reference" "reference --caustics bins" "reference --seed 7")
  backends=(serial cpu gl vulkan)
  echo
  echo "| scene | backend | options | |"
  echo "|---|---|---|---|"
  for scene in "${scenes[@]}"; do
    for backend in "${backends[@]}"; do
      chosen=("${everywhere[@]}")
      if [[ $quick == yes && $backend == @(gl|vulkan) ]]; then
        [[ $scene == @(ring|cornell_blocks) ]] || continue
        chosen=("" "--as-paper --map route")
      fi
      for options in "${chosen[@]}"; do
        # shellcheck disable=SC2086
        picture "$scene" "$backend" $options
      done
    done
  done
  for backend in "${backends[@]}"; do
    [[ $quick == no || $backend != @(gl|vulkan) ]] || continue
    for options in "${once[@]}"; do
      # shellcheck disable=SC2086
      picture cornell_blocks "$backend" $options
    done
  done
  for options in "${others[@]}"; do
    [[ $quick == no || $options != gl-osmesa ]] || continue
    # shellcheck disable=SC2086
    picture ring $options
  done
  echo
  for i in "${!patterns[@]}"; do
    [[ $quick == yes || -n ${met[i]:-} ]] || echo "No picture differs by the exception \"${patterns[i]}\"."
  done
  echo "$all pictures: $same the same, $differ differ$( ((excepted == 0)) || echo ", $excepted differ as bench/against_exceptions.txt says")$( ((absent == 0)) || echo "; $absent more not drawn, neither program has the backend here")"
  ((same + differ + excepted > 0)) || die "no picture could be compared"
  ((differ == 0)) || failed=1
fi

# --- speed ---
# measured SIDE NAME...: appends "NAME TAB SIDE TAB ms" to $work/times for every line "NAME TAB ms" on standard input
measured() { awk -F '\t' -v OFS='\t' -v side="$1" '{ print $1, side, $2 }' >>"$work/times"; }
# ratios: rows of the medians of $work/times, in its order
ratios() {
  awk -F '\t' '
    function sorted(what, side,    n, i, j, t) {
      n = count[what, side]
      for (i = 1; i <= n; ++i) v[i] = times[what, side, i]
      for (i = 2; i <= n; ++i) for (j = i; j > 1 && v[j] < v[j - 1]; --j) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
      median[side] = n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
      least[side] = v[1]
    }
    function over(a, b) { return b > 0 ? a / b : a > 0 ? 999 : 1 }
    !($1 in known) { known[$1]; name[++names] = $1 }
    { times[$1, $2, ++count[$1, $2]] = $3 + 0 }
    END {
      for (i = 1; i <= names; ++i) {
        if (!count[name[i], "base"] || !count[name[i], "head"]) {
          printf "| %s | | | | | only %s has it |\n", name[i], (count[name[i], "base"] ? "base" : "head")
          continue
        }
        sorted(name[i], "base"); sorted(name[i], "head")
        ratio = over(median["base"], median["head"]); of_least = over(least["base"], least["head"])
        verdict = ratio >= 0.97 || of_least >= 0.97 ? "PASS" : "FAIL"
        if (name[i] ~ /: / && median["base"] < 5 && median["head"] < 5) verdict = "short" # a stage
        printf "| %s | %.3f | %.3f | %.3f | %.3f | %s |\n", name[i], median["base"], median["head"], ratio, of_least, verdict
      }
    }' "$work/times"
}
# bench_program SIDE NAME: where it is; fails where it is not
bench_program() {
  local folder
  folder=$(dirname "${program[$1]}")
  for folder in "$folder/bench" "$folder/../build-bench/bench"; do
    if [[ -x $folder/$2 ]]; then
      realpath "$folder/$2"
      return
    fi
  done
  return 1
}
# Before abc5a39 the first step of a search (kth_guess) counted among trace_rays, since then among radiance_estimate; and since
# 026727c total_ms holds the loading of drivers. With a base from before these, only sums can be compared.
stage_times='(.stages | to_entries[] | [.key, .value.ms]), ["all but compiling", .total_ms - .compile_ms]'
git merge-base --is-ancestor 026727c "$rev" || stage_times='.stages | ["trace_photons", .trace_photons.ms], ["build_map", .build_map.ms],
  ["trace_rays and radiance_estimate", .trace_rays.ms + .radiance_estimate.ms], ["all stages", (map(.ms) | add)]'
# What follows measures a side once: lines "NAME TAB ms". Whether a bench's own ratios are as wanted does not matter here.
# whole_picture SIDE SCENE BACKEND
whole_picture() {
  local folder=$work/$1 options begin end
  options=(render "$folder/$2.json" --backend "$3" --size "$size" --shader-cache "$folder/cache" --stats "$folder/stats.json" --quiet -o "$folder/picture.pfm")
  [[ $1 == head ]] || mapfile -t options < <(option_for_base "${options[@]}")
  begin=$EPOCHREALTIME
  "${program[$1]}" "${options[@]}" >/dev/null
  end=$EPOCHREALTIME
  jq -r --arg name "$2, $3" "($stage_times)"' | ["\($name): \(.[0])", .[1]] | @tsv' "$folder/stats.json"
  awk -v name="$2, $3" -v a="$begin" -v b="$end" 'BEGIN { printf "%s: the whole program\t%.3f\n", name, 1000 * (b - a) }'
}
# algorithms SIDE
# shellcheck disable=SC2317 # rows calls it
algorithms() {
  "$(bench_program "$1" algorithms)" --benchmark_format=json --benchmark_min_time="$seconds" \
    --benchmark_filter="^(bitonic_sort|sorted_map|stencil_route)/(serial|cpu|gl|vulkan)/photons:$photons/ands:0/" 2>/dev/null |
    jq -r '.benchmarks[] | select(.error_occurred | not) | [(.name | split("/")[0:3] | join(", ")), .real_time] | @tsv'
}
# search_times SIDE
# shellcheck disable=SC2317 # rows calls it
search_times() {
  { "$(bench_program "$1" search_times)" "$repetitions" cpu "$points" || (($? == 1)); } |
    awk -F ' *[|] *' -v OFS='\t' '$2 == "cpu" { print "S3, cpu, " $3 ", at_least_k, a thousand points", 1000 / $4; print "S3, cpu, " $3 ", exact_k, a thousand points", 1000 / $5 }'
}
# knn_peers SIDE
# shellcheck disable=SC2317 # rows calls it
knn_peers() {
  { "$(bench_program "$1" knn_peers)" --seconds 0.05 || (($? == 1)); } |
    awk -F ' *[|] *' -v OFS='\t' '$2 ~ /^S[1-5]$/ { print $2 ", cpu, one thread, exact_k, a thousand points", 1000 / $6; print $2 ", cpu, one thread, map", $11 }'
}
# rows COMMAND [ARGUMENT...]: measures both sides in turn and prints rows
rows() {
  local what=$1 attempt round side
  shift
  for side in base head; do
    [[ $what == whole_picture ]] || bench_program $side "$what" >/dev/null || { echo "| $what | | | | | not measured: ${program[$side]} has none beside it |" && return; }
  done
  if [[ $what == whole_picture ]]; then # compiles
    whole_picture base "$@" >/dev/null
    whole_picture head "$@" >/dev/null
  fi
  : >"$work/times"
  for ((attempt = 0; attempt < attempts; ++attempt)); do
    for ((round = 0; round < rounds; ++round)); do
      for side in $( ((round % 2)) && echo head base || echo base head); do
        "$what" "$side" "$@" >"$work/once"
        measured "$side" <"$work/once"
      done
    done
    ratios >"$work/rows"
    grep -q 'FAIL' "$work/rows" || break
  done
  cat "$work/rows"
  ! grep -q 'FAIL' "$work/rows" || failed=1
}
if [[ $speed == yes ]]; then
  rounds=5 attempts=3 size=160x120 photons=262144 seconds=0.1 repetitions=3 points=20000
  if [[ $quick == yes ]]; then
    rounds=1 attempts=1 size=64x48 photons=4096 seconds=0.001 repetitions=1 points=200
  fi
  command -v jq >/dev/null || die "--speed needs jq; apt-get install jq"
  awk -v cores="$(nproc)" '$1 > cores / 4 { print "\nThe machine is busy, load " $1 " on " cores " cores: times are not to be relied on." }' /proc/loadavg
  echo
  echo "| what | base, ms | head, ms | base over head | of the least | |"
  echo "|---|---|---|---|---|---|"
  for scene in cornell_box ring; do
    for backend in cpu vulkan gl serial; do
      rows whole_picture "$scene" "$backend"
    done
  done
  rows algorithms
  rows search_times
  [[ $quick == yes ]] || rows knn_peers
fi
exit $failed
