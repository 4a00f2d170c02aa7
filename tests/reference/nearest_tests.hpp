// The search against FLANN and nanoflann.
#pragma once

#include "../estimate/known_answers.hpp"
#include "landed_photons.hpp"

#include <photongrid/estimate/knn_neighbours.hpp>

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

    /// FLANN's and nanoflann's trees over the same positions.
    class both_trees {
    public:
        explicit both_trees(const std::vector<vec4>& positions)
            : cloud_{positions}, nano_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(10)),
              coordinates_(coordinates_of(positions)),
              flann_(flann::Matrix<float>(coordinates_.data(), positions.size(), 3))
        {
            nano_.buildIndex();
            flann_.buildIndex();
        }
        both_trees(const both_trees&) = delete;
        both_trees& operator=(const both_trees&) = delete;

        /// The k + 1 nearest by nanoflann; the k nearest by FLANN.
        struct nearest {
            std::vector<std::uint32_t> ids;
            std::vector<std::uint32_t> ids_of_flann;
            std::vector<float> distances2;
            float kth_of_flann = 0;
        };
        nearest find(const vec4& point, uint k)
        {
            float query[3] = {point.x, point.y, point.z};
            nearest n{std::vector<std::uint32_t>(k + 1), {}, std::vector<float>(k + 1)};
            nanoflann::KNNResultSet<float, std::uint32_t> found(k + 1);
            found.init(n.ids.data(), n.distances2.data());
            nano_.findNeighbors(found, query, nano_search);
            std::vector<std::vector<std::size_t>> ids;
            std::vector<std::vector<float>> distances;
            flann_.knnSearch(flann::Matrix<float>(query, 1, 3), ids, distances, k, flann_search);
            n.kth_of_flann = distances[0][k - 1];
            n.ids_of_flann.assign(ids[0].begin(), ids[0].end());
            return n;
        }

    private:
        static std::vector<float> coordinates_of(const std::vector<vec4>& positions)
        {
            std::vector<float> coordinates;
            for (const auto& p : positions)
                coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
            return coordinates;
        }

        // Both trees prune by sums rounded in another order than the distances themselves; a slightly negative epsilon
        // makes them look a little farther, so that no neighbour is lost to the last bit.
        static constexpr float slack = -1e-4f;
#if NANOFLANN_VERSION >= 0x150
        const nanoflann::SearchParameters nano_search{slack};
#else
        const nanoflann::SearchParams nano_search{0, slack};
#endif
        const flann::SearchParams flann_search{flann::FLANN_CHECKS_UNLIMITED, slack};
        const cloud cloud_;
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3> nano_;
        std::vector<float> coordinates_;
        flann::KDTreeSingleIndex<flann::L2_Simple<float>> flann_;
    };

    TEST(validation, exact_k_equals_flann_and_nanoflann)
    {
        serial_backend b;
        for (const auto d : all_distributions) {
            auto set = make_photons(d, 6000, {12, 12, 12}, 77);
            random_source u(5);
            for (auto& p : set.powers) // integers whose sums over a set tell sets apart, and stay exact in float
                p = vec4(static_cast<float>(u.below(1u << 13)), static_cast<float>(u.below(1u << 13)),
                    static_cast<float>(u.below(1u << 13)), 0.0f);
            const auto points = make_points(set, 400, 78);
            const auto map = sorted_map(b, upload_photons(b, set), set.g);
            both_trees trees(set.positions);

            int compared = 0, sets = 0;
            for (const uint k : {1u, 7u, 64u, 500u}) {
                const auto e = knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)),
                    {.k = k, .max_radius = 10, .bias = bias_kind::paper});
                const auto irradiance = b.download(e.irradiance);
                const auto lists = b.download(
                    knn_neighbours(b, map, b.upload(std::span<const vec4>(points)), {.k = k, .max_radius = 10}).ids);
                const auto used = b.download(e.used);
                for (std::size_t q = 0; q < points.size(); ++q) {
                    const auto n = trees.find(points[q], k);
                    const auto flushed
                        = [](float x) { return x < std::numeric_limits<float>::min() ? 0.0f : x; }; // as kernels do
                    const float nth = flushed(n.distances2[k - 1]), fth = flushed(n.kth_of_flann);
                    ASSERT_EQ(irradiance[q].w, nth) << name_of(d) << ", k " << k << ", point " << q << ": nanoflann";
                    ASSERT_EQ(irradiance[q].w, fth) << name_of(d) << ", k " << k << ", point " << q << ": FLANN";
                    ASSERT_EQ(used[q].x, k);
                    ++compared;
                    if (flushed(n.distances2[k]) == nth || static_cast<double>(nth) <= least_disc2(points[q], 0))
                        continue; // a tie at the k-th: nanoflann does not specify which one it returns
                    const auto sorted = [&](auto first) {
                        std::vector<std::uint32_t> ids(first, first + k);
                        std::sort(ids.begin(), ids.end());
                        return ids;
                    };
                    const auto found = sorted(lists.begin() + static_cast<std::ptrdiff_t>(q * k));
                    ASSERT_EQ(found, sorted(n.ids.begin())) << name_of(d) << ", k " << k << ": nanoflann's photons";
                    ASSERT_EQ(found, sorted(n.ids_of_flann.begin())) << name_of(d) << ", k " << k << ": FLANN's";
                    if (k > 64)
                        continue; // sums of more powers round
                    glm::dvec3 sum(0);
                    for (uint i = 0; i < k; ++i)
                        sum += glm::dvec3(set.powers[n.ids[i]]);
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
