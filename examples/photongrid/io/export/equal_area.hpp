// Pictures of light from all directions as pbrt-v4 has them.
#pragma once

#include <photongrid/scene/distant_lights.hpp>

#include <vector>

namespace photongrid {

/// The direction at a place from (0, 0) to (1, 1) of the equal-area map of the sphere to a square: the inverse of what
/// Clarberg 2008 gives (Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD). A unit vector; +z is in the middle.
dvec3 equal_area_direction(double u, double v);

/// The map of an environment in that square, times its radiance, in the map's own space with +y in the middle. Each
/// texel is the mean of 4 x 4 places in it.
std::vector<glm::vec3> equal_area_texels(const environment_light& l, std::uint32_t side);

} // namespace photongrid
