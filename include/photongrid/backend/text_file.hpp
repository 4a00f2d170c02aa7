// A file's text, embedded in the program.
#pragma once

#include <string_view>

namespace photongrid {

/// What photongrid_embed() of CMake makes of a file.
struct text_file {
    std::string_view name; ///< path relative to the repository, "include/photongrid/map/bitonic_step.glsl"
    std::string_view text; ///< the whole file
};

} // namespace photongrid
