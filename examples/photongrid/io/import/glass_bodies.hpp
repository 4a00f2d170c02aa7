// Bodies of glass that are not bodies: open ones, and those that are inside out.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <cstddef>

namespace photongrid {

/// What bounds a volume, and how.
struct mesh_closure {
    std::size_t open_edges = 0; ///< that have not two triangles, one on either side, wound alike
    double open_share = 0;      ///< the length of the sum of the triangles' area vectors over their area: 0 if closed
    double volume = 0;          ///< that the triangles enclose, m^3; negative: inside out
};

/// Vertices at one place count as one.
mesh_closure closure_of(const mesh& m);

/// Finds meshes of glass that are open or inside out, and notes them under `file`. Unless `as_it_is`, as for formats
/// whose surfaces are interfaces of two media by definition, one that is inside out is turned, and a sheet is drawn as
/// thin glass. An open surface whose edge other shapes hold all round, as the sides of a pool do, stays an interface.
void mend_glass(imported_scene& s, const std::string& file, bool as_it_is);

} // namespace photongrid
