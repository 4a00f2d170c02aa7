#!/usr/bin/env bash
# Checks the commands that README.md, CONTRIBUTING.md and docs/**/*.md show, indented or in backticks, without running them:
# their scripts exist and can be executed, and the presets, targets, test programs, folders, files and options that they name
# exist. page.cmake runs those of build/photongrid; the others take too long for a test.
#
#   tests/doc_commands.sh
#
# Prints what is wrong as PAGE:LINE and exits 1.
# shellcheck disable=SC2001,SC2016 # commands are split by sed; a variable is CMake's
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mapfile -t pages < <(find README.md CONTRIBUTING.md docs -name '*.md' | sort)

# What CMake's files call by name: targets, options, tests.
cmake_names=$(find CMakeLists.txt cmake tests bench backends examples include \( -name CMakeLists.txt -o -name '*.cmake' \) -print0 |
  xargs -0 sed 's/#.*//' | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u)
program_options=$({
  grep -ohE -e '"--[a-z][a-z-]*' examples/photongrid/{command_line,error_options,scene_options}.cpp | tr -d '"'
  sed -n 's/.* setting \([a-z_]*\)\b.*/--\1/p' include/photongrid/scene/setting_table.hpp | tr _ -
} | sort -u)

# preset_names KIND: of CMakePresets.json, KIND is configurePresets, buildPresets or testPresets
preset_names() { awk -v kind="\"$1\":" '/^  "/ { inside = $1 == kind } inside' CMakePresets.json | sed -n 's/.*"name": "\([^"]*\)".*/\1/p'; }
folders=$(sed -n 's|.*"binaryDir": "${sourceDir}/\([^"]*\)".*|\1|p' CMakePresets.json)
folders+=$'\nbuild-bench' # bench/run.sh makes it
usage_of() { awk 'NR > 1 && !/^#/ { exit } { print }' "$1"; }

failed=0
wrong() {
  echo "$place: \`$command\`: $1"
  failed=1
}
# has LIST NAME
has() { grep -qxF -e "$2" <<<"$1"; }
folder() { has "$folders" "${1%/}" || wrong "no preset builds in $1"; }
# shellcheck disable=SC2034 # option_of_tool reads them
cmake_help=$({ cmake --help; cmake --build; cmake --install; } 2>&1 || true) ctest_help=$(ctest --help)
option_of_tool() {
  local help=${1}_help
  grep -qE -e "(^|[ ,])$2([] =<,]|$)" <<<"${!help}" || wrong "$1 has no option $2"
}

check_script() {
  local script=${1#./} usage word name
  shift
  [[ -r $script && $(head -c 2 "$script") != "#!" ]] && return 0 # a file that scripts source
  [[ -x $script ]] || { wrong "$script is not a script that can be executed"; return 0; }
  usage=$(usage_of "$script")
  for word; do
    name=${word%%=*}
    [[ $name == --[a-z]* ]] || continue
    grep -qE -e "(^|[^a-z-])$name([^a-z-]|$)" <<<"$usage" && continue
    [[ $usage == *"options of \`photongrid"* ]] && has "$program_options" "$name" && continue
    [[ $usage == *"OPTION...]"* ]] || wrong "the usage text of $script has no $name"
  done
}
check_program() { # of a build folder
  local path=${1#./} name=${1##*/} word
  shift
  folder "${path%%/*}"
  case $path in
    */photongrid)
      for word; do
        word=${word%%=*}
        [[ $word != --[a-z]* ]] || has "$program_options" "$word" || wrong "photongrid has no option $word"
      done
      ;;
    */bench/photongrid_bench*) grep -qF "add(\"${1:-}\"" bench/main.cpp || wrong "bench/main.cpp has no verb ${1:-}" ;;
    */tests/* | */bench/*) has "$cmake_names" "$name" || wrong "no CMakeLists.txt names $name" ;;
  esac
}
check_cmake() { # cmake or ctest
  local tool=$1 kind=configurePresets after='' word
  shift
  [[ $tool == cmake ]] || kind=testPresets
  [[ " $* " != *" --build "* ]] || after=first_of_build
  for word; do
    case $word in
      --target) after=target; continue ;;
      --preset | --build | --test-dir | -S | -B) after=$word ;;
      -D?*)
        word=${word#-D}
        word=${word%%[=:]*}
        [[ $word == CMAKE_* ]] || has "$cmake_names" "$word" || wrong "no CMakeLists.txt names $word"
        ;;
      --*)
        after=''
        option_of_tool "$tool" "${word%%=*}"
        ;;
      -*) after='' ;;
      *)
        case $after in
          target)
            has "$cmake_names" "$word" || wrong "no target is called $word"
            continue
            ;;
          --preset)
            if [[ " $* " == *" --build "* ]]; then kind=buildPresets; fi
            has "$(preset_names $kind)" "$word" || wrong "CMakePresets.json has no $word among its $kind"
            ;;
          --build | --test-dir | -B) folder "$word" ;;
        esac
        after=''
        ;;
    esac
  done
}

# The commands of a page: LINE, a tab, the command.
commands_of() {
  awk '
    function show(text) {
      sub(/(  +|\t)#.*/, "", text)
      print FNR "\t" text
    }
    /^```/ { fenced = !fenced; open = "" }
    fenced { next }
    /^    [^ ]/ { open = ""; show(substr($0, 5)); next }
    {
      line = open == "" ? $0 : open " " $0
      open = ""
      if ($0 == "")
        next
      while (match(line, /`[^`]+`/)) {
        show(substr(line, RSTART + 1, RLENGTH - 2))
        line = substr(line, 1, RSTART - 1) " " substr(line, RSTART + RLENGTH)
      }
      if (index(line, "`"))
        open = substr(line, index(line, "`"))
    }' "$1" |
    grep -E $'\t'"([A-Z_]+=[^ ]* +)*((\./)?(tests|bench|examples)/[a-z_0-9]+\.sh|(\./)?build[a-z-]*/[a-z_/0-9]+|cmake|ctest|doxygen|mkdir|git|clang-format-14)( |$)" || true
}

checked=0
for page in "${pages[@]}"; do
  while IFS=$'\t' read -r line text; do
    place=$page:$line
    while IFS= read -r command; do
      read -r -a words <<<"${command//[\'\"]/}"
      while [[ ${words[0]:-} =~ ^[A-Z_]+= ]]; do words=("${words[@]:1}"); done
      ((${#words[@]})) || continue
      checked=$((checked + 1))
      case ${words[0]} in
        *.sh) check_script "${words[@]}" ;;
        build*/* | ./build*/*) check_program "${words[@]}" ;;
        cmake | ctest) check_cmake "${words[@]}" ;;
      esac
      for word in "${words[@]:1}"; do
        word=${word#*=}
        if [[ $word =~ ^(\./)?(docs|examples|tests|bench|include|backends|cmake)/ && $word != *[A-Z][A-Z]* && $word != *[*]* && ! -e $word ]]; then
          wrong "there is no $word"
        fi
      done
    done < <(sed 's/ *\(&&\||\|;\) */\n/g' <<<"$text") # one command a line
  done < <(commands_of "$page")
done
((failed == 0)) || exit 1
echo "doc_commands: $checked commands"
