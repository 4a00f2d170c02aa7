// Reads scenes of pbrt-v4 (https://pbrt.org/fileformat-v4). docs/guide/pbrt.md says what is read and what is not.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// Reads the scene in `text`; `file` is its name in messages, and files that it names are sought in its folder.
/// \throws scene_error for what is no pbrt-v4 file, names files that cannot be read, or describes a scene that cannot
///         be drawn; std::invalid_argument for settings out of range.
imported_scene parse_pbrt(const std::string& file, std::string_view text, const import_settings& settings = {});

/// Reads a pbrt-v4 file, which may be compressed (gzip).
/// \throws as parse_pbrt.
imported_scene read_pbrt(const std::string& path, const import_settings& settings = {});

} // namespace photongrid
