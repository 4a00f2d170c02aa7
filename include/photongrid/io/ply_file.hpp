// Reads meshes from PLY files: ascii and binary of both byte orders.
#pragma once

#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/mesh.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// Reads the mesh in `bytes`; `file` is its name in messages. It takes the vertices' `x`, `y` and `z`; their normals
/// `nx`, `ny` and `nz`, their texture coordinates (`u` and `v`, `s` and `t`, or `texture_u` and `texture_v`) and their
/// colours `red`, `green` and `blue` (bytes in sRGB, other types linear from 0 to 1), where there are all of them; and
/// the faces' `vertex_indices` or `vertex_index`, of any type. A face of more than three corners becomes a fan of
/// triangles, so it should be convex. Other properties and elements are skipped.
/// \throws scene_error, with the line or the byte, for a file that is no PLY file, ends too early, or has a number that
///         is not finite, a face of less than three corners, or an index of a vertex that does not exist.
mesh parse_ply(const std::string& file, std::string_view bytes);

/// Reads a PLY file.
/// \throws scene_error as parse_ply does, or if the file cannot be read.
mesh read_ply(const std::string& path);

} // namespace photongrid
