// The choice of a backend at run time.
#include <photongrid/backends/any/any.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace photongrid {
namespace {

    scene lit_floor()
    {
        scene s;
        s.materials = {{"white", material_kind::lambertian, dvec3(0.7)}};
        s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
        s.spheres = {{{0.2, 0.3, 0}, 0.3, 0}};
        s.point_lights = {{"lamp", {0, 1, 0.5}, dvec3(10)}};
        s.camera = {{0, 1, 1}, {0, 0, 0}, {0, 1, 0}, 40};
        s.render.output.width = s.render.output.height = 96;
        return s;
    }
    std::vector<std::string> names(const std::vector<timed_backend>& all)
    {
        std::vector<std::string> out;
        for (const auto& t : all)
            out.push_back(t.options.backend);
        return out;
    }

    TEST(candidates, are_what_auto_may_stand_for)
    {
        const auto all = candidates({.threads = 3});
        ASSERT_FALSE(all.empty());
        EXPECT_TRUE(all.back().backend == "cpu" || all.back().backend == "serial");
        EXPECT_EQ(all.back().threads, 3u);
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            EXPECT_EQ(all[i].backend, "vulkan") << "a backend with hardware";
            EXPECT_FALSE(all[i].device.empty());
        }
        const auto named = candidates({.backend = "gl-osmesa"});
        ASSERT_EQ(named.size(), 1u);
        EXPECT_EQ(named[0].backend, "gl-osmesa");
    }

    // Neither settings that choose themselves nor rules that end a picture keep a backend from being timed. The
    // specification in one thread is the slowest, whatever else runs.
    TEST(by_speed, puts_the_fastest_first_and_what_fails_last)
    {
        auto s = lit_floor();
        s.render.output.until_error = 1e-9;
        s.render.output.seconds = 1000;
        const std::vector<renderer_options> asked{
            {.backend = "vulkan", .device = "no such device"}, {.backend = "serial"}, {.backend = "cpu"}};
        const auto timed = by_speed(asked, s, s.render);
        EXPECT_EQ(names(timed), (std::vector<std::string>{"cpu", "serial", "vulkan"}));
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_TRUE(std::isfinite(timed[i].pass_seconds) && timed[i].pass_seconds > 0);
            EXPECT_EQ(timed[i].failure, "");
        }
        EXPECT_FALSE(std::isfinite(timed[2].pass_seconds));
        EXPECT_NE(timed[2].failure, "");
    }
    TEST(by_speed, times_the_smallest_pictures)
    {
        auto s = lit_floor();
        s.render.output.width = s.render.output.height = 1;
        s.render.map.photons = 1;
        s.render.output.passes = 1;
        const std::vector<renderer_options> asked{{.backend = "cpu"}, {.backend = "serial"}};
        for (const auto& t : by_speed(asked, s, s.render))
            EXPECT_TRUE(std::isfinite(t.pass_seconds) && t.pass_seconds > 0) << t.options.backend << t.failure;
    }
    TEST(by_speed, refuses_what_start_refuses)
    {
        auto s = lit_floor();
        s.render.output.width = 0;
        const std::vector<renderer_options> asked{{.backend = "serial"}};
        EXPECT_THROW(by_speed(asked, s, s.render), std::invalid_argument);
    }

} // namespace
} // namespace photongrid
