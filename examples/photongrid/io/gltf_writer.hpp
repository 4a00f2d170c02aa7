// Writes scenes of glTF 2.0. docs/guide/convert.md says what becomes what.
#pragma once

#include <photongrid/io/exported_scene.hpp>

#include <string>

namespace photongrid {

/// Writes a scene as glTF 2.0: a .glb has all in one file, a .gltf its meshes and pictures in a folder beside it. On an
/// error no new file remains.
/// \throws file_error; scene_error for a scene that check() rejects, or, if the settings are strict, that glTF cannot
///         have as it is.
exported_scene write_gltf(const std::string& path, const scene& s, const export_settings& settings = {});

} // namespace photongrid
