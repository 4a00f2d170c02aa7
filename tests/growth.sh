#!/usr/bin/env bash
# Is the library still cheap to add to? A shape, a filter or a kind of material that is named in many files is one whose
# neighbour must be written into as many (docs/guide/add_a_shape.md, CONTRIBUTING.md). Counts the files that name one,
# but for tests, docs, scenes (their schema is documentation, for editors), scripts of bench/, which choose what to
# measure, and what they measured, the readers of other programs' scenes, whose own kinds have such names, and the
# writers of these, which say of each kind what it becomes there; and the kernels that tell biases, which use one filter
# whatever that of the estimate.
#
# A setting is named where it is declared, in the table of settings, in the schema and on the page that are made from
# the table, and where it is used. Scenes of examples/ may set it.
#
#   tests/growth.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

status=0
# What to look for, whatever its case: words that nothing else is called. Glass has a surface of its own, which kernels
# name; metal has that of mirrors, so that nothing but its row need name it.
for words in paraboloid 'scene/box|<box>|const box&|(hit|closest)_box' 'scene/disk|<disk>|const disk&|(hit|closest)_disk' \
  epanechnikov material_kind::glass glass_surface metal; do
  most=5
  files=$(grep -rliE "$words" --include='*.hpp' --include='*.cpp' --include='*.glsl' --include='*.json' --include='*.cmake' \
    --include='*.sh' --include='CMakeLists.txt' include backends bench cmake examples CMakeLists.txt | grep -vE '^examples/scenes/.*\.json$|^bench/(.*\.sh$|results/)|^examples/photongrid/io/(pbrt|mitsuba|gltf|obj|export)/|^include/photongrid/(estimate/bias_|render/correct_bias)' | sort)
  count=$(grep -c . <<<"$files" || true)
  echo "$words: $count files"
  if ((count == 0 || count > most)); then
    sed 's/^/  /' <<<"$files"
    echo "growth: expected 1 to $most files that name it: go through all of a kind (for_each_shape(), filters, material_kinds) instead"
    status=1
  fi
done

# WORDS AT-MOST: the setting's files among the sources and pages.
expect_setting() {
  local files count
  files=$(grep -rlE "$1" include backends examples/photongrid examples/scenes/photongrid-scene.schema.json docs | sort)
  count=$(grep -c . <<<"$files" || true)
  echo "$1: $count files"
  if ((count < 4 || count > $2)); then
    sed 's/^/  /' <<<"$files"
    echo "growth: expected 4 to $2 files that name it: have its words made from setting_table.hpp, and its rule in one place"
    status=1
  fi
}
expect_setting '\bgather_rays\b' 5
expect_setting '\bcaustic_k\b' 5
# As a word of statistics and of a message, too; others use it of numbers in general.
expect_setting 'double percentile =|[.:"`]percentile\b' 8
exit $status
