#!/usr/bin/env bash
# clang-tidy, by .clang-tidy, over the sources that the preset `clang` compiles (the examples, the program, and the smoke
# tests, through which it sees the library's headers). Any finding is a failure. Run by tests/run.sh --full.
#
#   tests/tidy.sh [PATTERN]      only files whose path matches the extended regular expression
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[[ -r build-clang/compile_commands.json ]] || cmake --preset clang --log-level=WARNING
sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' build-clang/compile_commands.json | grep -v '_verify_interface_header_sets/' |
  grep -E "${1:-.}" | sort -u |
  xargs -P 2 -n 1 clang-tidy-14 -p build-clang --quiet --warnings-as-errors='*'
