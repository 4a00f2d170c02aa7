// Surfaces that emit.
#pragma once

#include <photongrid/io/gltf/materials.hpp>

#include <memory>

namespace photongrid::gltf {

/// Whether triangles enclose a volume: each edge belongs to two triangles that face the same way. Vertices at the same
/// place are one.
bool is_closed(const mesh& m);

/// A surface by what its triangles emit.
struct emitting_parts {
    std::shared_ptr<const mesh> lit, dark; ///< null: there are no such triangles
    dvec3 colour{1};                       ///< mean of the texture on the triangles that are lit
};

/// Divides a surface with texture coordinates by the texture of its emission. A triangle is lit where any of its texels
/// is not black.
emitting_parts divided(const mesh& m, const texture_use& emission);

} // namespace photongrid::gltf
