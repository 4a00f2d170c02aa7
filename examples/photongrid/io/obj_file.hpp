// Reads meshes from OBJ files: their triangles, without materials.
#pragma once

#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/mesh.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// Reads the mesh in `text`; `file` is its name in messages. It takes positions (`v`, with linear colours from 0 to 1
/// after x, y and z if there are any), texture coordinates (`vt`), normals (`vn`) and faces (`f`), whose indices count
/// from 1, or back from the last with a sign. Vertices of faces that have the same three indices are one vertex of the
/// mesh. A face of more than three corners is cut into triangles, one of fewer is left out. If any face has normals,
/// faces without get that of their plane; if any has texture coordinates, others get (0, 0), and NaN is 0. Groups,
/// materials, lines, points and curves are skipped. `left_out`, if it is not null, gets what is to be said of faces.
/// \throws scene_error, with line and column, for a statement that OBJ does not have, a number that is none, or an
///         index of what does not exist. What check() rejects besides is left to mend().
mesh parse_obj(const std::string& file, std::string_view text, std::vector<std::string>* left_out = nullptr);

/// Reads an OBJ file.
/// \throws scene_error as parse_obj does, or if the file cannot be read.
mesh read_obj(const std::string& path);

} // namespace photongrid
