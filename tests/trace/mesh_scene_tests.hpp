// Meshes in scenes, on any backend: pictures of polygons as meshes, rooms that no light leaves, and the serial
// backend's photons and pictures. Included by each on_<backend>.cpp.
#pragma once

#include "../render/known_energy_tests.hpp"
#include "../render/known_picture_tests.hpp"
#include "mesh_leaving.hpp"
#include "mesh_sets.hpp"

namespace photongrid::testing {

template <class Tag>
class mesh_scenes : public pictures<Tag> {
protected:
    photon_stats traced(const scene& s)
    {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        const auto t = trace_photons(b, device, s.render);
        return count_photons(b, t);
    }

    /// Under a pane that refracts nothing the photon map has the light that shadow rays find without it: all pixels
    /// together within `share`. Returns both pictures.
    std::pair<image, image> expect_the_same_light_under(const polygon& pane, scene s, double share)
    {
        s.render.output.only = light_part::direct;
        auto direct = this->picture(s);
        s.polygons.push_back(pane);
        s.render.output.only = light_part::caustic;
        auto through_pane = this->picture(s);
        double sum = 0, known = 0;
        for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
            sum += static_cast<double>(through_pane.pixels[i].x);
            known += static_cast<double>(direct.pixels[i].x);
        }
        EXPECT_NEAR(sum, known, share * known);
        return {std::move(direct), std::move(through_pane)};
    }
};
TYPED_TEST_SUITE_P(mesh_scenes);

/// Inside a closed surface with bumps, which are concave and convex edges.
inline scene bumpy_room(uint triangles, float size, const dvec3& middle)
{
    scene s;
    s.name = "bumpy_room";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.95)}};
    s.meshes = {{"", std::make_shared<const mesh>(bumpy_ball(rings_of(triangles), 1, 0.2f)),
        glm::dmat3(static_cast<double>(size)), middle, 0}};
    s.point_lights = {{"bulb", middle, dvec3(10)}};
    s.camera = {middle + dvec3(0.1 * static_cast<double>(size)), middle, {0, 1, 0}, 90};
    s.render = {.map = {.photons = 30000, .photon_depth = 40, .grid = {12, 12, 12}},
        .estimate = {.k = 50, .max_radius = 0.3 * static_cast<double>(size)},
        .output = {.width = 16, .height = 16}};
    return s;
}

/// A glass ball in that room.
inline scene bumpy_room_with_glass()
{
    auto s = bumpy_room(600, 2, {0.5, 0.25, -3});
    s.materials.push_back({"glass", material_kind::glass, dvec3(1), 1.5});
    s.meshes.push_back(
        {"", std::make_shared<const mesh>(bumpy_ball(12, 1, 0.05f)), glm::dmat3(0.4), {0.9, 0.25, -3}, 1});
    return s;
}

TYPED_TEST_P(mesh_scenes, draw_what_their_polygons_draw)
{
    for (auto s : {small_cornell(), all_shapes()}) {
        s.render.estimate.edges = edge_correction::none; // probes are turned by the bits of points
        const auto m = with_meshes(s);
        ASSERT_EQ(m.meshes.size(), s.polygons.size());
        render_stats by_polygons, by_meshes;
        // A ray through an edge may see the one surface or the other: at most a hundredth of the pixels.
        const auto a = this->picture(s, s.render, &by_polygons), b = this->picture(m, s.render, &by_meshes);
        std::size_t different = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (std::abs(a.pixels[i][c] - b.pixels[i][c]) > 1e-3f * (a.pixels[i][c] + 0.01f)) {
                    ++different;
                    break;
                }
        EXPECT_LE(different, a.pixels.size() / 100) << s.name;
        EXPECT_LE(relative_mse(b, a), 1e-3) << s.name;
        EXPECT_NEAR(static_cast<double>(by_meshes.photons.emitted), static_cast<double>(by_polygons.photons.emitted),
            1e-3 * static_cast<double>(by_polygons.photons.emitted))
            << s.name;
        expect_an_exact_account(by_meshes.photons, s.render.map.photons);
    }
}

TYPED_TEST_P(mesh_scenes, equal_the_serial_backends)
{
    const auto s = all_shapes_and_meshes();
    this->expect_serial(s, s.render);
}

TYPED_TEST_P(mesh_scenes, rooms_of_meshes_equal_the_serial_backends)
{
    auto s = bumpy_room_with_glass();
    s.render.view.spp = 3;
    this->expect_serial(s, s.render);
}

TYPED_TEST_P(mesh_scenes, no_photon_leaves_a_closed_room)
{
    for (const auto& s : {bumpy_room(600, 1, dvec3(0)), bumpy_room(3000, 1000, {1e4, 0, 0}), bumpy_room_with_glass()}) {
        const auto p = this->traced(s);
        EXPECT_EQ(p.escaped, 0u) << "of " << p.emitted << " paths, with " << p.diffuse_hits << " hits";
        EXPECT_GT(p.diffuse_hits, 10 * p.emitted);
        expect_an_exact_account(p, s.render.map.photons);
    }
}

/// Wide and flat, of large triangles, so that offsets of rays are a good part of its height.
TYPED_TEST_P(mesh_scenes, no_photon_leaves_a_thin_box)
{
    for (const double height : {1e-2, 1e-4}) {
        scene s;
        s.materials = {{"white", material_kind::lambertian, dvec3(0.95)}};
        mesh m;
        for (uint i = 0; i < 8; ++i)
            m.positions.emplace_back(
                (i & 1u) != 0 ? 0.5 : -0.5, (i & 2u) != 0 ? 0.5 : -0.5, (i & 4u) != 0 ? 0.5 * height : -0.5 * height);
        m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
            {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
        const dvec3 x = glm::normalize(dvec3(1, 2, 3)), y = glm::normalize(glm::cross(x, dvec3(1, 0, 0)));
        s.meshes = {{"", std::make_shared<const mesh>(m), glm::dmat3(x, y, glm::cross(x, y)), dvec3(0), 0}};
        s.point_lights = {{"bulb", dvec3(0), dvec3(1)}};
        s.camera = {dvec3(0, 0, 2), dvec3(0), {0, 1, 0}, 40};
        s.render = {.map = {.photons = 60000, .photon_depth = 40, .grid = {12, 12, 12}}, .estimate = {.k = 50}};
        const auto p = this->traced(s);
        EXPECT_EQ(p.escaped, 0u) << "of " << p.emitted << " paths, with " << p.diffuse_hits << " hits, " << height;
        expect_an_exact_account(p, s.render.map.photons);
    }
}

TYPED_TEST_P(mesh_scenes, rays_that_leave_a_flat_mesh_do_not_hit_it)
{
    std::size_t cast = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        scene s;
        const double size = flat_mesh(seed, s);
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        const auto away = leaving_rays(b, s, device, seed + 100, 5000, size);
        const auto hits = surfaces_hit(b, device, away);
        std::size_t again = 0;
        for (std::size_t i = 0; i < away.size(); ++i) {
            // The other place of the mesh is far away.
            again += hits.places[i].w >= 0 && static_cast<double>(hits.places[i].w) < 200 * size ? 1 : 0;
        }
        EXPECT_EQ(again, 0u) << "of " << away.size() << ", seed " << seed;
        cast += away.size();
        if (!this->divides_exactly())
            continue;
        serial_backend serial;
        const auto theirs = surfaces_hit(serial, upload_scene(serial, s), away);
        EXPECT_EQ(count_different_bits(hits.places, theirs.places), 0u) << "seed " << seed;
    }
    EXPECT_GT(cast, 90000u);
}

/// A flat mesh under a lamp, as it is read from files: all its light is direct.
TYPED_TEST_P(mesh_scenes, photons_of_a_flat_mesh_do_not_hit_it)
{
    for (const bool tilted : {false, true}) {
        scene s;
        s.materials = {{"white", material_kind::lambertian, dvec3(0.9)}};
        const float z = tilted ? 0.3f : 0, more = tilted ? 0.4f : 0;
        const mesh m{{{0, 0, z}, {1, 0, z + more}, {1, 1, z + 2 * more}, {0, 1, z + more}}, {{0, 1, 2}, {0, 2, 3}}};
        s.meshes = {{"", std::make_shared<const mesh>(m), glm::dmat3(1), dvec3(0), 0}};
        s.rectangle_lights = {{"lamp", {0, 0, 2}, {0, 1, 0}, {1, 0, 0}, dvec3(1)}};
        s.render.map.photons = 1000; // none is found among 256 times as many
        const auto p = this->traced(s);
        EXPECT_EQ(p.stored, 0u) << (tilted ? "tilted" : "level");
        EXPECT_GT(p.direct, 10000u);
    }
}

/// Whatever way light takes through glass that absorbs nothing, it comes from a lamp, and all lamps are alike. Glass by
/// its shading normals neither adds nor takes.
TYPED_TEST_P(mesh_scenes, smooth_glass_and_mirrors_amid_lamps_cannot_be_seen)
{
    for (const auto& m :
        {material{"glass", material_kind::glass, dvec3(1), 1.5}, material{"mirror", material_kind::mirror, dvec3(1)}}) {
        auto s = ball_amid_lamps(m);
        s.spheres.clear();
        // Coarse, so that many rays see it from behind its shading normals.
        s.meshes = {{"", std::make_shared<const mesh>(smooth_ball(8)), glm::dmat3(0.5), dvec3(0), 1}};
        const auto drawn = this->picture(s);
        dvec3 mean(0);
        for (const auto& p : drawn.pixels)
            mean += dvec3(p) / static_cast<double>(drawn.pixels.size());
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(
                mean[c], dvec3(1, 2, 4)[c], 0.005 * dvec3(1, 2, 4)[c]) // past 8 surfaces some rays end by chance
                << m.name << ", channel " << c;
    }
}

/// Glass of index n around a white body has n^2 times the radiance of the lamps inside, and the body reflects all of
/// it: from outside it looks like the lamps.
TYPED_TEST_P(mesh_scenes, a_white_body_in_glass_amid_lamps_cannot_be_seen)
{
    for (const bool by_mesh : {false, true}) {
        auto s = ball_amid_lamps({"glass", material_kind::glass, dvec3(1), 1.5});
        s.materials.push_back({"white", material_kind::lambertian, dvec3(1)});
        if (by_mesh) {
            const auto ball = std::make_shared<const mesh>(smooth_ball(30));
            s.spheres.clear();
            s.meshes = {{"", ball, glm::dmat3(0.5), dvec3(0), 1}, {"", ball, glm::dmat3(0.25), dvec3(0), 2}};
        } else {
            s.spheres.push_back({dvec3(0), 0.25, 2});
        }
        s.render.output.only = light_part::all;
        s.render.map = {.photons = 60000, .photon_depth = 64, .grid = {16, 16, 16}};
        s.render.estimate.k = 200;
        s.render.estimate.max_radius = 0.1;
        const auto drawn = this->picture(s);
        // Pixels that see the body.
        dvec3 mean(0);
        double seen = 0;
        for (uint y = 12; y < 20; ++y)
            for (uint x = 12; x < 20; ++x, ++seen)
                mean += dvec3(drawn.pixels[y * s.render.output.width + x]);
        mean /= seen;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c], dvec3(1, 2, 4)[c], 0.03 * dvec3(1, 2, 4)[c]) << by_mesh << ", channel " << c;
    }
}

/// Glass of index 1 refracts nothing. Through it the photon map has the light that shadow rays find without it, about
/// the normals that a flat floor claims to have.
TYPED_TEST_P(mesh_scenes, photons_and_shadow_rays_light_by_the_same_normals)
{
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.8)}, {"pane", material_kind::glass, dvec3(1), 1}};
    mesh floor{{{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, {{0, 1, 2}, {0, 2, 3}},
        std::vector<glm::vec3>(4, {1.5f, 2, 0.5f})};
    s.meshes = {{"", std::make_shared<const mesh>(floor), glm::dmat3(1), dvec3(0), 0}};
    s.point_lights = {{"bulb", {0.75, 1, 0.25}, dvec3(10)}};
    s.camera = {{0.1, 2, 0}, {0, 0, 0}, {0, 0, 1}, 40};
    s.render = {.map = {.photons = 60000, .grid = {40, 1, 40}},
        .estimate = {.k = 200, .max_radius = 0.2},
        .output = {.width = 16, .height = 16}};
    const auto [direct, through_pane]
        = this->expect_the_same_light_under({{{-3, 0.5, -3}, {-3, 0.5, 3}, {3, 0.5, 3}, {3, 0.5, -3}}, 1}, s, 0.01);
    for (std::size_t i = 0; i < direct.pixels.size(); ++i)
        EXPECT_NEAR(through_pane.pixels[i].x, direct.pixels[i].x, 0.4f * direct.pixels[i].x) << i;
    const dvec3 way = glm::normalize(s.point_lights[0].position), normal = glm::normalize(dvec3(1.5, 2, 0.5));
    const double distance2 = glm::dot(s.point_lights[0].position, s.point_lights[0].position);
    EXPECT_NEAR(direct.pixels[8 * 16 + 8].x, 0.8 / M_PI * 10 / (4 * M_PI * distance2) * glm::dot(way, normal), 0.05);
}

/// A closed room whose walls are one mesh that emits 1, 2 and 4 W/(m^2 sr), by triangles of many sizes.
TYPED_TEST_P(mesh_scenes, a_ball_amid_a_mesh_that_emits_has_the_known_radiance)
{
    auto s = ball_amid_lamps({"white", material_kind::lambertian, {0.8, 0.5, 0.3}});
    s.rectangle_lights.clear();
    auto walls = bumpy_ball(6, 1, 0);
    for (auto& t : walls.triangles)
        std::swap(t.y, t.z); // outside is inside
    mesh_light l{"walls", {"", std::make_shared<const mesh>(walls), glm::dmat3(1.5), dvec3(0), 0}, dvec3(1)};
    l.power = M_PI * area_of(l.surface) * dvec3(1, 2, 4);
    s.mesh_lights = {l};
    s.polygons[0] = {{{-0.1, -0.1, 1.2}, {0.1, -0.1, 1.2}, {0, 0.1, 1.2}}, 0}; // behind the ball
    s.render.view.light_samples = 64;
    const auto drawn = this->picture(s);
    const auto cosines = cosines_at_the_ball(s);
    dvec3 seen(0);
    double pixels = 0;
    for (std::size_t i = 0; i < cosines.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double radiance = dvec3(1, 2, 4)[c];
            if (cosines[i] < 0) {
                ASSERT_NEAR(drawn.pixels[i][c], radiance, 1e-5 * radiance) << i;
            } else if (cosines[i] <= 1) {
                seen[c] += static_cast<double>(drawn.pixels[i][c]) / radiance;
                pixels += c == 0 ? 1 : 0;
            }
        }
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c] / pixels, s.materials[1].reflectance[c], 0.005 * s.materials[1].reflectance[c]) << c;
}

/// As photons_and_shadow_rays_light_by_the_same_normals, under a lamp of triangles.
TYPED_TEST_P(mesh_scenes, photons_and_shadow_rays_of_a_mesh_that_emits_agree)
{
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.8)}, {"pane", material_kind::glass, dvec3(1), 1}};
    s.polygons = {{{{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, 0}};
    const mesh lamp{
        {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {-0.2f, -0.1f, 0}, {0, -0.3f, 0.5f}}, {{0, 1, 2}, {0, 2, 3}, {3, 4, 2}}};
    s.mesh_lights
        = {{"lamp", {"", std::make_shared<const mesh>(lamp), glm::dmat3(0.5), {0.2, 1.2, 0.1}, 0}, dvec3(10)}};
    s.camera = {{0.1, 2, 0}, {0, 0, 0}, {0, 0, 1}, 40};
    s.render = {.map = {.photons = 60000, .grid = {60, 1, 60}},
        .estimate = {.k = 200, .max_radius = 0.2},
        .view = {.light_samples = 64},
        .output = {.width = 16, .height = 16}};
    this->expect_the_same_light_under({{{-4, 0.3, -4}, {-4, 0.3, 4}, {4, 0.3, 4}, {4, 0.3, -4}}, 1}, s, 0.015);
}

TYPED_TEST_P(mesh_scenes, a_smooth_glass_ball_focuses_the_power_that_optics_predicts)
{
    const ball_over_floor ball;
    auto s = ball.as_scene();
    s.spheres.clear();
    s.meshes = {{"", std::make_shared<const mesh>(smooth_ball(rings_of(20'000))), glm::dmat3(ball.radius),
        {0, ball.height, 0}, 1}};
    this->expect_focus(s, ball);
}

REGISTER_TYPED_TEST_SUITE_P(mesh_scenes, draw_what_their_polygons_draw, equal_the_serial_backends,
    rooms_of_meshes_equal_the_serial_backends, no_photon_leaves_a_closed_room, no_photon_leaves_a_thin_box,
    rays_that_leave_a_flat_mesh_do_not_hit_it, photons_of_a_flat_mesh_do_not_hit_it,
    photons_and_shadow_rays_light_by_the_same_normals, smooth_glass_and_mirrors_amid_lamps_cannot_be_seen,
    a_white_body_in_glass_amid_lamps_cannot_be_seen, a_smooth_glass_ball_focuses_the_power_that_optics_predicts,
    a_ball_amid_a_mesh_that_emits_has_the_known_radiance, photons_and_shadow_rays_of_a_mesh_that_emits_agree);

} // namespace photongrid::testing
