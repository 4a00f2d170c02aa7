// Leaves out of meshes what cannot be drawn, so that one odd number does not refuse a file.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <memory>
#include <string>

namespace photongrid {

/// Takes out triangles with a vertex that is not finite or further than 10^18 m from 0, and replaces texture
/// coordinates and colours that check() rejects, and normals that are not finite. What is wrong with a vertex that no
/// triangle uses does not matter. Returns what to say of it; "" if nothing is drawn in another way.
std::string mend(mesh& m);

/// The same of a mesh that others use, too: itself if nothing is wrong.
std::shared_ptr<const mesh> mended(std::shared_ptr<const mesh> m, std::string& said);

} // namespace photongrid
