# shellcheck shell=bash
# Sourced by tests/run.sh: parts of the tests, built with g++ in build-tests/.

# programs_in FOLDER: the test programs of a folder of tests/
programs_in() { sed -n 's/^ *photongrid_test(\([a-z_]*\).*/\1/p' "tests/$1/CMakeLists.txt"; }

# suites_in FOLDER: patterns of the suites of a folder of tests/ that on_serial runs: those for every backend, and plain
# ones of headers that no program of the folder includes
suites_in() {
  local header
  for header in "tests/$1"/*.hpp; do
    [[ -e $header ]] || break
    sed -n 's|^TYPED_TEST_SUITE_P(\([a-z0-9_]*\));.*|*/\1/*|p' "$header"
    grep -qsF "\"${header##*/}\"" "tests/$1"/*.cpp || sed -n 's/^TEST(\([a-z0-9_]*\),.*/\1.*/p' "$header"
  done | sort -u
}

# run_cases PROGRAM FILTER: of a program that is built; notes in `matched` that there are any
matched=no
run_cases() {
  local cases
  cases=$("build-tests/tests/$1" --gtest_list_tests --gtest_filter="$2")
  grep -q '^  ' <<<"$cases" || return 0
  matched=yes
  RC_PARAMS=seed=20031 XDG_CACHE_HOME=$PWD/build-tests/tests/cache "build-tests/tests/$1" --gtest_brief=1 --gtest_filter="$2"
}

# run_part NAME [WORD...]: the tests of a backend, a folder or a program; those with one of the words in their names
run_part() {
  local name=$1 programs=() suites=() filter="" word suite program
  shift
  case $name in
    serial | cpu | gl | vulkan) readarray -t programs < <(programs_in backends | grep -E "(^|_)$name(_|\$)") ;;
    *)
      if [[ -d tests/$name ]]; then
        readarray -t programs < <([[ ! -r tests/$name/CMakeLists.txt ]] || programs_in "$name")
        readarray -t suites < <(suites_in "$name")
      elif sed -n 's/^ *photongrid_test(//p' tests/*/CMakeLists.txt | grep -q "^$name\b"; then
        programs=("$name")
      else
        echo "--only $name: expected serial, cpu, gl, vulkan, a folder of tests/, or a test program" >&2
        exit 2
      fi
      ;;
  esac
  local targets=("${programs[@]}")
  ((${#suites[@]} == 0)) || targets+=(on_serial)
  if [[ $name == consumers ]]; then
    targets+=(photongrid_installed host_renderer)
  fi
  configure tests -DPHOTONGRID_FULL_TESTS=OFF
  cmake --build build-tests --target "${targets[@]}"

  for word in "${@:-}"; do
    filter+="${filter:+:}*$word*"
  done
  (($# > 0)) || filter="-*long_*"
  for program in "${programs[@]}"; do
    echo "== $program"
    run_cases "$program" "$filter"
  done
  if ((${#suites[@]} > 0)); then
    filter=""
    for suite in "${suites[@]}"; do
      for word in "${@:-}"; do
        filter+="${filter:+:}$suite"
        [[ $suite == *"$word"* ]] || filter+="$word*"
      done
    done
    (($# > 0)) || filter+=":-*long_*"
    echo "== on_serial: ${suites[*]}"
    run_cases on_serial "$filter"
  fi
  if (($# > 0)) && [[ $matched == no ]]; then
    echo "--only $name: no case has $(printf '"%s", ' "$@" | sed 's/, $//; s/, / or /g') in its name" >&2
    exit 2
  fi
  if [[ $name == consumers ]] && (($# == 0)); then
    run_tests build-tests --tests-regex "^(consumer|host_renderer)" --label-exclude "long|full"
  fi
}

# run_stale: builds what is not up to date, and runs the short tests of those programs that were rebuilt
run_stale() {
  local stale program tests=()
  configure tests -DPHOTONGRID_FULL_TESTS=OFF
  # A dry run of build.ninja itself would only say that CMake might run again, since it looks for new files.
  cp build-tests/build.ninja build-tests/dry_run.ninja
  stale=$(ninja -C build-tests -f dry_run.ninja -n all photongrid_quick_tests |
    sed -n 's/.*Linking CXX executable tests\/\([a-z_]*\)$/\1/p')
  if grep -qx on_serial <<<"$stale"; then
    stale=$(grep -vE "^(on_(cpu|gl|vulkan)|own_kernels|threads)$|^(gl|vulkan)_" <<<"$stale" || true)
  fi
  for program in $stale; do
    if grep -qE "photongrid_test\($program\b" tests/*/CMakeLists.txt; then
      tests+=("$program")
    fi
  done
  if ((${#tests[@]} == 0)); then
    echo "No test program is out of date."
    return
  fi
  cmake --build build-tests --target "${tests[@]}"
  local names
  names=$(IFS='|' && echo "${tests[*]}")
  run_tests build-tests --tests-regex "^($names)$"
}
