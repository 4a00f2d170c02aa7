#!/usr/bin/env bash
# Fuzzes the readers of scenes, format by format, and prints how many inputs each has read.
#
#   tests/fuzz.sh [--seconds N | --inputs N] [--folder FOLDER] [FORMAT...]
#
#   --seconds N      for each format (20)
#   --inputs N       as many for each format, however long it takes
#   --folder FOLDER  a build folder: build-fuzz/ (optimized) if not given, which is configured first
#   FORMAT           folders of tests/io/scene_corpus; all if none is given
#
# New inputs that reach new code stay in FOLDER/corpus/FORMAT, where the next run starts from them. An input that breaks
# a guarantee stops its format and is kept as FOLDER/FORMAT-crash-… (or -timeout-…, -oom-…): once its cause is mended, it
# belongs in tests/io/scene_corpus/FORMAT. The exit status is then 1.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  sed -n '2,/^set /s/^# \{0,1\}//p' tests/fuzz.sh
  exit "$1"
}
limit=(-max_total_time=20) folder=build-fuzz formats=()
while (($# > 0)); do
  case $1 in
    --seconds | --inputs | --folder)
      [[ -n ${2:-} ]] || usage 2 >&2
      case $1 in
        --seconds) limit=("-max_total_time=$2") ;;
        --inputs) limit=("-runs=$2") ;;
        --folder) folder=$2 ;;
      esac
      shift
      ;;
    -h | --help) usage 0 ;;
    *)
      [[ -d tests/io/scene_corpus/$1 ]] || usage 2 >&2
      formats+=("$1")
      ;;
  esac
  shift
done
if ((${#formats[@]} == 0)); then
  formats=(photongrid pbrt mitsuba gltf obj ply)
fi

if [[ $folder == build-fuzz ]]; then
  launcher=()
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  cmake --preset fuzz --log-level=WARNING "${launcher[@]}"
fi
cmake --build "$folder" --target fuzz_scene
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Each input has 20 s, for machines that do other work too, and 1 GiB; no allocation is larger than 256 MiB. Without
# -entropic=0 the fuzzer takes as long to choose an input as the readers take to read it.
total=0 found=0
printf '| format | inputs | a second | found |\n|---|---|---|---|\n'
for format in "${formats[@]}"; do
  mkdir -p "$folder/corpus/$format"
  status=0
  "$folder/tests/fuzz_scene" "--format=$format" -verbosity=0 -print_final_stats=1 -entropic=0 -max_len=4096 \
    -timeout=20 -rss_limit_mb=1024 -malloc_limit_mb=256 "${limit[@]}" "-dict=tests/io/scene_corpus/$format.dict" \
    "-artifact_prefix=$folder/$format-" "$folder/corpus/$format" "tests/io/scene_corpus/$format" \
    >"$work/output" 2>&1 || status=$?
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/output")
  rate=$(sed -n 's/^stat::average_exec_per_sec: *//p' "$work/output")
  printf '| %s | %s | %s | %s |\n' "$format" "${inputs:-?}" "${rate:-?}" "$((status != 0))"
  if ((status != 0)); then
    cat "$work/output" >&2
    found=1
  fi
  total=$((total + ${inputs:-0}))
done
printf '| all | %s | | %s |\n' "$total" "$found"
exit $found
