// Writes scenes as files: photongrid's own and those of other programs. docs/guide/convert.md says what goes where.
#pragma once

#include <photongrid/io/exported_scene.hpp>

#include <string>

namespace photongrid {

/// Writes a scene as a scene file (.json) that reads as the same scene. Meshes and pictures become files in a folder
/// beside it, which has its name without the ending. Pictures that already lie beside it stay where they are. Names
/// that scene files cannot have are changed. A file that was at `path` is replaced when all else is written; on an
/// error it remains, and no new file does.
/// \throws file_error; scene_error for a scene that does not fit into a scene file, as one with too many shapes.
exported_scene write_scene(const std::string& path, const scene& s, const export_settings& settings = {});

/// Writes a scene in the format that the ending of `path` names: .json, .pbrt, .gltf or .glb.
/// \throws as write_scene, write_pbrt and write_gltf do; file_error for another ending.
exported_scene export_scene(const std::string& path, const scene& s, const export_settings& settings = {});

/// Checks whether export_scene() can write to `path`, so that a program can report that before it reads a scene.
/// \throws file_error for an ending that names no format, for a folder that does not exist or is not writable, or if
///         `path` is not a regular file.
void check_export_path(const std::string& path);

} // namespace photongrid
