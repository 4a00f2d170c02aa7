// Writes scenes of pbrt-v4. docs/guide/convert.md says what becomes what.
#pragma once

#include <photongrid/io/exported_scene.hpp>

#include <string>

namespace photongrid {

/// Writes a scene for pbrt-v4, its meshes and pictures into a folder beside it. On an error no new file remains.
/// \throws file_error; scene_error for a scene that check() rejects, or, if the settings are strict, that pbrt cannot
///         have as it is.
exported_scene write_pbrt(const std::string& path, const scene& s, const export_settings& settings = {});

} // namespace photongrid
