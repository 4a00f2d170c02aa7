// The surfaces of shapes as triangles, for formats that have no such shapes.
#pragma once

#include <photongrid/scene/box.hpp>
#include <photongrid/scene/cone.hpp>
#include <photongrid/scene/cylinder.hpp>
#include <photongrid/scene/disk.hpp>
#include <photongrid/scene/paraboloid.hpp>
#include <photongrid/scene/placed_mesh.hpp>
#include <photongrid/scene/polygon.hpp>
#include <photongrid/scene/sphere.hpp>

namespace photongrid {

/// Axes of a right-handed frame whose third one has the direction of `axis`, as columns.
glm::dmat3 frame_about(const dvec3& axis);

/// A polygon as a fan from its first vertex, and a box as twelve triangles between its eight corners: with all places
/// rounded to single precision, so that neighbours still meet.
mesh mesh_of(const polygon& p);
mesh mesh_of(const box& b);

/// \name Round shapes
/// With normals for shading, facing outside, or along a disk's normal. Their vertices lie on the shape.
/// @{
mesh mesh_of(const sphere& s);
mesh mesh_of(const cylinder& x);
mesh mesh_of(const cone& x);
mesh mesh_of(const paraboloid& x);
mesh mesh_of(const disk& d);
/// @}

} // namespace photongrid
