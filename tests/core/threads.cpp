// One backend object to a thread, all kinds side by side in one process: nothing that they share behind the scenes may
// be written unguarded. tests/run.sh --full runs this under the thread sanitizer.
#include "../map/photon_sets.hpp"
#include "wanted_device_tests.hpp"

#include <backends_under_test.hpp>

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/map_builders.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <tuple>
#include <type_traits>

namespace photongrid::testing {

/// What one thread found with backends of its own.
struct findings {
    std::vector<std::vector<glm::uvec2>> used; ///< by each of its backends
    std::vector<std::vector<uint>> nearest;
    std::string failure;
};

template <backend B>
void search(B& b, std::uint64_t seed, findings& f)
{
    const auto s = make_photons(distribution::box_faces, 2000, {8, 8, 8}, seed);
    const auto points = b.upload(std::span<const glm::vec4>(make_points(s, 200, seed)));
    const auto map = sorted_map(b, upload_photons(b, s), s.g);
    const knn_settings settings{.k = 20, .max_radius = 1};
    auto used = b.download(knn_grid_estimate(b, map, points, settings).used);
    for (auto& u : used)
        u.y = 0; // how many were looked at is each backend's own affair
    f.used.push_back(std::move(used));
    f.nearest.push_back(b.download(knn_neighbours(b, map, points, settings).ids));
}

/// A backend that makes no threads of its own, where it has the choice.
template <backend B>
std::unique_ptr<B> make_one()
{
    if constexpr (std::is_constructible_v<B, uint>)
        return std::make_unique<B>(1u);
    else
        return std::make_unique<B>();
}

template <class... B>
struct each_of {
    static findings search_everywhere(std::uint64_t seed)
    {
        findings f;
        try {
            std::tuple<std::unique_ptr<B>...> all;
            const auto make_and_search = [&]<class One>(std::unique_ptr<One>& one) {
                one = make_one<One>();
                search(*one, seed, f);
            };
            (make_and_search(std::get<std::unique_ptr<B>>(all)), ...);
            (search(*std::get<std::unique_ptr<B>>(all), seed, f), ...); // they live side by side
        } catch (const std::exception& e) {
            f.failure = e.what();
        }
        return f;
    }
};
using everywhere = backends_under_test<each_of>;

TEST(threads, each_with_backends_of_its_own_find_what_one_alone_finds)
{
    constexpr std::size_t n = 4;
    std::vector<findings> found(n);
    {
        std::vector<std::jthread> threads;
        for (std::size_t t = 0; t < n; ++t)
            threads.emplace_back([&found, t] { found[t] = everywhere::search_everywhere(t); });
    }
    for (std::size_t t = 0; t < n; ++t) {
        ASSERT_EQ(found[t].failure, "");
        findings alone;
        serial_backend serial;
        search(serial, t, alone);
        for (std::size_t b = 0; b < found[t].used.size(); ++b) {
            EXPECT_EQ(found[t].used[b], alone.used[0]) << "thread " << t << ", its backend " << b;
            EXPECT_EQ(found[t].nearest[b], alone.nearest[0]) << "thread " << t << ", its backend " << b;
        }
    }
}

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, backends_under_test<::testing::Types>);

} // namespace photongrid::testing
