// The tree of lights from which samples of direct light choose.
#include "../map/photon_sets.hpp"

#include <photongrid/trace/light_tree.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

namespace photongrid::testing {
namespace {

    std::vector<light_ball> random_lights(std::size_t n, bool in_one_place)
    {
        random_source u(n);
        std::vector<light_ball> all(n);
        for (auto& l : all) {
            l.center = in_one_place ? dvec3(3, -4, 5) : dvec3(u(), 100 * u(), 0.001f * u());
            l.radius = u() < 0.5f ? 0.0 : static_cast<double>(u());
            l.power = std::pow(10.0, 6 * static_cast<double>(u()) - 3);
        }
        return all;
    }

    struct walk {
        const std::vector<light_ball>& lights;
        const std::vector<light_node>& nodes;
        unsigned depth = 0;

        /// The lights below a child. Each must be in the child's ball, in single precision, which kernels have.
        std::vector<std::size_t> below(std::int64_t child, unsigned level = 0)
        {
            depth = std::max(depth, level);
            if (child < 0)
                return {static_cast<std::size_t>(-1 - child)};
            const auto& node = nodes.at(static_cast<std::size_t>(child));
            auto all = below(node.left, level + 1);
            const auto others = below(node.right, level + 1);
            all.insert(all.end(), others.begin(), others.end());
            const dvec3 center(glm::vec3(node.ball.center));
            const auto radius = static_cast<double>(static_cast<float>(node.ball.radius));
            double power = 0;
            for (const std::size_t n : all) {
                EXPECT_LE(glm::distance(lights[n].center, center) + lights[n].radius, radius) << child;
                power += lights[n].power;
            }
            EXPECT_NEAR(power, node.ball.power, 1e-12 * power) << child;
            return all;
        }
    };

    TEST(light_tree, holds_each_light_once_in_balls_around_it)
    {
        for (const bool in_one_place : {false, true})
            for (const std::size_t n : {2u, 3u, 17u, 100u, 1000u}) {
                const auto lights = random_lights(n, in_one_place);
                const auto nodes = build_light_tree(lights);
                EXPECT_EQ(nodes.size(), n - 1);
                walk w{lights, nodes};
                auto found = w.below(0);
                std::ranges::sort(found);
                std::vector<std::size_t> each(n);
                std::iota(each.begin(), each.end(), std::size_t{0});
                EXPECT_EQ(found, each);
                EXPECT_LE(w.depth, static_cast<unsigned>(std::bit_width(n - 1))) << n;
            }
    }

    TEST(light_tree, of_less_than_two_lights_has_no_node)
    {
        EXPECT_TRUE(build_light_tree({}).empty());
        EXPECT_TRUE(build_light_tree(random_lights(1, false)).empty());
    }

    TEST(light_tree, does_not_depend_on_the_order_of_the_lights)
    {
        const auto lights = random_lights(300, false); // no two at one place
        const std::vector<light_ball> reversed(lights.rbegin(), lights.rend());
        const auto a = build_light_tree(lights), b = build_light_tree(reversed);
        ASSERT_EQ(a.size(), b.size());
        for (std::int64_t i = 0; i < static_cast<std::int64_t>(a.size()); ++i) {
            auto here = walk{lights, a}.below(i), there = walk{reversed, b}.below(i);
            for (auto& n : there)
                n = lights.size() - 1 - n;
            std::ranges::sort(here);
            std::ranges::sort(there);
            EXPECT_EQ(here, there) << i;
        }
    }

} // namespace
} // namespace photongrid::testing
