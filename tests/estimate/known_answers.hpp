// What tests compare with that is not ours: brute force, integration, FLANN. Compiled once (known_answers.cpp).
#pragma once

#include "../map/photon_sets.hpp"

#include <photongrid/estimate/estimate_settings.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <optional>
#include <vector>

namespace photongrid::testing {

/// Photons with directions and normals, points with normals.
struct oriented_set {
    photon_set photons;
    std::vector<glm::vec4> directions, normals, points, point_normals;
};

oriented_set make_oriented(
    distribution d, std::size_t n, glm::uvec3 resolution, std::size_t points, std::uint64_t seed);
/// A photon for each number, with its direction and normal: see make_photons().
oriented_set make_oriented(
    distribution d, const std::vector<std::uint64_t>& numbers, glm::uvec3 resolution, std::size_t points);

/// The squared radius of the least disc of an estimate at a point, m^2: of min_radius, of 2^-24 of the point's largest
/// coordinate, or of 1e-18 m, whichever is largest.
double least_disc2(const glm::vec4& point, float min_radius);

/// One estimate by brute force.
struct brute_estimate {
    std::vector<uint> ids; ///< by (distance, id); those within the radius
    double radius2 = 0;
    bool kth = false; ///< a photon set the radius
    glm::dvec3 irradiance{0};
    glm::dvec4 standard_error{0}; ///< w: of the sum of the channels
    // Of the photons nearer than the radius: estimate_biases.
    glm::dvec3 bias{0}, tilt{0}, jump{0}, constant{0};
};

/// Squared distance as the search measures it, or nothing where a policy rejects the photon. Written out in single
/// precision, in the order that photon_distance.glsl promises.
std::optional<float> policy_distance2(const oriented_set& s, std::size_t q, std::size_t id, const leak_policy& leaks);

/// The half space in the w of a point's normal (half_space.glsl): unit vector to its plane, distance of that, m.
std::pair<glm::dvec3, double> half_space_by_force(const glm::vec4& normal, float radius);

/// `at_least_radius2`: the squared radius of at_least_k in a grid map, which depends on the order of cells; none in a
/// block map.
brute_estimate estimate_by_force(const oriented_set& s, const std::vector<uint>& in_map,
    const std::vector<glm::vec4>& powers, std::size_t q, const knn_settings& k, std::optional<float> at_least_radius2);

/// The squared radius of at_least_k in a block map, if the k-th nearest photon has the squared distance d2: the next of
/// the numbers 1, 1.25, 1.5 and 1.75 times a power of two.
float radius2_in_blocks(float d2, float max_radius2);

/// The squared radius of at_least_k, m^2, by figure 6 of the paper: the largest squared distance of the first k photons
/// within the maximum radius, or that radius if there are fewer. Cells are visited ring by ring, and within a ring by
/// ascending z, y, x. `in_cells`: the ids of each cell's photons, in the map's order.
float grown_by_force(const std::vector<glm::vec4>& positions, const grid& g,
    const std::vector<std::vector<uint>>& in_cells, const glm::vec4& point, const knn_settings& k);

/// Squared distance of each point's k-th nearest photon by FLANN's tree, m^2; none where there are fewer than k.
std::vector<std::optional<float>> kth_by_flann(
    const std::vector<glm::vec4>& positions, const std::vector<glm::vec4>& points, uint k);

/// Integrals over the part of a disc that lies on a convex polygon of the same plane, over those of the whole disc.
/// Four components: by each filter, in their order. Lengths are divided by the radius.
struct disc_part {
    glm::dvec4 share{0}, first_x{0}, first_y{0}; ///< share, and first moments
    glm::dvec3 second{0};                        ///< xx, xy, yy, by the constant filter
};

/// By lines across the disc, each cut by all edges: Gauss' points in the arc sine of the lines' height, between the
/// heights of the polygon's corners, of the disc's center, and of where the polygon's edges meet the disc's rim.
disc_part part_by_lines(const std::vector<glm::dvec2>& corners, glm::dvec2 center, double radius);

} // namespace photongrid::testing
