// Tiles, costs and contexts of the OpenGL backend.
#pragma once

#include "gl_algorithm_tests.hpp"
#include "gl_contexts.hpp"
#include "gl_test_kernels.hpp"

namespace photongrid {
namespace {

    TYPED_TEST(gl_backend_test, tile_size_changes_nothing)
    {
        const auto c = clouds(2000)[1];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8));
        const auto points = query_points(1500);
        const knn_settings s{.k = 20, .max_radius = 0.5f, .visits_per_pass = 64};
        const auto reference = map_and_search(this->cpu, c, g, 0, points, s);
        for (uint tile : {1u, 5u, 16u, 2048u}) {
            if (tile == 1) {
                gl_backend b({.context = TypeParam::kind, .tile = tile});
                expect_same(b.caps(), map_and_search(b, c, g, 0, {points.begin(), points.begin() + 100}, s),
                    map_and_search(this->cpu, c, g, 0, {points.begin(), points.begin() + 100}, s), s.k, "tile 1");
            } else {
                gl_backend b({.context = TypeParam::kind, .tile = tile});
                expect_same(
                    b.caps(), map_and_search(b, c, g, 0, points, s), reference, s.k, "tile " + std::to_string(tile));
            }
        }
        EXPECT_THROW(gl_backend({.context = TypeParam::kind, .tile = 0}), std::invalid_argument);
    }

    // On a device that rounds correctly nothing needs it; there its fma may round twice.
    TYPED_TEST(gl_backend_test, rewritten_quotients_and_roots_are_good)
    {
        gl_backend rewriting({.context = TypeParam::kind, .arithmetic = arithmetic_kind::rewritten});
        testing::expect_good_arithmetic(rewriting);
    }

    TYPED_TEST(gl_backend_test, rewritten_arithmetic_gives_the_same_light)
    {
        const auto c = clouds(5000)[1];
        const grid g = make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8));
        const auto points = query_points(100);
        const knn_settings s{.k = 20, .max_radius = 0.5f};
        gl_backend rewriting({.context = TypeParam::kind, .arithmetic = arithmetic_kind::rewritten});
        for (uint m : {0u, 4u})
            expect_same(rewriting.caps(), map_and_search(rewriting, c, g, m, points, s),
                map_and_search(this->cpu, c, g, m, points, s), s.k, "m " + std::to_string(m));
    }

    TYPED_TEST(gl_backend_test, counts_the_costs_of_kernels)
    {
        gl_backend b({.context = TypeParam::kind});
        EXPECT_TRUE(b.costs().empty());
        auto pairs = b.upload(view(noise<glm::uvec2>(1000, 1)));
        const auto report = bitonic_sort<gl_backend>(b, pairs); // the generic one, a pass a step
        const kernel_cost& cost = b.costs().at("bitonic_step");
        EXPECT_EQ(cost.passes, report.passes);
        EXPECT_GT(cost.compile_ms, 0);
        EXPECT_EQ(cost.instructions, 0u);
        EXPECT_EQ(cost.ms, 0);
    }

    TYPED_TEST(gl_backend_test, times_verbs_by_the_devices_clock_when_asked)
    {
        gl_backend b({.context = TypeParam::kind, .time_passes = true});
        const auto start = std::chrono::steady_clock::now();
        const auto c = clouds(5000)[0];
        // All verbs: sorts, routes, counts and searches.
        map_and_search(b, c, make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(8)), 2, query_points(5000),
            {.k = 20, .max_radius = 1});
        const double all = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        double sum = 0;
        for (const auto& [name, cost] : b.costs()) {
            // The draws of a route are timed together, as its kernel's.
            const bool of_a_route = name == "route_pattern" || name == "route_amount" || name == "route_gather";
            EXPECT_EQ(cost.ms > 0, !of_a_route) << name;
            sum += cost.ms;
        }
        EXPECT_LT(sum, all);
    }

    // Several contexts in one process, used in turn, and a buffer that outlives its backend.
    TEST(gl_contexts, live_side_by_side)
    {
        std::vector<gl_backend> all;
        for (const auto kind :
            {gl_context_kind::egl, gl_context_kind::osmesa, gl_context_kind::egl, gl_context_kind::any})
            try {
                all.emplace_back(gl_options{.context = kind});
            } catch (const backend_error&) {
            }
        if (all.size() < 2)
            GTEST_SKIP() << "fewer than two contexts can be had here";
        std::vector<buffer_of<gl_backend, glm::uvec2>> pairs;
        const auto data = noise<glm::uvec2>(5000, 1);
        for (auto& b : all)
            pairs.push_back(b.upload(view(data)));
        for (std::size_t i = 0; i < all.size(); ++i)
            bitonic_sort(all[i], pairs[i]);
        auto sorted = data;
        std::sort(sorted.begin(), sorted.end(), [](auto a, auto b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
        for (std::size_t i = all.size(); i-- > 0;)
            EXPECT_TRUE(same_bits(all[i].download(pairs[i]), sorted)) << all[i].caps().backend;
        auto kept = std::move(pairs[0]);
        pairs.clear();
        all.clear();
        EXPECT_EQ(kept.size(), 5000u);
    }

    // The caller's own context: an EGL one made here by hand.
    TEST(gl_contexts, works_in_the_callers)
    {
        std::string tried;
        const auto callers = gl::make_egl_context(false, tried);
        if (!callers)
            GTEST_SKIP() << tried;
        callers->use();
        auto& call = callers->call;
        {
            gl_backend b({.context = gl_context_kind::current, .debug = true});
            EXPECT_EQ(b.caps().backend, "gl");
            auto pairs = b.upload(view(noise<glm::uvec2>(5000, 1)));
            bitonic_sort(b, pairs);
            const auto first = b.download(pairs);
            // The caller leaves state behind that would spoil every pass.
            call.Enable(GL_SCISSOR_TEST);
            call.ScissorIndexed(0, 0, 0, 1, 1);
            call.ColorMaski(0, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
            call.Enable(GL_BLEND);
            call.Enable(GL_CULL_FACE);
            call.Enable(GL_RASTERIZER_DISCARD);
            call.PixelStorei(GL_UNPACK_ROW_LENGTH, 7);
            call.PixelStorei(GL_PACK_ROW_LENGTH, 9999);
            call.BindVertexArray(0);
            auto again = b.upload(view(noise<glm::uvec2>(5000, 1)));
            bitonic_sort(b, again);
            EXPECT_TRUE(same_bits(b.download(again), first));
            // Another context in between: the caller has to make its own current again, and is told so.
            gl_backend other({.context = gl_context_kind::egl});
            EXPECT_THROW(b.finish(), backend_error);
            callers->use();
            EXPECT_NO_THROW(b.finish());
        }
    }

    TEST(gl_contexts, a_missing_context_says_what_to_do)
    {
        // No context is current in a fresh thread.
        std::string text;
        std::thread([&] {
            try {
                gl_backend b({.context = gl_context_kind::current});
                text = "no error";
            } catch (const backend_error& e) {
                text = e.what();
            }
        }).join();
        EXPECT_NE(text.find("no OpenGL context is current"), std::string::npos) << text;
    }

} // namespace
} // namespace photongrid
