// A survey of a forest by photongrid, without any light.
#pragma once

#include "forest_kernels.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/own_photons.hpp>

#include <vector>

/// A tree in a forester's data.
struct tree {
    double east, north; // m
    float height;       // m
};

/// How photongrid reads a tree: as a photon of power 1, so that an estimate counts trees.
template <>
struct photongrid::photon_reader<tree> {
    static glm::dvec3 position(const tree& t) { return {t.east, t.north, 0}; }
    static float power(const tree&) { return 1; }
};

/// The survey of one query point.
struct survey {
    float trees_per_hectare = 0;
    float standard_error = 0;           ///< of the density
    float mean_height = 0;              ///< m
    std::vector<std::uint32_t> nearest; ///< indices into the vector of trees
    std::vector<float> distances;       ///< m
};

/// Surveys query points (m: east, north, 0) from the `k` trees nearest to each, on any backend.
template <photongrid::backend Device>
std::vector<survey> survey_forest(
    Device& device, const std::vector<tree>& trees, const std::vector<glm::vec3>& queries, std::uint32_t k)
{
    // Upload the trees, build a map whose grid fits them, and upload the query points.
    const auto map = photongrid::fitted_map(device, photongrid::upload_photons(device, trees), k);
    const auto points = photongrid::upload_points(device, queries);
    const photongrid::knn_settings settings{.k = k, .errors = true};

    // Density, with its error: trees per square metre.
    const auto density = photongrid::knn_grid_estimate(device, map, points, settings);

    // The neighbours themselves.
    const auto neighbours = photongrid::knn_neighbours(device, map, points, settings);

    // A value that the library does not compute: their mean height, by a kernel of our own.
    std::vector<float> heights;
    heights.reserve(trees.size());
    for (const auto& t : trees)
        heights.push_back(t.height);
    const auto all_heights = photongrid::upload(device, heights);
    auto mean = device.template make<float>(queries.size());
    device.template run<forest::mean_height>(queries.size(), {.k = k},
        photongrid::reads(neighbours.ids, neighbours.distances2, all_heights), photongrid::writes(mean));

    const auto per_square_metre = device.download(density.irradiance), errors = device.download(density.standard_error);
    const auto means = device.download(mean), distances2 = device.download(neighbours.distances2);
    const auto ids = device.download(neighbours.ids);
    std::vector<survey> found(queries.size());
    for (std::size_t p = 0; p < found.size(); ++p) {
        found[p].trees_per_hectare = 1e4f * per_square_metre[p].x;
        found[p].standard_error = 1e4f * errors[p].x;
        found[p].mean_height = means[p];
        for (std::size_t n = p * k; n < (p + 1) * k && ids[n] != photongrid::no_id; ++n) {
            found[p].nearest.push_back(ids[n]);
            found[p].distances.push_back(std::sqrt(distances2[n]));
        }
    }
    return found;
}
