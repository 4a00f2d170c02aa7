// Meshes in the compressed binary files of Mitsuba (.serialized), versions 3 and 4 of the format.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace photongrid::mitsuba {

/// A surface of such a file.
struct serialized_mesh {
    mesh surface;
    bool has_face_normals = false; ///< its triangles look flat
};

/// The surface with the number `index`, from 0, in the bytes of the file `file`. Vertices' colours are limited to 0 to
/// 1.
/// \throws scene_error for bytes that are no such file, are damaged, or hold what check() rejects.
serialized_mesh parse_serialized(const std::string& file, std::string_view bytes, std::size_t index);

} // namespace photongrid::mitsuba
