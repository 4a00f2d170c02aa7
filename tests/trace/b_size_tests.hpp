// Hard case B16: small shapes beside large or far ones, whose sizes do not count for them.
#pragma once

#include "b_leaving_tests.hpp"

#include <functional>

namespace photongrid::testing {

/// A ball of 2 cm under a lamp of 0.5 m, seen from half a metre; the ground is to be added.
inline scene ball_under_a_lamp()
{
    auto s = empty_scene(dvec3(0));
    s.point_lights.clear();
    s.spheres = {{{0, 0.05, 0}, 0.02, 0}};
    s.rectangle_lights = {{"lamp", {-0.25, 1.98, -0.25}, {0.5, 0, 0}, {0, 0, 0.5}, dvec3(10)}};
    s.camera = {{0, 0.3, 0.4}, {0, 0.03, 0}, {0, 1, 0}, 30};
    s.render
        = {.map = {.photons = 5000}, .estimate = {.k = 50, .max_radius = 0.3}, .output = {.width = 20, .height = 20}};
    s.render.view.spp = 4;
    s.render.output.only = light_part::direct;
    return s;
}

/// A mesh of two triangles or more, whose places are in double precision.
inline placed_mesh mesh_at(const std::vector<dvec3>& places, const std::vector<glm::uvec3>& triangles)
{
    mesh m;
    m.triangles = triangles;
    set_positions(m, places);
    return {"", std::make_shared<const mesh>(std::move(m)), glm::dmat3(1), dvec3(0), 0};
}

TYPED_TEST_P(hard_cases, b16_a_small_ball_on_a_large_ground_is_drawn)
{
    using ground = std::function<void(scene&, double)>;
    const std::pair<const char*, ground> grounds[] = {
        {"polygon",
            [](scene& s, double r) {
                s.polygons = {{{{-r, 0, -r}, {-r, 0, r}, {r, 0, r}, {r, 0, -r}}, 0}};
            }},
        {"disk",
            [](scene& s, double r) {
                s.disks = {{{0, 0, 0}, {0, 1, 0}, r, 0}};
            }},
        {"box",
            [](scene& s, double r) {
                s.boxes = {{{-r, -1, -r}, {0, 0, 2 * r}, {2 * r, 0, 0}, {0, 1, 0}, 0}};
            }},
        {"mesh",
            [](scene& s, double r) {
                s.meshes = {mesh_at({{-r, 0, -r}, {-r, 0, r}, {r, 0, r}, {r, 0, -r}}, {{0, 1, 2}, {0, 2, 3}})};
            }},
    };
    for (const auto& [name, add] : grounds) {
        auto near = ball_under_a_lamp(), wide = near;
        add(near, 16);
        add(wide, 10000);
        EXPECT_TRUE(detail::extent_of(near).is_even) << name;
        EXPECT_FALSE(detail::extent_of(wide).is_even) << name;
        const double difference = relative_mse(render(this->b(), wide).picture, render(this->b(), near).picture);
        this->report("B16", std::string("relMSE of 2 cm on 20 km, not 32 m, of ") + name + ":", difference);
        EXPECT_LE(difference, 1e-3) << name;
    }
}

TYPED_TEST_P(hard_cases, b16_lamps_of_any_size_light_what_is_small)
{
    auto s = ball_under_a_lamp();
    s.rectangle_lights.clear();
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    const auto lit_by = [&](const sphere_light& l) {
        auto with = s;
        with.sphere_lights = {l};
        return render(this->b(), with).picture;
    };
    // Suns that look the same, at 1,000 m and at 3,000 km.
    const auto near = lit_by({"sun", {0, 800, 600}, 10, dvec3(1e6)}),
               far = lit_by({"sun", {0, 2.4e6, 1.8e6}, 3e4, dvec3(9e12)});
    EXPECT_LE(relative_mse(far, near), 1e-3);
    // A lamp that is too small for single precision is a point.
    auto by_point = s;
    by_point.point_lights = {{"bulb", {0, 1.5, 0.2}, dvec3(10)}};
    const auto tiny = lit_by({"ember", {0, 1.5, 0.2}, 1e-7, dvec3(10)});
    EXPECT_LE(relative_mse(tiny, render(this->b(), by_point).picture), 1e-3);
}

TYPED_TEST_P(hard_cases, b16_rays_that_leave_small_shapes_do_not_hit_them)
{
    std::size_t again = 0, cast = 0;
    for (std::uint64_t seed = 0; seed < 28; ++seed) {
        scene s;
        rays r;
        reintersect(seed, s, r, std::pow(10.0, -1 - static_cast<double>(seed % 4)));
        const double size = detail::extent_of(s).smallest.size;
        EXPECT_FALSE(detail::extent_of(s).is_even) << "seed " << seed;
        const auto hits = this->trace(s, r);
        rays out;
        for (std::size_t i = 0; i < r.size(); ++i) {
            const dvec3 n(hits.facings[i]);
            if (dvec3 l(r.leavings[i]); hits.hit(i)) {
                l = glm::dot(l, n) < 0 ? l - 2 * glm::dot(l, n) * n : l;
                r.leavings[i] = glm::vec4(glm::vec3(l), 0.0f);
            }
        }
        const auto left = this->trace(s, r);
        for (std::size_t i = 0; i < r.size(); ++i)
            if (left.hit(i) && static_cast<double>(left.places[i].w) < 1e6 * size
                && glm::dot(dvec3(r.leavings[i]), dvec3(left.facings[i])) >= 0)
                out.add(glm::vec3(left.starts[i]), glm::vec3(r.leavings[i]));
        const auto second = this->trace(s, out);
        for (std::size_t i = 0; i < out.size(); ++i)
            again += second.hit(i) && static_cast<double>(second.places[i].w) < 10 * size ? 1u : 0u;
        cast += out.size();
        EXPECT_GT(out.size(), r.size() / 20) << "seed " << seed;
    }
    EXPECT_EQ(again, 0u) << "of " << cast;
}

} // namespace photongrid::testing
