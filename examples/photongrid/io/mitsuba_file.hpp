// Reads scenes of Mitsuba 3, and of 0.5 and 0.6 (https://mitsuba.readthedocs.io). docs/guide/mitsuba.md says what is
// read and what is not.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// Reads the scene in `text`; `file` is its name in messages, and files that it names are sought in its folder.
/// \throws scene_error for what is no scene of Mitsuba, names files that cannot be read, or describes a scene that
///         cannot be drawn; std::invalid_argument for settings out of range.
imported_scene parse_mitsuba(const std::string& file, std::string_view text, const import_settings& settings = {});

/// Reads a file.
/// \throws as parse_mitsuba.
imported_scene read_mitsuba(const std::string& path, const import_settings& settings = {});

} // namespace photongrid
