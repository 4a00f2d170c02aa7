#!/usr/bin/env bash
# Builds photongrid with warnings as errors and runs all tests; this is what CI runs.
#
#   tests/run.sh [--full] [--device hardware] [--no-install]
#
#   --full             adds the long runs, the manual, the benches on little data, planted faults and GPU-assisted validation, and the
#                      sanitizers over all tests on every backend instead of the quick ones on the serial one, and users'
#                      projects with clang
#   --device hardware  every backend on a real GPU; software devices are refused (no sanitizers, no clang)
#   --no-install       only say which Debian packages are missing, do not install them
#
# First the serial backend under the address and undefined behaviour sanitizers (build-asan/), then clang 14 (build-clang/)
# and its fuzzer on the scene reader for 20 s, in full 300 s (build-fuzz/), then everything with g++, assertions on
# (build-tests/), and some of the benches on little data; in full then GPU-assisted validation, all benches on little data and
# the planted faults. It stops where something fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source examples/setup.sh

install=yes full=no device=any
while (($# > 0)); do
  case $1 in
    --full) full=yes ;;
    --no-install) install=no ;;
    --device)
      device=${2:-}
      if [[ $device != hardware ]]; then
        echo "--device $device: expected \"hardware\"" >&2
        exit 2
      fi
      shift
      ;;
    -h | --help)
      sed -n '2,15s/^# \{0,1\}//p' tests/run.sh
      exit 0
      ;;
    *)
      echo "tests/run.sh: unknown argument \"$1\"; see tests/run.sh --help" >&2
      exit 2
      ;;
  esac
  shift
done
manual_packages=()
if [[ $full == yes ]]; then
  manual_packages=(doxygen)
fi
require_packages "$install" "${program_packages[@]}" libgtest-dev librapidcheck-dev libflann-dev libnanoflann-dev vulkan-validationlayers clang-14 libclang-rt-14-dev dpkg-dev file xvfb libx11-dev libxtst-dev "${smoke_packages[@]}" "${manual_packages[@]}"

export CMAKE_GENERATOR=Ninja          # for the projects that tests configure; a bare Debian has no make
export NODEVICE_SELECT=1              # the implicit layer crashes processes that start side by side
export PHOTONGRID_REQUIRE_BACKENDS=1  # a backend that cannot be had is a failure here, not a skipped test
export UBSAN_OPTIONS=print_stacktrace=1
export MESA_SHADER_CACHE_DIR=$PWD/build-tests/mesa-shader-cache
mkdir -p "$MESA_SHADER_CACHE_DIR"

# configure PRESET [OPTION...]
configure() {
  local preset=$1 launcher=()
  shift
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  cmake --preset "$preset" --log-level=WARNING "${launcher[@]}" "$@"
}
# run_tests FOLDER [OPTION...]
run_tests() {
  local folder=$1
  shift
  ctest --test-dir "$folder" --output-on-failure --no-tests=error -j2 "$@"
}
short=(--label-exclude "long|full") sanitized=(--label-exclude "long|heavy|full") sanitized_target=photongrid_quick_tests fuzz_seconds=20 everything=OFF
if [[ $full == yes ]]; then
  short=() sanitized=(--label-exclude long) sanitized_target=all fuzz_seconds=300 everything=ON
fi

if [[ $device == hardware ]]; then
  export PHOTONGRID_DEVICE=hardware
else
  echo "== sanitizers"
  if [[ $full == yes ]]; then
    # Mesa's drivers and the validation layer leak a little at exit, and are unloaded by then: see keep_loaded.cpp.
    asan=$(readlink -f "$(g++ -print-file-name=libasan.so)")
    lavapipe=$(find /usr/lib -name 'libvulkan_lvp.so' -print -quit)
    layer=$(find /usr/lib -name 'libVkLayer_khronos_validation.so' -print -quit)
    configure asan -DPHOTONGRID_GL=ON -DPHOTONGRID_VULKAN=ON "-DCMAKE_CROSSCOMPILING_EMULATOR=env;PHOTONGRID_KEEP_LOADED=$lavapipe:$layer;LD_PRELOAD=$asan:$PWD/build-asan/tests/libkeep_loaded.so"
    printf 'leak:%s\n' libOSMesa libvulkan_lvp libVkLayer_khronos_validation libEGL_mesa swrast_dri libLLVM >build-asan/leaks.supp
    export LSAN_OPTIONS=suppressions=$PWD/build-asan/leaks.supp:print_suppressions=0
  else
    configure asan
  fi
  cmake --build build-asan --target "$sanitized_target"
  # OSMesa's run differs from EGL's by its context only, which gl_backend tests with both.
  run_tests build-asan "${sanitized[@]}" --exclude-regex on_gl_osmesa

  echo "== clang"
  configure clang
  cmake --build build-clang --target all_verify_interface_header_sets photongrid_smoke
  if [[ $full == yes ]]; then
    run_tests build-clang --tests-regex "smoke|consumer"
  else
    run_tests build-clang --tests-regex smoke
  fi

  echo "== fuzzing"
  configure fuzz
  cmake --build build-fuzz --target fuzz_scene
  # New inputs go to the first folder, one that breaks the reader to build-fuzz/crash-….
  mkdir -p build-fuzz/corpus
  build-fuzz/tests/fuzz_scene -verbosity=0 -print_final_stats=1 -max_total_time=$fuzz_seconds -max_len=4096 -dict=tests/scene_corpus.dict -artifact_prefix=build-fuzz/ build-fuzz/corpus tests/scene_corpus
fi

echo "== g++, all tests"
configure tests -DPHOTONGRID_BENCH=ON -DPHOTONGRID_FULL_TESTS=$everything
cmake --build build-tests
run_tests build-tests "${short[@]}"

if [[ $device == any && $full == no ]]; then
  echo "== benches, briefly"
  bench/run.sh --smoke --built --no-install
fi
if [[ $full == yes && $device == any ]]; then
  echo "== GPU-assisted validation"
  PHOTONGRID_GPU_AV=1 run_tests build-tests --tests-regex '^on_vulkan(_heavy)?$'

  echo "== benches, briefly"
  arguments=(--smoke)
  [[ $install == yes ]] || arguments+=(--no-install)
  bench/run.sh "${arguments[@]}"

  echo "== planted faults"
  tests/planted_faults.sh
fi
