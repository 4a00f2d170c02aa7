// Limits that no number of a scene shows: the records of its buffer, the loops of devices that end long ones, and the
// shadow rays of the paper's settings.
#pragma once

#include "test_scenes.hpp"

#include <photongrid/trace/device_scene.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace photongrid::testing {

/// A device whose driver ends loops after 65,535 iterations.
inline capabilities limited_device()
{
    capabilities caps;
    caps.backend = "limited";
    caps.loop_limit = 65535;
    return caps;
}

/// A lamp over `count` regular polygons.
inline scene polygons_under_a_lamp(int count, int vertices)
{
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}};
    s.point_lights = {{"bulb", {0, 3, 0}, dvec3(1)}};
    for (int i = 0; i < count; ++i) {
        polygon p{{}, 0};
        for (int v = 0; v < vertices; ++v) {
            const double angle = 2 * M_PI * v / vertices;
            p.vertices.emplace_back(std::cos(angle), 0.01 * i, -std::sin(angle));
        }
        s.polygons.push_back(p);
    }
    return s;
}

// trace/intersect/polygon.glsl asks each edge of a polygon, and twice for a ray in its plane.
TEST(loop_limits, every_edge_of_a_polygon_counts_twice)
{
    const auto limited = limited_device();
    for (const int vertices : {20, 1024}) {
        const auto many = lay_out(polygons_under_a_lamp(70000 / vertices, vertices));
        EXPECT_THROW(detail::check_loops(many, limited), std::invalid_argument) << vertices << " vertices";
        EXPECT_NO_THROW(detail::check_loops(many, capabilities{})) << "a device without a limit";
        const auto grazed = lay_out(polygons_under_a_lamp(34000 / vertices, vertices));
        EXPECT_THROW(detail::check_loops(grazed, limited), std::invalid_argument) << vertices << " vertices";
        const auto few = lay_out(polygons_under_a_lamp(15000 / vertices, vertices));
        EXPECT_NO_THROW(detail::check_loops(few, limited)) << vertices << " vertices";
    }
}

TEST(loop_limits, lamps_multiply_and_never_wrap)
{
    auto s = polygons_under_a_lamp(14, 1024);
    EXPECT_NO_THROW(detail::check_loops(lay_out(s), limited_device()));
    s.point_lights.assign(4, s.point_lights[0]);
    EXPECT_THROW(detail::check_loops(lay_out(s), limited_device()), std::invalid_argument);
    s.point_lights.resize(1);
    s.rectangle_lights.assign(6000, {"lamp", {0, 2, 0}, {1, 0, 0}, {0, 0, 1}, dvec3(1)}); // their surfaces are polygons
    EXPECT_THROW(detail::check_loops(lay_out(s), limited_device()), std::invalid_argument);
    // 2^28 steps for each of 16 lights: 0 in 32 bits.
    scene_layout wide;
    wide.records.assign(kernels::SCENE_TABLES, glm::vec4(0));
    wide.records[kernels::LIGHT_TABLE] = {0, 16, 6, 0};
    wide.steps_per_ray = 1u << 28;
    EXPECT_THROW(detail::check_loops(wide, limited_device()), std::invalid_argument);
    wide.records[kernels::LIGHT_TABLE].y = 65536; // none of them in a tree
    wide.steps_per_ray = 1;
    EXPECT_THROW(detail::check_loops(wide, limited_device()), std::invalid_argument);
}

// Samples choose one of many lamps, so that no pass asks all shapes for all lamps.
TEST(loop_limits, many_lamps_do_not_multiply)
{
    auto s = polygons_under_a_lamp(1, 20);
    s.rectangle_lights.assign(500, {"lamp", {0, 2, 0}, {1, 0, 0}, {0, 0, 1}, dvec3(1)});
    EXPECT_NO_THROW(detail::check_loops(lay_out(s), limited_device()));
    s.polygons = polygons_under_a_lamp(32, 1024).polygons;
    EXPECT_THROW(detail::check_loops(lay_out(s), limited_device()), std::invalid_argument)
        << "each ray asks all shapes";
}

/// As shapes that single precision cannot resolve so far from others as small. A single one is where coordinates are
/// finest, however small it is.
TEST(meshes, too_small_for_their_place_are_refused)
{
    for (const double size : {1e-4, 1e-6}) { // beside a floor of 2 m
        auto s = polygons_under_a_lamp(1, 20);
        s.meshes = {mesh_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0})};
        s.meshes[0].linear = glm::dmat3(size);
        s.meshes[0].offset = {0.3, 0.2, 0.1};
        EXPECT_NO_THROW(check(s));
        auto two = s, lamp = s;
        two.meshes.push_back(s.meshes[0]);
        two.meshes[1].offset = {0, 3, 0};
        lamp.mesh_lights = {{"ember", two.meshes[1], dvec3(1)}};
        for (const auto& [with, name] : {std::pair{two, "meshes[1]"}, {lamp, "mesh_lights[0]"}})
            try {
                const auto layout = lay_out(with);
                EXPECT_GT(size, 1e-5);
                EXPECT_EQ(layout.meshes.faces.size(), 2u);
            } catch (const std::invalid_argument& e) {
                EXPECT_LT(size, 1e-5);
                EXPECT_EQ(std::string(e.what()).find(name), 0u) << e.what();
                EXPECT_NE(std::string(e.what()).find("steps of 2.38418579e-07 m 2.8"), std::string::npos) << e.what();
            }
    }
}

TEST(records, are_as_many_as_single_precision_can_number)
{
    // The largest integer to which all smaller ones are floats.
    EXPECT_NO_THROW(detail::require_numbered(1u << 24));
    EXPECT_NE(static_cast<std::uint32_t>(static_cast<float>((1u << 24) + 1)), (1u << 24) + 1);
    EXPECT_THROW(detail::require_numbered((1u << 24) + 1), std::invalid_argument);
}

TEST(paper_settings, one_eye_ray_takes_all_shadow_rays_of_a_pixel)
{
    const auto paper = as_paper(render_settings{});
    EXPECT_EQ(paper.view.spp, 1u);
    EXPECT_EQ(paper.view.light_samples, 32u) << "Table 1, the Cornell box";
    render_settings s;
    s.view.spp = 3;
    s.view.light_samples = 5;
    EXPECT_EQ(as_paper(s).view.light_samples, 15u);
    s.view.spp = s.view.light_samples = 65536; // each the most there may be; their product is 0 in 32 bits
    EXPECT_EQ(as_paper(s).view.light_samples, 65536u);
    EXPECT_NO_THROW(check(as_paper(s)));
    EXPECT_EQ(as_paper(as_paper(s)), as_paper(s));
}

TEST(exact_settings, have_what_makes_a_picture_consistent)
{
    render_settings s;
    s.map.builder = map_builder::route;
    s.estimate.k = 200;
    const auto exact = as_exact(s);
    EXPECT_EQ(exact.estimate.radii, radius_kind::shrinking);
    EXPECT_EQ(exact.estimate.indirect, indirect_kind::paths);
    EXPECT_EQ(exact.estimate.k, 50u);
    EXPECT_EQ(exact.map.builder, map_builder::automatic);
    EXPECT_EQ(exact.output.passes, output_settings::most_passes);
    EXPECT_EQ(as_exact(exact), exact);
    s.estimate.k = 7;
    s.output.passes = 3;
    s.map.builder = map_builder::blocks;
    EXPECT_EQ(as_exact(s).estimate.k, 7u);
    EXPECT_EQ(as_exact(s).output.passes, 3u);
    EXPECT_EQ(as_exact(s).map.builder, map_builder::blocks);
    s.output.passes = 1;
    s.output.until_error = 0.1;
    EXPECT_EQ(as_exact(s).output.passes, 1u) << "a stop rule ends it";
    EXPECT_EQ(as_exact(s).output.passes_at_most(), output_settings::most_passes);
    EXPECT_EQ(as_paper(exact).estimate.indirect, indirect_kind::map);
}

} // namespace photongrid::testing
