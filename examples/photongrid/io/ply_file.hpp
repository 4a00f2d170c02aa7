// Reads meshes from PLY files: ascii and binary of both byte orders.
#pragma once

#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/mesh.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// What else a PLY file says.
struct ply_rest {
    struct remark {
        std::size_t line; ///< counted from 1; 0: the file as a whole
        std::string what;
    };
    std::vector<remark> left_out{}; ///< properties and elements that are no part of the mesh
    std::string texture{};          ///< the file that a comment `TextureFile` names, or ""
    std::size_t texture_line = 0;
};

/// Reads the mesh in `bytes`; `file` is its name in messages. It takes the vertices' `x`, `y` and `z`; their normals
/// `nx`, `ny` and `nz`, their texture coordinates (`u` and `v`, `s` and `t`, or `texture_u` and `texture_v`) and their
/// colours `red`, `green` and `blue` (bytes in sRGB, other types linear from 0 to 1), where there are all of them; and
/// the faces' `vertex_indices` or `vertex_index`, of any type. A face of more than three corners is cut into
/// triangles, one of fewer is left out. Strips of triangles (`tristrips`, as of Stanford's scans) are read, too. Other
/// properties and elements are skipped; `rest`, if it is not null, gets them.
/// \throws scene_error, with the line or the byte, for a file that is no PLY file, ends too early, or has an index
///         of a vertex that does not exist. What check() rejects besides is left to mend().
mesh parse_ply(const std::string& file, std::string_view bytes, ply_rest* rest = nullptr);

/// Reads a PLY file.
/// \throws scene_error as parse_ply does, or if the file cannot be read.
mesh read_ply(const std::string& path);

} // namespace photongrid
