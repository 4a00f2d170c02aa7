// The contents of a scene file.
#pragma once

#include "scene_texts.hpp"

namespace photongrid {
namespace {

    TEST(scene_file, takes_a_grid_that_fits_the_photons)
    {
        auto lines = good;
        auto& render = lines[12];
        render.replace(render.find("[4, 1, 4]"), 9, "\"auto\"");
        EXPECT_EQ(parse_scene("s.json", text(lines)).render.map.grid, glm::uvec3(0));
    }

    TEST(scene_file, without_a_grid_gets_the_map_that_suits)
    {
        auto lines = good;
        auto& render = lines[12];
        const std::string grid = "\"grid\": [4, 1, 4], ";
        EXPECT_EQ(parse_scene("s.json", text(lines)).render.map.builder, map_builder::sort);
        render.erase(render.find(grid), grid.size());
        const auto map = parse_scene("s.json", text(lines)).render.map;
        EXPECT_EQ(map.builder, map_builder::automatic);
        EXPECT_EQ(map.grid, glm::uvec3(0));
        render.replace(render.find("\"k\""), 3, "\"map\": \"route\", \"k\"");
        EXPECT_EQ(parse_scene("s.json", text(lines)).render.map.builder, map_builder::route);
        EXPECT_EQ(parse_scene("s.json", text(lines)).render.map.grid, glm::uvec3(0));
    }

    TEST(scene_file, reads_every_part)
    {
        const auto s = parse_scene("s.json", text(good));
        EXPECT_EQ(s.name, "small");
        ASSERT_EQ(s.materials.size(), 2u);
        EXPECT_EQ(s.materials[0].reflectance, dvec3(0.7, 0.6, 0.5));
        EXPECT_EQ(s.materials[1].kind, material_kind::glass);
        EXPECT_EQ(s.materials[1].reflectance, dvec3(1));
        ASSERT_EQ(s.spheres.size(), 1u);
        EXPECT_EQ(s.spheres[0].material, 1u);
        EXPECT_EQ(s.spheres[0].radius, 0.5);
        ASSERT_EQ(s.polygons.size(), 1u);
        EXPECT_EQ(s.polygons[0].vertices[2], dvec3(1, 0, 1));
        ASSERT_EQ(s.point_lights.size(), 1u);
        EXPECT_EQ(s.point_lights[0].power, dvec3(10, 20, 30));
        EXPECT_EQ(s.point_lights[0].name, "lamp");
        EXPECT_EQ(s.camera.up, dvec3(0, 1, 0));
        EXPECT_EQ(s.render.output.width, 64u);
        EXPECT_EQ(s.render.output.height, 48u);
        EXPECT_EQ(s.render.map.photons, 1000u);
        EXPECT_EQ(s.render.map.grid, glm::uvec3(4, 1, 4));
        EXPECT_EQ(s.render.estimate.max_radius, 0.25);
        EXPECT_NO_THROW(check(s));
    }

    TEST(scene_file, reads_every_shape_material_and_light)
    {
        auto lines = good;
        lines[5]
            = R"("white": {"type": "lambertian", "reflectance": 0.5, "comment": "x"}, "m": {"type": "mirror"}, "gold": {"type": "metal", "reflectance": [1, 0.8, 0.3]},)";
        lines[8]
            = R"({"type": "cylinder", "base": [0,0,0], "top": [0,1,0], "radius": 1, "material": "m"}, {"type": "cone", "base": [0,0,0], "apex": [0,2,0], "radius": 1, "material": "gold"},
          {"type": "paraboloid", "vertex": [0,0,0], "rim": [0,1,0], "radius": 2, "material": "white"}, {"type": "disk", "center": [0,0,0], "normal": [0,0,2], "radius": 1, "material": "white"},
          {"type": "triangle", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "material": "white"},)";
        lines[11] = R"({"type": "rectangle", "corner": [0,2,0], "edge_u": [1,0,0], "edge_v": [0,0,1], "power": 5}],)";
        const auto s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.cylinders.size(), 1u);
        EXPECT_EQ(s.cones.size(), 1u);
        EXPECT_EQ(s.cones[0].apex, dvec3(0, 2, 0));
        EXPECT_EQ(s.paraboloids.size(), 1u);
        EXPECT_EQ(s.disks.size(), 1u);
        EXPECT_EQ(s.polygons.size(), 2u);
        ASSERT_EQ(s.rectangle_lights.size(), 1u);
        EXPECT_EQ(s.rectangle_lights[0].power, dvec3(5));
        EXPECT_EQ(s.rectangle_lights[0].name, "lights[0]");
        EXPECT_EQ(s.materials[2].kind, material_kind::metal);
        EXPECT_EQ(s.materials[0].reflectance, dvec3(0.5));
    }

    TEST(scene_file, converts_units)
    {
        auto lines = good;
        lines[2] = R"( "units": {"length": "cm", "power": "mW"},)";
        auto s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.spheres[0].radius, 0.005);
        EXPECT_EQ(s.camera.position, dvec3(0, 0.01, 0.05));
        EXPECT_EQ(s.point_lights[0].power, dvec3(0.01, 0.02, 0.03));
        EXPECT_EQ(s.render.estimate.max_radius, 0.0025);
        lines[2] = R"( "units": {"length": "mm", "power": "kW"},)";
        s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.polygons[0].vertices[2], dvec3(0.001, 0, 0.001));
        EXPECT_EQ(s.point_lights[0].power, dvec3(10'000, 20'000, 30'000));
    }

    TEST(scene_file, leaves_settings_without_a_number_to_the_renderer)
    {
        const auto with = [](const std::string& render) { return parse_scene("s.json", good_with(render)).render; };
        for (const auto* none : {"}", R"( "render": {}})", R"( "render": {"photons": "auto", "max_radius": "auto"}})"})
            EXPECT_EQ(with(none), automatic_settings()) << none;
        auto expected = automatic_settings();
        expected.estimate.k = 30;
        expected.output.passes = 4;
        EXPECT_EQ(with(R"( "render": {"k": 30, "passes": 4}})"), expected);
        // Where photons are named, what is not has its old default.
        const auto old = with(R"( "render": {"photons": 1000, "k": 20, "max_radius": 0.25, "size": [9, 7]}})");
        EXPECT_FALSE(is_automatic(old));
        EXPECT_EQ(old.view, view_settings{});
        EXPECT_EQ(old.output.passes, 1u);
        EXPECT_EQ(old.map.caustic_photons, 0u);
        const auto partly = with(R"( "render": {"photons": 1000, "spp": "auto"}})");
        EXPECT_EQ(partly.view.spp, automatic_number);
        EXPECT_EQ(partly.estimate.k, automatic_number);
        EXPECT_EQ(partly.estimate.max_radius, automatic_length);
        EXPECT_EQ(partly.view.light_samples, 8u);
        const auto said = refusal(good_with(R"( "render": {"k": "auto", "photons": "many"}})"));
        EXPECT_NE(said.find("expected a whole number from 1 to 134217728, or \"auto\""), std::string::npos) << said;
    }

    TEST(scene_file, reads_what_kind_of_estimate_is_wanted)
    {
        const auto with = [](const std::string& more) {
            auto lines = good;
            lines[12].insert(lines[12].find(", \"k\""), more);
            return parse_scene("s.json", text(lines)).render;
        };
        const auto plain = with("");
        EXPECT_EQ(plain.estimate.search, search_kind::exact_k);
        EXPECT_EQ(plain.estimate.filter, filter_kind::silverman);
        EXPECT_EQ(plain.estimate.bias, bias_kind::unbiased);
        EXPECT_EQ(plain.estimate.edges, edge_correction::probes);
        EXPECT_TRUE(plain.estimate.leaks.side);
        EXPECT_EQ(plain.estimate.leaks.min_cosine, 0.5f);
        EXPECT_EQ(plain.estimate.leaks.flattening, 1);
        EXPECT_EQ(with(R"(, "search": "at_least_k")").estimate.search, search_kind::at_least_k);
        EXPECT_EQ(with(R"(, "search": "exact_k")").estimate.search, search_kind::exact_k);
        EXPECT_EQ(with(R"(, "search": "fixed_radius")").estimate.search, search_kind::fixed_radius);
        EXPECT_EQ(with(R"(, "filter": "constant")").estimate.filter, filter_kind::constant);
        EXPECT_EQ(with(R"(, "filter": "cone")").estimate.filter, filter_kind::cone);
        EXPECT_EQ(with(R"(, "filter": "epanechnikov")").estimate.filter, filter_kind::epanechnikov);
        EXPECT_EQ(with(R"(, "filter": "silverman")").estimate.filter, filter_kind::silverman);
        EXPECT_EQ(with(R"(, "bias": "paper")").estimate.bias, bias_kind::paper);
        EXPECT_EQ(with(R"(, "bias": "unbiased")").estimate.bias, bias_kind::unbiased);
        EXPECT_EQ(with(R"(, "edge_correction": "none")").estimate.edges, edge_correction::none);
        EXPECT_EQ(with(R"(, "edge_correction": "polygons", "leaks": {"min_cosine": 0.5})").estimate.edges,
            edge_correction::polygons);
        EXPECT_EQ(with(R"(, "edge_correction": "probes", "leaks": {})").estimate.edges, edge_correction::probes);
        EXPECT_FALSE(with(R"(, "leaks": {})").estimate.leaks.needs_point_normals());
        EXPECT_FALSE(with(R"(, "leaks": {"comment": 1, "side": false})").estimate.leaks.needs_point_normals());
        const auto all = with(R"(, "leaks": {"side": true, "min_cosine": 0.25, "flattening": 4})").estimate.leaks;
        EXPECT_TRUE(all.side);
        EXPECT_EQ(all.min_cosine, 0.25f);
        EXPECT_EQ(all.flattening, 4);
        EXPECT_FALSE(with(R"(, "leaks": {"min_cosine": -0.5})").estimate.leaks.side) << "what is not named is off";
        EXPECT_EQ(with(R"(, "leaks": {"min_cosine": 1, "flattening": 1e6})").estimate.leaks.flattening, 1e6f);
    }

    TEST(scene_file, rejects_unknown_kinds_of_estimates)
    {
        const auto said = [](const std::string& more) { return refusal(13, "\"k\": 20", more + ", \"k\": 20"); };
        expect_refusal(said(R"("search": "exact")"), "13:58",
            {"found the text \"exact\"", R"(expected "at_least_k", "exact_k" or "fixed_radius")"});
        expect_refusal(said(R"("search": 1)"), "13:58", {"found the number 1", "\"fixed_radius\""});
        expect_refusal(said(R"("filter": "gauss")"), "13:58",
            {"found the text \"gauss\"", R"(expected "constant", "cone", "epanechnikov" or "silverman")"});
        expect_refusal(said(R"("bias": true)"), "13:56", {"found true", R"(expected "paper" or "unbiased")"});
        expect_refusal(said(R"("edge_correction": "disks")"), "13:67",
            {"found the text \"disks\"", R"(expected "none", "polygons" or "probes")"});
        expect_refusal(said(R"("edge_correction": "polygons", "leaks": {})"), "13:67",
            {"edge_correction: photons of adjoining walls would count", "needs the leak policy min_cosine above 0"});
        expect_refusal(said(R"("edge_correction": "polygons", "leaks": {"side": true, "min_cosine": 0})"), "13:67",
            {"needs the leak policy min_cosine"});
        expect_refusal(said(R"("leaks": "none")"), "13:57",
            {"found the text \"none\"", R"("side", "min_cosine" or "flattening"; {} for no policy)"});
        expect_refusal(said(R"("leaks": ["side"])"), "13:57", {"found an array of 1", "expected an object"});
        expect_refusal(said(R"("leaks": {"min_cosin": 0.5})"), "13:58",
            {"unknown key \"min_cosin\" in \"leaks\"", "expected \"min_cosine\"?"});
        expect_refusal(said(R"("leaks": {"side": 1})"), "13:66", {"found the number 1", "expected true or false"});
        expect_refusal(said(R"("leaks": {"min_cosine": 1.01})"), "13:72",
            {"found the number 1.01", "expected a number from -1 to 1"});
        expect_refusal(said(R"("leaks": {"min_cosine": true})"), "13:72", {"found true"});
        expect_refusal(said(R"("leaks": {"flattening": 0.5})"), "13:72",
            {"found the number 0.5", "expected a number from 1 to 1000000"});
        expect_refusal(said(R"("leaks": {"flattening": 1000001})"), "13:72", {"found the number 1000001"});
        expect_refusal(
            said(R"("serach": "exact_k")"), "13:48", {"unknown key \"serach\" in \"render\"", "expected \"search\"?"});
        // What a picture shows is not the scene's.
        expect_refusal(said(R"("only": "caustic")"), "13:48", {"unknown key \"only\""});
        expect_refusal(said(R"("aov": true)"), "13:48", {"unknown key \"aov\""});
    }

} // namespace
} // namespace photongrid
