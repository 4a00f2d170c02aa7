#!/usr/bin/env bash
# Is the library still cheap to add to? Follows docs/guide/add_a_*.md to the letter: in a copy of the sources, it makes
# the files and the edits that each page shows, counts the files of the library that they touch, and with --build builds
# the result and runs the commands that each page ends with.
#
#   tests/growth.sh [--build] [PAGE...]    PAGE: shape, light, material, setting; default: all
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec python3 tests/growth.py "$@"
