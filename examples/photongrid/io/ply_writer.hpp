// Writes meshes as PLY files.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <string>

namespace photongrid {

/// The bytes of a PLY file (binary, little-endian) that reads as the same mesh, bit for bit: positions, normals,
/// texture coordinates and colours as single precision numbers.
/// \throws std::invalid_argument for a mesh that check() rejects.
std::string ply_bytes(const mesh& m);

} // namespace photongrid
