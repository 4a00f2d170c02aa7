// Routes, maps and searches of the OpenGL backend.
#pragma once

#include "../core/same_light.hpp"
#include "gl_contexts.hpp"
#include "gl_test_kernels.hpp"

namespace photongrid {
namespace {

    TYPED_TEST(gl_backend_test, routes_as_serial_does)
    {
        for (uint destinations : {1u, 7u, 3000u})
            for (uint m : {1u, 2u, 3u, 4u, 7u, 15u, 16u})
                for (std::size_t n : {0u, 1u, 255u, 256u, 257u, 20000u}) {
                    std::mt19937 random(m);
                    std::vector<glm::uvec2> pairs(n);
                    std::vector<glm::vec4> amounts(n);
                    for (std::size_t i = 0; i < n; ++i) {
                        const uint d = static_cast<uint>(random()) % (destinations + destinations / 8 + 1);
                        pairs[i] = {i % 3 == 0 ? destinations / 2
                                : i % 17 == 0  ? no_id
                                               : d,
                            static_cast<uint>(random())};
                        amounts[i]
                            = glm::vec4(1.0f / static_cast<float>(i + 1), static_cast<float>(d) * 0.1f, 1e-3f, 1.0f);
                    }
                    const auto route = [&](auto& b) {
                        const auto p = b.upload(view(pairs));
                        const auto a = b.upload(view(amounts));
                        auto slots = b.template make<uint>(destinations * route_capacity(m) + 5);
                        auto totals = b.template make<glm::vec4>(destinations + 3);
                        const launch l = n > 300 ? launch{n - 200, 100} : launch{n};
                        b.template route<test_kernels::to_place>(l, {}, reads(p, a), {destinations, m}, slots, totals);
                        return std::pair(b.download(slots), b.download(totals));
                    };
                    const auto a = route(this->gpu());
                    const auto c = route(this->cpu);
                    EXPECT_TRUE(same_bits(a.first, c.first)) << destinations << " destinations, m " << m << ", n " << n;
                    EXPECT_TRUE(same_bits(a.second, c.second))
                        << destinations << " destinations, m " << m << ", n " << n;
                }
    }

    /// A route draws the stencil pattern bit by bit, payloads, amounts, and the slots (2.2.2): all of them are counted.
    TYPED_TEST(gl_backend_test, the_draws_of_a_route_are_counted)
    {
        auto& b = this->gpu();
        const auto passes = [&] { return total_cost(b.costs()).passes; };
        const std::vector<glm::uvec2> pairs(100, glm::uvec2(3, 4));
        const auto p = b.upload(view(pairs));
        const auto a = b.upload(view(std::vector<glm::vec4>(100)));
        // The pattern's largest value is m * m - 1, or 255 where 8 bits hold no more slots.
        for (const auto& [m, bits] : {std::pair{1u, 0u}, {2u, 2u}, {4u, 4u}, {16u, 8u}}) {
            auto slots = b.template make<uint>(10 * route_capacity(m));
            auto totals = b.template make<glm::vec4>(10);
            const auto before = passes();
            b.template route<test_kernels::to_place>(launch{100}, {}, reads(p, a), {10, m}, slots, totals);
            EXPECT_EQ(passes() - before, bits + 3) << "m " << m;
        }
    }

    TYPED_TEST(gl_backend_test, sorts_and_indexes_as_serial_does)
    {
        for (std::size_t n : {0u, 1u, 2u, 3u, 5u, 1023u, 1024u, 1025u, 100000u})
            for (uint keys : {1u, 4u, 5000u, ~0u}) {
                auto data = noise<glm::uvec2>(n, keys);
                for (auto& p : data)
                    p.x = keys == ~0u ? p.x : p.x % keys;
                // The generic algorithm on both, though this backend has an override of it.
                const auto sort = [&]<class B>(B& b) {
                    auto pairs = b.upload(view(data));
                    const auto report = bitonic_sort<B>(b, pairs);
                    const auto index = grid_index(b, pairs, 5000);
                    return std::tuple(b.download(pairs), b.download(index), report.passes);
                };
                const auto a = sort(this->gpu());
                const auto c = sort(this->cpu);
                auto by_override = this->gpu().upload(view(data));
                bitonic_sort(this->gpu(), by_override);
                EXPECT_TRUE(same_bits(this->gpu().download(by_override), std::get<0>(c)))
                    << n << " pairs, keys " << keys;
                EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c))) << n << " pairs, keys " << keys;
                EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c))) << n << " pairs, keys " << keys;
                EXPECT_EQ(std::get<2>(a), std::get<2>(c));
            }
    }

    template <class B>
    auto map_and_search(
        B& b, const cloud& c, const grid& g, uint m, const std::vector<glm::vec4>& points, const knn_settings& s)
    {
        const auto map = m == 0 ? sorted_map(b, upload_cloud(b, c), g) : routed_map(b, upload_cloud(b, c), g, {m, 99});
        const auto queries = b.upload(view(points));
        const auto e = knn_grid_estimate(b, map, queries, s);
        return std::tuple(b.download(map.list), b.download(map.cells), b.download(map.photons.powers),
            b.download(e.irradiance), b.download(e.used), map.invalid, map.overflowing_cells);
    }
    template <class Tuple>
    void expect_same(const capabilities& device, const Tuple& a, const Tuple& c, uint k, const std::string& what)
    {
        EXPECT_TRUE(same_bits(std::get<0>(a), std::get<0>(c))) << what << ": list";
        EXPECT_TRUE(same_bits(std::get<1>(a), std::get<1>(c))) << what << ": cells";
        testing::expect_same_light(device, std::get<2>(a), std::get<2>(c), 1, what + ": powers");
        testing::expect_same_light(device, std::get<3>(a), std::get<3>(c), k, what + ": irradiance");
        EXPECT_TRUE(same_bits(std::get<4>(a), std::get<4>(c))) << what << ": used";
        EXPECT_EQ(std::get<5>(a), std::get<5>(c)) << what << ": invalid";
        EXPECT_EQ(std::get<6>(a), std::get<6>(c)) << what << ": overflowing";
    }
    std::vector<glm::vec4> query_points(std::size_t n)
    {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(-0.2f, 1.2f);
        std::vector<glm::vec4> points(n);
        for (auto& p : points)
            p = {unit(random), unit(random), unit(random), unit(random) < 1.0f ? 1.0f : 0.0f};
        for (std::size_t i = 0; i < n; i += 3)
            points[i] = {0.5f + 0.02f * unit(random), 0.52f, 0.52f, 1.0f};
        return points;
    }

    TYPED_TEST(gl_backend_test, maps_and_estimates_as_serial_does)
    {
        // Each of 36 maps is compared whole, and searched from points that take a software GPU most of the time.
        const auto points = query_points(100);
        for (const cloud& c : clouds(12000))
            for (const auto& [low, high, resolution] : {std::tuple{glm::vec3(0), glm::vec3(1), glm::uvec3(13, 7, 20)},
                     {glm::vec3(0), glm::vec3(1, 0.52f, 1), glm::uvec3(40, 1, 40)},
                     {glm::vec3(0.1f), glm::vec3(0.9f), glm::uvec3(1)}})
                for (uint m : {0u, 1u, 4u, 16u}) {
                    const grid g = make_grid(low, high, resolution);
                    const knn_settings s{.k = 32, .max_radius = 0.3f};
                    expect_same(this->gpu().caps(), map_and_search(this->gpu(), c, g, m, points, s),
                        map_and_search(this->cpu, c, g, m, points, s), s.k,
                        std::string(c.name) + ", grid of " + std::to_string(resolution.x) + " x "
                            + std::to_string(resolution.y) + ", m " + std::to_string(m));
                }
    }

    TYPED_TEST(gl_backend_test, keeps_70000_photons_of_one_cell)
    {
        // More than the iterations after which llvmpipe ends loops.
        const auto c = clouds(70000)[2];
        const auto points = query_points(200);
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(5));
        for (uint m : {0u, 16u}) {
            const knn_settings s{.k = 32, .max_radius = 1.0f};
            const auto a = map_and_search(this->gpu(), c, g, m, points, s);
            expect_same(
                this->gpu().caps(), a, map_and_search(this->cpu, c, g, m, points, s), s.k, "m " + std::to_string(m));
            const auto& used = std::get<4>(a);
            EXPECT_GE(std::accumulate(used.begin(), used.end(), 0u,
                          [](uint most, const glm::uvec2& u) { return std::max(most, u.y); }),
                m == 0 ? 70000u : 255u);
        }
    }

    TYPED_TEST(gl_backend_test, routes_100000_photons_to_one_cell)
    {
        const auto c = clouds(100000)[2];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(5));
        const auto points = query_points(10);
        for (uint m : {15u, 16u})
            expect_same(this->gpu().caps(), map_and_search(this->gpu(), c, g, m, points, {.k = 8, .max_radius = 1.0f}),
                map_and_search(this->cpu, c, g, m, points, {.k = 8, .max_radius = 1.0f}), 8, "m " + std::to_string(m));
    }

    TYPED_TEST(gl_backend_test, reads_nothing_back_between_passes)
    {
        gl_backend& b = this->gpu();
        const auto c = clouds(20000)[0];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(10));
        const auto points = query_points(5000);
        auto photons_to_sort = upload_cloud(b, c);
        auto photons_to_route = upload_cloud(b, c);
        const auto queries = b.upload(view(points));
        const auto readbacks = b.readbacks();
        const auto polls = b.query_polls();
        const auto sorted = sorted_map(b, std::move(photons_to_sort), g);
        const auto routed = routed_map(b, std::move(photons_to_route), g, 4);
        EXPECT_EQ(b.query_polls() - polls, 3u) << "three counts: invalid photons twice, overflowing cells once";
        knn_search search(b, sorted, queries,
            as_paper(knn_settings{.k = 40, .max_radius = 0.4f, .visits_per_pass = 20, .ranges_per_pass = 20}));
        const auto before = b.query_polls();
        const progress p = search.advance();
        const auto e = search.estimates();
        b.finish();
        EXPECT_EQ(b.readbacks(), readbacks);
        EXPECT_TRUE(p.finished);
        EXPECT_GT(p.passes, 20u);
        EXPECT_LE(b.query_polls() - before, p.passes / 8 + 1);
        EXPECT_GT(p.active.front(), p.active.back());
        EXPECT_TRUE(std::is_sorted(p.active.rbegin(), p.active.rend()));
        // Pass by pass it comes to the same.
        knn_search slow(b, sorted, queries,
            as_paper(knn_settings{.k = 40, .max_radius = 0.4f, .visits_per_pass = 20, .ranges_per_pass = 20}));
        uint passes = 0;
        for (progress one = slow.advance(1);; one = slow.advance(1)) {
            passes += one.passes;
            if (one.finished)
                break;
        }
        EXPECT_EQ(passes, p.passes);
        EXPECT_TRUE(same_bits(b.download(slow.estimates().irradiance), b.download(e.irradiance)));
    }

} // namespace
} // namespace photongrid
