// Reads scene files (JSON) into a checked photongrid::scene in SI units. docs/guide/scenes.md describes the format.
#pragma once

#include <photongrid/io/files.hpp>
#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/scene.hpp>

#include <string>

namespace photongrid {

/// Reads the scene in `text`; `file` is its name in messages. The files that it names are sought
/// in its folder.
/// \throws scene_error.
scene parse_scene(const std::string& file, std::string text, file_reading how = {});

/// Reads a scene file.
/// \throws scene_error.
scene read_scene(const std::string& path, file_reading how = {});

/// The settings of a scene file that names none. `photons`: it has a number of photons; other numbers, but for `k`, are
/// then those of render_settings and not automatic. `grid`: it has a grid, and `map` is then `sort`.
render_settings settings_unless_named(bool photons, bool grid);

} // namespace photongrid
