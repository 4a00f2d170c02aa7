// Reads scene files (JSON) into a checked photongrid::scene in SI units. docs/guide/scenes.md describes the format.
#pragma once

#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/scene.hpp>

#include <string>

namespace photongrid {

/// Reads the scene in `text`; `file` is its name in messages. Files of meshes are sought in its folder.
/// \throws scene_error.
scene parse_scene(const std::string& file, std::string text);

/// Reads a scene file.
/// \throws scene_error.
scene read_scene(const std::string& path);

} // namespace photongrid
