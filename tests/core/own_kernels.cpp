// Kernels of a user's own (photongrid_add_kernels), on every backend: those of examples/point_cloud, and a payload of
// twelve bands. References: brute force in double.
#include "../../examples/point_cloud/forest.hpp"
#include "../backends/on_serial.hpp"
#include "../map/photon_sets.hpp"
#include "spectral_kernels.hpp"
#include "under_test.hpp"
#include "wanted_device_tests.hpp"

#include <backends_under_test.hpp>

#include <algorithm>
#include <numeric>

namespace photongrid::testing {

template <class B>
struct tag_of {
    using type = B;
    static constexpr const char* name = std::same_as<B, serial_backend> ? "serial" : "device";
    static std::unique_ptr<B> make() { return std::make_unique<B>(); }
};

template <class Tag>
class own_kernels : public on_backend<Tag> {
};
template <class... B>
using tags_of = ::testing::Types<tag_of<B>...>;
TYPED_TEST_SUITE(own_kernels, backends_under_test<tags_of>);

std::vector<tree> random_trees(std::size_t n)
{
    random_source u(11);
    std::vector<tree> trees;
    for (std::size_t i = 0; i < n; ++i)
        trees.push_back({static_cast<double>(100 * u()), static_cast<double>(100 * u()), 5 + 20 * u()});
    return trees;
}

/// All trees, nearest first: squared distance in double, index.
std::vector<std::pair<double, std::size_t>> by_distance(const std::vector<tree>& trees, glm::vec3 place)
{
    std::vector<std::pair<double, std::size_t>> all;
    for (std::size_t i = 0; i < trees.size(); ++i) {
        const double x = trees[i].east - static_cast<double>(place.x),
                     y = trees[i].north - static_cast<double>(place.y);
        all.emplace_back(x * x + y * y, i);
    }
    std::sort(all.begin(), all.end());
    return all;
}

TYPED_TEST(own_kernels, survey_a_forest)
{
    const auto trees = random_trees(3000);
    const std::vector<glm::vec3> queries{{50, 50, 0}, {1, 99, 0}, {80, 20, 0}, {-5, 50, 0}};
    constexpr uint k = 37;
    const auto surveys = survey_forest(this->b(), trees, queries, k);
    ASSERT_EQ(surveys.size(), queries.size());
    for (std::size_t p = 0; p < queries.size(); ++p) {
        const auto expected = by_distance(trees, queries[p]);
        double height = 0, weights = 0;
        for (uint n = 0; n < k; ++n) {
            const auto& [d2, id] = expected[n];
            EXPECT_EQ(surveys[p].nearest[n], id) << "place " << p << ", neighbour " << n;
            EXPECT_NEAR(static_cast<double>(surveys[p].distances[n]), std::sqrt(d2), 1e-5 * std::sqrt(d2) + 1e-5);
            height += static_cast<double>(trees[id].height) / (1 + d2);
            weights += 1 / (1 + d2);
        }
        EXPECT_NEAR(static_cast<double>(surveys[p].mean_height), height / weights, 1e-5 * height / weights);
        const double per_hectare = 1e4 * (k - 1) / (M_PI * expected[k - 1].first);
        EXPECT_NEAR(static_cast<double>(surveys[p].trees_per_hectare), per_hectare, 1e-5 * per_hectare);
    }
}

TYPED_TEST(own_kernels, say_so_where_there_are_fewer_neighbours_than_wanted)
{
    const auto surveys = survey_forest(this->b(), random_trees(3), {{50, 50, 0}}, 8);
    EXPECT_EQ(surveys[0].nearest.size(), 3u);
    const auto none = survey_forest(this->b(), {}, {{50, 50, 0}}, 8);
    EXPECT_EQ(none[0].nearest.size(), 0u);
    EXPECT_EQ(none[0].mean_height, 0.0f);
}

TYPED_TEST(own_kernels, add_up_spectra_of_twelve_bands)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::planar, 2000, {20, 1, 20}, 12);
    random_source u(13);
    constexpr uint groups = 3, k = 50;
    std::vector<glm::vec4> spectra;
    for (std::size_t i = 0; i < set.positions.size() * groups; ++i)
        spectra.emplace_back(u(), u(), u(), u());
    const std::vector<glm::vec4> points{{0.5f, 0, 0.5f, 1}, {0.3f, 0, 0.8f, 1}};
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto lists = knn_neighbours(b, map, b.upload(std::span<const glm::vec4>(points)), {.k = k, .max_radius = 1});
    auto irradiance = b.template make<glm::vec4>(points.size() * groups);
    b.template run<spectral::spectral_irradiance>(irradiance.size(), {.k = k, .groups = groups},
        reads(lists.ids, lists.distances2, b.upload(std::span<const glm::vec4>(spectra))), writes(irradiance));
    const auto found = b.download(irradiance);
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::vector<std::pair<float, std::size_t>> near;
        for (std::size_t i = 0; i < set.positions.size(); ++i)
            near.emplace_back(distance2(set.positions[i], points[p]), i);
        std::sort(near.begin(), near.end());
        for (uint g = 0; g < groups; ++g)
            for (int c = 0; c < 4; ++c) {
                double sum = 0;
                for (uint n = 0; n + 1 < k; ++n)
                    sum += static_cast<double>(spectra[near[n].second * groups + g][c]);
                const double expected = sum / (M_PI * static_cast<double>(near[k - 1].first));
                EXPECT_NEAR(static_cast<double>(found[p * groups + g][c]), expected, 1e-5 * expected)
                    << "point " << p << ", band " << 4 * g + static_cast<uint>(c);
            }
    }
}

TYPED_TEST(own_kernels, have_their_mistakes_reported_where_they_are)
{
    auto& b = this->b();
    auto result = b.template make<uint>(4);
    if (b.caps().backend == "serial" || b.caps().backend == "cpu") {
        b.template run<spectral::mistaken>(4, {}, reads(), writes(result));
        EXPECT_EQ(b.download(result), (std::vector<uint>{0, 2, 4, 6}));
        return;
    }
    try {
        b.template run<spectral::mistaken>(4, {}, reads(), writes(result));
        FAIL() << "GLSL took `auto`";
    } catch (const backend_error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("own_kernels/mistaken.glsl:10: error:"), std::string::npos) << text;
        EXPECT_NE(text.find("auto twice = 2u * i;"), std::string::npos) << text;
    }
}

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, backends_under_test<::testing::Types>);

} // namespace photongrid::testing
