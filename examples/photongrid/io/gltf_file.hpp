// Reads scenes of glTF 2.0 (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). docs/guide/gltf.md says what is
// read and what is not.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// Reads the scene in `bytes`, of a .gltf or a .glb; `file` is its name in messages, and files that it names are sought
/// in its folder.
/// \throws scene_error for what is no glTF 2.0, names files that cannot be read, or describes a scene that cannot be
///         drawn; std::invalid_argument for settings out of range.
imported_scene parse_gltf(const std::string& file, std::string_view bytes, const import_settings& settings = {});

/// Reads a file.
/// \throws as parse_gltf.
imported_scene read_gltf(const std::string& path, const import_settings& settings = {});

} // namespace photongrid
