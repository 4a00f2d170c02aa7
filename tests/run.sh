#!/usr/bin/env bash
# Builds photongrid with warnings as errors and runs all tests; this is what CI runs.
#
#   tests/run.sh [--full] [--stage NAME]... [--device hardware] [--no-install]
#   tests/run.sh --quick | --only NAME [--filter WORD]... | --filter WORD...
#
#   --full             adds the long runs, the manual, all benches, planted faults, clang-tidy, GPU-assisted validation,
#                      the sanitizers over all tests on every backend, each header alone and users' projects with clang,
#                      and those of users' projects that show what another does for another backend; property tests
#                      with a seed of its own, which it prints (PHOTONGRID_SEED=N chooses one)
#   --stage NAME       only this stage, one of those named below; a full run takes hours
#   --device hardware  every backend on a real GPU, long runs too; software devices are refused (no sanitizers, no clang)
#   --no-install       only say which Debian packages are missing, do not install them
#   --quick            after an edit: builds what it makes stale with g++ and runs the short tests of that; where the
#                      serial backend's are among them, not those of the other backends
#   --only NAME        a backend (serial, cpu, gl, vulkan), a folder of tests/, or one test program
#   --filter WORD      only cases with WORD in their names, long ones too; on the serial backend without --only
#
# The stages, in turn; the run stops at the first that fails:
#   texts       clang-format, that each planted fault still finds its place, in how many files a kind of shape, light or
#               material or a setting is added, and the length of commits' subjects
#   sanitizers  the serial backend under clang's address and undefined behaviour sanitizers (build-asan/); in full every
#               backend under g++'s (build-asan-gcc/)
#   clang       headers, kernels and a smoke test with clang 14 (build-clang/)
#   fuzzing     clang's fuzzer on the readers of scenes, 4 s for each format (build-asan/), in full 50 s (build-fuzz/)
#   tests       everything with g++, assertions on (build-tests/), but for what the sanitizers have run, unless in full
# and with --full:
#   gpu_assisted  the Vulkan backend under GPU-assisted validation
#   benches       each bench, briefly
#   blender       scenes that Blender makes beside Cycles' pictures; skipped without Blender, which is not installed
#   tidy          clang-tidy
#   faults        tests/planted_faults.sh, and 40 faults that nobody chose
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes full=no device=any quick=no only='' words=() stages=()
while (($# > 0)); do
  case $1 in
    --full) full=yes ;;
    --no-install) install=no ;;
    --quick) quick=yes ;;
    --only | --filter | --stage)
      if [[ -z ${2:-} ]]; then
        echo "$1: expected a name; see tests/run.sh --help" >&2
        exit 2
      fi
      case $1 in
        --only) only=$2 ;;
        --filter) words+=("$2") ;;
        --stage) stages+=("$2") ;;
      esac
      shift
      ;;
    --device)
      device=${2:-}
      if [[ $device != hardware ]]; then
        echo "--device $device: expected \"hardware\"" >&2
        exit 2
      fi
      shift
      ;;
    -h | --help)
      sed -n '2,/^set /s/^# \{0,1\}//p' tests/run.sh
      exit 0
      ;;
    *)
      echo "tests/run.sh: unknown argument \"$1\"; see tests/run.sh --help" >&2
      exit 2
      ;;
  esac
  shift
done
full_packages=()
if [[ $full == yes ]]; then
  full_packages=(doxygen clang-tidy-14)
fi
require_packages "$install" "${program_packages[@]}" libgtest-dev librapidcheck-dev libflann-dev libnanoflann-dev \
  vulkan-validationlayers clang-14 clang-format-14 libclang-rt-14-dev dpkg-dev file xvfb xauth libx11-dev libxtst-dev \
  "${smoke_packages[@]}" "${full_packages[@]}"

export CMAKE_GENERATOR=Ninja          # for the projects that tests configure; a bare Debian has no make
export NODEVICE_SELECT=1              # the implicit layer crashes processes that start side by side
export PHOTONGRID_REQUIRE_BACKENDS=1  # a backend that cannot be had is a failure here, not a skipped test
export UBSAN_OPTIONS=print_stacktrace=1
export MESA_SHADER_CACHE_DIR=$PWD/build-tests/mesa-shader-cache
mkdir -p "$MESA_SHADER_CACHE_DIR"

# Property tests: the same cases in each short run, others in each full one.
seed=20031
if [[ $full == yes ]]; then
  seed=${PHOTONGRID_SEED:-$((RANDOM << 15 | RANDOM))}
  echo "seed of the property tests: $seed (PHOTONGRID_SEED=$seed repeats them)"
fi

# configure PRESET [OPTION...]
configure() {
  local preset=$1 launcher=()
  shift
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  cmake --preset "$preset" --log-level=WARNING "-DPHOTONGRID_RC_PARAMS=seed=$seed" "${launcher[@]}" "$@"
}
# run_tests FOLDER [OPTION...]
run_tests() {
  local folder=$1
  shift
  # One more at a time than there are cores, since the window's tests mostly wait. A program that was not built fails as
  # a whole; its cases are not known.
  ctest --test-dir "$folder" --output-on-failure --no-tests=error -j$(($(nproc) + 1)) \
    --exclude-regex "_NOT_BUILT$skipped" "$@"
}
skipped=
source tests/part.sh
if ((${#stages[@]} > 0)) && [[ $quick == yes || -n $only ]]; then
  echo "--stage: not with --quick or --only" >&2
  exit 2
fi
if [[ $quick == yes ]]; then
  run_stale
  exit
elif [[ -n $only ]] || ((${#words[@]} > 0)); then
  run_part "${only:-serial}" "${words[@]}"
  exit
fi

short=(--label-exclude "long|full") sanitized=(--label-exclude "long|heavy|full")
sanitized_target=photongrid_quick_tests everything=OFF together=ON clang_targets=(photongrid_smoke)
if [[ $full == yes ]]; then
  short=() sanitized=(--label-exclude long) sanitized_target=all everything=ON
  together=OFF # so that a file that lacks an include is seen
  clang_targets+=(all_verify_interface_header_sets)
fi

all_stages=(texts sanitizers clang fuzzing tests)
if [[ $device == hardware ]]; then
  export PHOTONGRID_DEVICE=hardware
  all_stages=(texts tests)
  if [[ $full == no ]]; then
    short=(--label-exclude full) # the long runs too: pictures by seeds, on devices that round loosely
  fi
elif [[ $full == yes ]]; then
  all_stages+=(gpu_assisted benches blender tidy faults)
fi
for stage in "${stages[@]}"; do
  if [[ " ${all_stages[*]} " != *" $stage "* ]]; then
    echo "--stage $stage: expected one of ${all_stages[*]}" >&2
    exit 2
  fi
done

stage_texts() {
  find backends bench examples include tests -name '*.[hc]pp' -print0 | xargs -0 clang-format-14 --dry-run --Werror
  tests/planted_faults.sh --check
  tests/growth.sh
  check_subjects
}
# Subjects have at most 72 characters, which git log shows whole on 80 columns; the rule is younger than the repository.
# Not checked without git, nor in a clone without its history.
check_subjects() {
  local commit subject first=bb1f426 long=0
  if [[ ! -e .git ]] || ! command -v git >/dev/null || ! git merge-base --is-ancestor $first HEAD 2>/dev/null; then
    return 0
  fi
  while read -r commit subject; do
    if ((${#subject} > 72)); then
      echo "$commit: its subject has ${#subject} characters, at most 72 expected: $subject" >&2
      long=1
    fi
  done < <(git log --format='%h %s' $first..HEAD)
  return $long
}
stage_sanitizers() {
  local folder=build-asan
  if [[ $full == yes ]]; then
    # Mesa's drivers and the validation layer leak a little at exit, and are unloaded by then: see keep_loaded.cpp.
    local asan lavapipe layer
    asan=$(readlink -f "$(g++ -print-file-name=libasan.so)")
    lavapipe=$(find /usr/lib -name 'libvulkan_lvp.so' -print -quit)
    layer=$(find /usr/lib -name 'libVkLayer_khronos_validation.so' -print -quit)
    folder=build-asan-gcc
    configure asan_gcc -DPHOTONGRID_CPU=ON -DPHOTONGRID_GL=ON -DPHOTONGRID_VULKAN=ON "-DCMAKE_CROSSCOMPILING_EMULATOR=env;PHOTONGRID_KEEP_LOADED=$lavapipe:$layer;LD_PRELOAD=$asan:$PWD/$folder/tests/libkeep_loaded.so"
    printf 'leak:%s\n' libOSMesa libvulkan_lvp libVkLayer_khronos_validation libEGL_mesa swrast_dri libLLVM >$folder/leaks.supp
    export LSAN_OPTIONS=suppressions=$PWD/$folder/leaks.supp:print_suppressions=0
  else
    configure asan
  fi
  cmake --build "$folder" --target "$sanitized_target"
  # OSMesa's run differs from EGL's by its context only, which gl_backend tests with both.
  skipped="|on_gl_osmesa"
  run_tests "$folder" "${sanitized[@]}"
  skipped=
}
stage_clang() {
  configure clang
  cmake --build build-clang --target "${clang_targets[@]}"
  if [[ $full == yes ]]; then
    run_tests build-clang --tests-regex "smoke|consumer"
  else
    run_tests build-clang --tests-regex smoke
  fi
}
stage_fuzzing() {
  if [[ $full == yes ]]; then
    tests/fuzz.sh --seconds 50
  else
    configure asan # which has the library already
    tests/fuzz.sh --seconds 4 --folder build-asan
  fi
}
stage_tests() {
  configure tests -DPHOTONGRID_FULL_TESTS=$everything -DCMAKE_UNITY_BUILD=$together
  cmake --build build-tests
  run_tests build-tests "${short[@]}"
}
stage_gpu_assisted() {
  configure tests -DPHOTONGRID_FULL_TESTS=$everything -DCMAKE_UNITY_BUILD=$together
  cmake --build build-tests --target on_vulkan
  PHOTONGRID_GPU_AV=1 run_tests build-tests --tests-regex '^on_vulkan(_heavy)?$'
}
stage_benches() {
  local arguments=(--smoke)
  [[ $install == yes ]] || arguments+=(--no-install)
  bench/run.sh "${arguments[@]}"
}
stage_blender() {
  configure tests -DPHOTONGRID_FULL_TESTS=$everything -DCMAKE_UNITY_BUILD=$together
  cmake --build build-tests --target photongrid_program
  tests/pictures_of_others.sh blender "" build-tests/photongrid
}
stage_tidy() { tests/tidy.sh; }
stage_faults() {
  tests/planted_faults.sh
  tests/planted_faults.sh --generated 40 "$seed"
}

for stage in "${all_stages[@]}"; do
  if ((${#stages[@]} == 0)) || [[ " ${stages[*]} " == *" $stage "* ]]; then
    echo "== $stage"
    started=$SECONDS
    "stage_$stage"
    echo "== $stage: $((SECONDS - started)) s"
  fi
done
