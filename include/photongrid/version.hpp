// The version of these headers. CMake reads the project's version here, so that there is one place to change.
#pragma once

#define PHOTONGRID_VERSION_MAJOR 0
#define PHOTONGRID_VERSION_MINOR 1
#define PHOTONGRID_VERSION_PATCH 0

namespace photongrid {

inline constexpr long library_version = PHOTONGRID_VERSION_MAJOR * 10000L + PHOTONGRID_VERSION_MINOR * 100L
    + PHOTONGRID_VERSION_PATCH; ///< 10203 is 1.2.3

} // namespace photongrid
