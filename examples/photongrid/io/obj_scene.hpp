// Reads OBJ files with the materials of their MTL files, and PLY files, as scenes. docs/guide/obj_and_ply.md says what
// is read and what is not. obj_file.hpp and ply_file.hpp read the surfaces alone.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// Reads the scene in `text`, of an OBJ file; `file` is its name in messages, and files that it names are sought in its
/// folder.
/// \throws scene_error for what is no OBJ file, names files that cannot be read, or describes a scene that cannot be
///         drawn; std::invalid_argument for settings out of range.
imported_scene parse_obj_scene(const std::string& file, std::string_view text, const import_settings& settings = {});

/// The same of a file.
imported_scene read_obj_scene(const std::string& path, const import_settings& settings = {});

/// The scene that a PLY file's surface is.
/// \throws as parse_obj_scene.
imported_scene parse_ply_scene(const std::string& file, std::string_view bytes, const import_settings& settings = {});

/// The same of a file.
imported_scene read_ply_scene(const std::string& path, const import_settings& settings = {});

} // namespace photongrid
