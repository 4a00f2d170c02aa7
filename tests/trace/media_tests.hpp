// Glass in glass, and glass that absorbs, on any backend: against formulas, against the same bodies drawn otherwise,
// and the serial backend's pictures. Included by each on_<backend>.cpp.
#pragma once

#include "media_scenes.hpp"
#include "mixture_tests.hpp"

namespace photongrid::testing {

template <class Tag>
class media : public mesh_scenes<Tag> {
protected:
    /// Only direct light.
    image seen(scene s)
    {
        s.render.output.only = light_part::direct;
        return this->picture(s);
    }
};
TYPED_TEST_SUITE_P(media);

TYPED_TEST_P(media, a_body_within_one_of_the_same_index_is_not_seen)
{
    auto s = before_coloured_squares();
    s.materials.push_back(clear_glass("outer", 1.5));
    s.spheres = {{{0, 0, 0}, 0.6, 4}};
    const auto alone = this->seen(s);
    for (const double priority : {1.0, 2.0}) {
        auto both = s;
        both.materials.push_back(clear_glass("inner", 1.5, priority));
        both.spheres.push_back({{0.2, 0.1, 0.1}, 0.3, 5});
        EXPECT_LE(relative_mse(this->seen(both), alone), 2e-3) << priority;
        // Its union with a body that it reaches out of does not depend on which of them is there.
        both.spheres[1].center.x = 0.6;
        auto other = both;
        std::swap(other.materials[4].priority, other.materials[5].priority);
        EXPECT_LE(relative_mse(this->seen(both), this->seen(other)), 2e-3) << priority;
        EXPECT_GT(relative_mse(this->seen(both), alone), 2e-2);
    }
}

TYPED_TEST_P(media, the_surface_of_one_in_another_refracts_by_their_ratio)
{
    auto s = before_coloured_squares();
    s.materials.push_back(clear_glass("outer", 1.5));
    s.materials.push_back(clear_glass("inner", 1.2, 2));
    s.spheres = {{{0, 0, 0}, 0.6, 4}, {{0.1, 0.1, 0.1}, 0.35, 5}};
    const auto nested = this->seen(s);
    auto by_ratio = s;
    by_ratio.materials[5] = clear_glass("inner", 1.2 / 1.5, 0);
    EXPECT_LE(relative_mse(nested, this->seen(by_ratio)), 2e-3);
    by_ratio.materials[5].index_of_refraction = 1.2;
    EXPECT_GT(relative_mse(nested, this->seen(by_ratio)), 2e-2);
    // A bubble is the inner face of a hollow ball.
    s.materials[5].index_of_refraction = 1;
    auto hollow = s;
    hollow.materials[5] = clear_glass("inner", 1 / 1.5, 0);
    EXPECT_LE(relative_mse(this->seen(s), this->seen(hollow)), 2e-3);
}

TYPED_TEST_P(media, walls_that_touch_are_as_walls_that_overlap)
{
    const auto glass_beside_water = [](double overlap, bool as_meshes) {
        auto s = before_coloured_squares();
        s.materials.push_back(clear_glass("glass", 1.6, 2));
        s.materials.push_back(clear_glass("water", 1.33));
        s.boxes = {{{-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}, 4},
            {{-0.5, -0.5, -0.5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.5 + overlap}, 5}};
        s.camera.position = {1.5, 0.5, 2.5};
        if (as_meshes) {
            for (const auto& b : s.boxes)
                for (const auto& face : faces_of(b))
                    s.polygons.push_back(face);
            s.boxes.clear();
            // One closed surface of each.
            std::map<std::uint32_t, mesh> closed;
            std::vector<polygon> others;
            for (const auto& p : s.polygons) {
                if (p.material < 4) {
                    others.push_back(p);
                    continue;
                }
                auto& m = closed[p.material];
                const auto first = static_cast<std::uint32_t>(m.positions.size());
                for (const auto& v : p.vertices)
                    m.positions.emplace_back(v);
                m.triangles.emplace_back(first, first + 1, first + 2);
                m.triangles.emplace_back(first, first + 2, first + 3);
            }
            s.polygons = others;
            for (const auto& [material, m] : closed)
                s.meshes.push_back({"", std::make_shared<const mesh>(m), glm::dmat3(1), dvec3(0), material});
        }
        return s;
    };
    for (const bool as_meshes : {false, true}) {
        const auto touching = this->seen(glass_beside_water(0, as_meshes));
        EXPECT_LE(relative_mse(touching, this->seen(glass_beside_water(0.2, as_meshes))), 5e-3) << as_meshes;
        auto apart = glass_beside_water(0, as_meshes);
        apart.materials[4].priority = apart.materials[5].priority = 0; // air between them
        EXPECT_GT(relative_mse(touching, this->seen(apart)), 2e-2) << as_meshes;
    }
}

TYPED_TEST_P(media, light_falls_exponentially_on_its_way)
{
    const dvec3 absorption(1, 2.5, 0);
    auto s = in_a_white_sky();
    s.materials = {clear_glass("tinted", 1)};
    s.materials[0].absorption = absorption;
    s.boxes = {{{-9, -9, -0.5}, {18, 0, 0}, {0, 18, 0}, {0, 0, 0.5}, 0}};
    const auto through_box = this->seen(s);
    const double half = std::tan(glm::radians(12.5));
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            const double right = half * ((x + 0.5) / 8 - 1), down = half * ((y + 0.5) / 8 - 1),
                         way = 0.5 * std::sqrt(1 + right * right + down * down);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(double(through_box.pixels[y * 16 + x][c]), std::exp(-absorption[c] * way), 1e-4);
        }
    // A camera within; and a lamp, which shows a square in it.
    s.boxes.clear();
    s.spheres = {{{0, 0, 3}, 0.75, 0}};
    for (const auto& p : this->seen(s).pixels)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(p[c]), std::exp(-absorption[c] * 0.75), 1e-4);
    s.environment_lights.clear();
    s.point_lights = {{"bulb", {0, 0, 3}, dvec3(1)}};
    s.materials.push_back({"white", material_kind::lambertian, dvec3(0.5)});
    s.polygons = {{{{-0.2, -0.2, 2.5}, {0.2, -0.2, 2.5}, {0.2, 0.2, 2.5}, {-0.2, 0.2, 2.5}}, 1}};
    const auto tinted = this->seen(s);
    s.materials[0].absorption = dvec3(0);
    const auto clear = this->seen(s);
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            const double right = half * ((x + 0.5) / 8 - 1), down = half * ((y + 0.5) / 8 - 1),
                         way = 2 * 0.5 * std::sqrt(1 + right * right + down * down); // there and back
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(double(tinted.pixels[y * 16 + x][c] / clear.pixels[y * 16 + x][c]),
                    std::exp(-absorption[c] * way), 1e-4);
        }
}

TYPED_TEST_P(media, photons_are_absorbed_on_their_way)
{
    auto& b = this->b();
    const dvec3 absorption(1, 2.5, 0.5);
    scene s;
    s.materials = {{"floor", material_kind::lambertian, dvec3(0)}, clear_glass("tinted", 1)};
    s.materials[1].absorption = absorption;
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    s.boxes = {{{-1, 0.5, -1}, {2, 0, 0}, {0, 0.5, 0}, {0, 0, 2}, 1}};
    s.directional_lights = {{"sun", {0, -1, 0}, dvec3(1)}};
    s.render.map.photons = 20000;
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, device, s.render);
    const auto stats = count_photons(b, t);
    EXPECT_EQ(stats.emitted, stats.absorbed + stats.escaped + stats.cut_off + stats.invalid);
    dvec3 sum(0);
    for (const auto& p : b.download(t.photons.powers))
        sum += dvec3(p);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], 4 * std::exp(-absorption[c] * 0.5), 0.03) << c; // 4 m^2
}

TYPED_TEST_P(media, equal_the_serial_backends)
{
    auto s = iced_water();
    s.materials[3].roughness = 0.4;
    s.point_lights = {{"bulb", {0.1, 0.5, 0.05}, dvec3(1)}}; // in the water
    s.render.map.photons = 4000;
    s.render.output.width = s.render.output.height = 12;
    this->expect_serial(s, s.render);
    s.render.estimate.indirect = indirect_kind::gather;
    s.render.map.caustic_photons = 4000;
    this->expect_serial(s, s.render);
}

REGISTER_TYPED_TEST_SUITE_P(media, a_body_within_one_of_the_same_index_is_not_seen,
    the_surface_of_one_in_another_refracts_by_their_ratio, walls_that_touch_are_as_walls_that_overlap,
    light_falls_exponentially_on_its_way, photons_are_absorbed_on_their_way, equal_the_serial_backends);

} // namespace photongrid::testing
