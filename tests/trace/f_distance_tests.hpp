// Hard case F6: far from the origin.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

// --- F6: far from the origin
// ------------------------------------------------------------------------------------------

/// The scene moved, exactly where its coordinates and `by` are multiples of 2^-20 below 2^32.
inline scene moved(const scene& s, const dvec3& by) { return detail::moved_back(s, -by); }

/// The scene with its coordinates rounded to multiples of 2^-20.
inline scene rounded_scene(scene s)
{
    const auto to_grid = [](dvec3& v) { v = glm::round(v * 0x1p20) * 0x1p-20; };
    for (auto& x : s.spheres)
        to_grid(x.center);
    for (auto& x : s.cylinders)
        to_grid(x.base), to_grid(x.top);
    for (auto& x : s.cones)
        to_grid(x.base), to_grid(x.apex);
    for (auto& x : s.paraboloids)
        to_grid(x.vertex), to_grid(x.rim);
    for (auto& x : s.disks)
        to_grid(x.center);
    for (auto& x : s.boxes)
        to_grid(x.corner);
    for (auto& x : s.polygons)
        for (auto& v : x.vertices)
            to_grid(v);
    for (auto& x : s.point_lights)
        to_grid(x.position);
    for (auto& x : s.rectangle_lights)
        to_grid(x.corner), to_grid(x.edge_u), to_grid(x.edge_v);
    to_grid(s.camera.position);
    to_grid(s.camera.look_at);
    return s;
}

TYPED_TEST_P(hard_cases, f6_a_scene_far_away_renders_the_same)
{
    auto blocks = read_scene(std::string(PHOTONGRID_SCENES) + "/cornell_blocks.json");
    blocks.render.output.width = blocks.render.output.height = 48;
    blocks.render.map.photons = 8000;
    blocks.render.estimate.k = 80;
    for (const auto& s : {rounded_scene(blocks), rounded_scene(all_shapes())}) {
        const dvec3 by(1e6, -1e6, 1e6);
        const auto here = render(this->b(), s), there = render(this->b(), moved(s, by));
        EXPECT_EQ(count_different_bits(here.picture.pixels, there.picture.pixels), 0u) << s.name;
        EXPECT_EQ(here.stats.photons.emitted, there.stats.photons.emitted);
    }
    // Coordinates that are not multiples: rounding to double at 10^6 moves them by up to 2^-34 m.
    auto s = all_shapes();
    for (auto& x : s.spheres)
        x.center += dvec3(1e-3 / 3, 0, 0);
    s.spheres[0].center.y += 1e-4; // touches the floor
    const auto here = render(this->b(), s).picture,
               there = render(this->b(), moved(s, dvec3(1e6 + 0.1, 1e6 / 3, -1e6))).picture;
    const double difference = relative_mse(there, here);
    this->report("F6", "relMSE of a scene moved by 10^6 m, coordinates not multiples of 2^-20:", difference);
    EXPECT_LE(difference, 0.005);
}

/// Vertices in double precision, as readers of files hand them to set_positions().
TYPED_TEST_P(hard_cases, f6_a_mesh_far_away_looks_the_same)
{
    const auto room_at = [](const dvec3& at) {
        auto s = empty_scene(at + dvec3(0.3, 1.7, 0.4));
        const auto put = [&](double size, const dvec3& middle) {
            std::vector<dvec3> places;
            for (int i = 0; i < 8; ++i)
                places.push_back(
                    at + middle + size * dvec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1));
            mesh m;
            m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
            set_positions(m, places);
            s.meshes.push_back({"", std::make_shared<const mesh>(std::move(m)), glm::dmat3(1), dvec3(0), 0});
        };
        put(2, {0, 0.1, 0});
        put(0.4, {0.2, -1.5, 0.1});
        s.camera = {at + dvec3(0.1, 0.2, 1.9), at + dvec3(0, -1, 0), {0, 1, 0}, 60};
        s.render = {
            .map = {.photons = 8000}, .estimate = {.k = 80, .max_radius = 0.5}, .output = {.width = 32, .height = 32}};
        return s;
    };
    const auto here = render(this->b(), room_at(dvec3(0))).picture;
    for (const dvec3 at : {dvec3(500000.1, 5400000.1, 100), dvec3(0, -300.7, 0), dvec3(3e8 + 0.1, 0, 0)}) {
        const auto there = render(this->b(), room_at(at)).picture;
        const double difference = relative_mse(there, here);
        this->report("F6", "relMSE of meshes moved to " + std::to_string(glm::length(at)) + " m:", difference);
        EXPECT_LE(difference, 0.005);
    }
}

} // namespace photongrid::testing
