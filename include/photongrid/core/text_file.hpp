// Texts of files, embedded in a program.
#pragma once

#include <string_view>

namespace photongrid {

/// A file that CMake's photongrid_embed() has embedded.
struct text_file {
    std::string_view name; ///< path relative to the repository, "include/photongrid/map/bitonic_step.glsl"
    std::string_view text; ///< the whole file
};

} // namespace photongrid
