// The search against FLANN and nanoflann.
#pragma once

#include "landed_photons.hpp"

namespace photongrid::testing {
namespace {

    // --- nearest neighbours
    // -----------------------------------------------------------------------------------------------

    struct cloud {
        const std::vector<vec4>& points;
        std::size_t kdtree_get_point_count() const { return points.size(); }
        float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
        template <class Box>
        bool kdtree_get_bbox(Box&) const
        {
            return false;
        }
    };

    TEST(validation, exact_k_equals_flann_and_nanoflann)
    {
        // Both trees prune by sums rounded in another order than the distances themselves; a slightly negative epsilon
        // makes them look a little farther, so that no neighbour is lost to the last bit.
        const float slack = -1e-4f;
#if NANOFLANN_VERSION >= 0x150
        const nanoflann::SearchParameters nano_search(slack);
#else
        const nanoflann::SearchParams nano_search(0, slack);
#endif
        flann::SearchParams flann_search(flann::FLANN_CHECKS_UNLIMITED, slack);
        using nano_tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3>;
        serial_backend b;
        for (const auto d : all_distributions) {
            auto set = make_photons(d, 6000, {12, 12, 12}, 77);
            random_source u(5);
            for (auto& p : set.powers) // integers whose sums over a set tell sets apart, and stay exact in float
                p = vec4(static_cast<float>(u.below(1u << 13)), static_cast<float>(u.below(1u << 13)),
                    static_cast<float>(u.below(1u << 13)), 0.0f);
            const auto points = make_points(set, 400, 78);
            const auto map = sorted_map(b, upload_photons(b, set), set.g);
            const cloud c{set.positions};
            nano_tree nano(3, c, nanoflann::KDTreeSingleIndexAdaptorParams(10));
            nano.buildIndex();
            std::vector<float> coordinates;
            for (const auto& p : set.positions)
                coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
            flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree(
                flann::Matrix<float>(coordinates.data(), set.positions.size(), 3));
            tree.buildIndex();

            int compared = 0, sets = 0;
            for (const uint k : {1u, 7u, 64u, 500u}) {
                const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)),
                    {.k = k, .max_radius = 10, .bias = bias_kind::paper});
                const auto irradiance = b.download(e.irradiance);
                const auto used = b.download(e.used);
                const float floor2
                    = std::pow(std::max({set.g.cell.x * 12, set.g.cell.y * 12, set.g.cell.z * 12}) * 0x1p-20f, 2.0f);
                for (std::size_t q = 0; q < points.size(); ++q) {
                    float query[3] = {points[q].x, points[q].y, points[q].z};
                    std::vector<std::uint32_t> ids(k + 1);
                    std::vector<float> distances(k + 1);
                    nanoflann::KNNResultSet<float, std::uint32_t> found(k + 1);
                    found.init(ids.data(), distances.data());
                    nano.findNeighbors(found, query, nano_search);
                    std::vector<std::vector<std::size_t>> flann_ids;
                    std::vector<std::vector<float>> flann_distances;
                    tree.knnSearch(flann::Matrix<float>(query, 1, 3), flann_ids, flann_distances, k, flann_search);

                    const auto flushed
                        = [](float x) { return x < std::numeric_limits<float>::min() ? 0.0f : x; }; // as kernels do
                    const float nth = flushed(distances[k - 1]), fth = flushed(flann_distances[0][k - 1]);
                    ASSERT_EQ(irradiance[q].w, nth) << name_of(d) << ", k " << k << ", point " << q << ": nanoflann";
                    ASSERT_EQ(irradiance[q].w, fth) << name_of(d) << ", k " << k << ", point " << q << ": FLANN";
                    ASSERT_EQ(used[q].x, k);
                    ++compared;
                    if (flushed(distances[k]) == nth || nth <= floor2 || k > 64)
                        continue; // a tie at the k-th: nanoflann does not specify which one it returns
                    glm::dvec3 sum(0);
                    for (uint n = 0; n < k; ++n)
                        sum += glm::dvec3(set.powers[ids[n]]);
                    for (int channel = 0; channel < 3; ++channel)
                        ASSERT_EQ(std::round(static_cast<double>(irradiance[q][channel])
                                      * static_cast<double>(3.14159265f) * static_cast<double>(nth)),
                            sum[channel])
                            << name_of(d) << ", k " << k << ", point " << q << ": another set";
                    ++sets;
                }
            }
            std::printf("%s: %d k-th distances equal, %d sets\n", name_of(d), compared, sets);
            if (d != distribution::coincident && d != distribution::cell_faces) { // all ties
                EXPECT_GT(sets, 800) << name_of(d);
            }
        }
    }

} // namespace
} // namespace photongrid::testing
