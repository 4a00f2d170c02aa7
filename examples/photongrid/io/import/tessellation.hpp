// Triangles of round shapes and of bilinear patches, where a scene has no shape of its own for them.
#pragma once

#include <photongrid/scene/mesh.hpp>

#include <array>
#include <functional>

namespace photongrid {

/// A grid of (across + 1) x (along + 1) vertices, for u and v from 0 to 1, with texture coordinates u and v. Its
/// outside is the side of cross(d place / du, d place / dv). `normal`: for shading, or null.
mesh tessellated(unsigned across, unsigned along, const std::function<glm::dvec3(double u, double v)>& place,
    const std::function<glm::dvec3(double u, double v)>& normal);

/// The part of a sphere about the origin from z = `low` to z = `high`, turned by `angle` (radians) about the z axis, as
/// the other shapes are. u goes around the axis, v upwards. The outside is outside.
mesh sphere_mesh(double radius, double low, double high, double angle);

/// The side of a cylinder about the z axis.
mesh cylinder_mesh(double radius, double low, double high, double angle);

/// A disk at z = `height`, with a hole of `inner_radius`; it faces +z. u goes around the axis, v inwards.
mesh disk_mesh(double height, double radius, double inner_radius, double angle);

/// The surface with three vertices for each triangle, whose corners have these texture coordinates.
mesh with_corner_coordinates(const mesh& m, const std::array<glm::vec2, 3>& corners);

} // namespace photongrid
