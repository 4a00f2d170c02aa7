// pbrt-v3's materials and lights in pbrt-v4's words.
#pragma once

#include <photongrid/io/pbrt/description.hpp>

#include <string_view>

namespace photongrid::pbrt {

/// Rewrites a material or a light of pbrt-v3 (`kind`: "material" or "light"). Returns whether it was one. What has no
/// words in pbrt-v4 stays as it is, and is then left out with a note.
bool to_version_4(entity& e, std::string_view kind);

} // namespace photongrid::pbrt
