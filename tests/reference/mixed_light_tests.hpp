// Scenes with all kinds of lights and with textures, by photons and by eye paths.
#pragma once

#include "../trace/media_scenes.hpp"
#include "../trace/mixture_scenes.hpp"
#include "../trace/texture_scenes.hpp"
#include "eye_path_sums.hpp"

namespace photongrid::testing {
namespace {

    TEST(validation, photons_of_all_kinds_of_lights_equal_eye_paths)
    {
        auto s = all_lights();
        s.name = "all kinds of lights";
        s.render.view.light_samples = 16;
        s.render.view.spp = 16;
        expect_photons_equal_eye_paths(s);
    }

    // Colours that bleed, by way of the codes in which photons carry them.
    TEST(validation, photons_off_textures_equal_eye_paths)
    {
        auto s = textured_cornell();
        s.name = "textures";
        s.render.view.light_samples = 16;
        s.render.view.spp = 16;
        expect_photons_equal_eye_paths(s);
    }

    /// A floor under lights without size, and one under lights with a size, with a tilted square of material 2 above it
    /// and a ball of material 3.
    std::vector<scene> square_and_ball_under_all_lights(const material& square, const material& ball)
    {
        const auto floors = floors_under_each_light();
        std::vector<scene> scenes(2, bare_floor());
        scenes[0].name = square.name + ", lights without size";
        scenes[0].spot_lights = floors[0].spot_lights;
        scenes[0].directional_lights = floors[2].directional_lights;
        scenes[0].point_lights = {{"bulb", {-0.8, 0.9, -0.4}, dvec3(6, 12, 9)}};
        scenes[1].name = square.name + ", lights with a size";
        scenes[1].sphere_lights = floors[1].sphere_lights;
        scenes[1].environment_lights = floors[3].environment_lights;
        scenes[1].environment_lights[0].radiance = dvec3(0.1);
        scenes[1].rectangle_lights = {{"lamp", {-0.5, 1, 0.2}, {0.6, 0, 0}, {0, 0.1, 0.5}, dvec3(10, 5, 2)}};
        const auto pyramid = std::make_shared<const mesh>(
            mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
        scenes[1].mesh_lights = {{"ember", {"", pyramid, glm::dmat3(0.4), {0.5, 0.8, -0.5}, 0}, dvec3(10, 5, 2)}};
        for (auto& s : scenes) {
            s.materials.push_back(square);
            s.materials.push_back(ball);
            s.polygons.push_back({{{-1.2, 0.05, -1}, {-1.2, 0.25, 1}, {0, 0.25, 1}, {0, 0.05, -1}}, 2});
            s.spheres = {{{0.6, 0.35, 0}, 0.35, 3}};
            s.camera = {{0, 2, -2.5}, {0, 0.2, 0}, {0, 1, 0}, 40};
            s.render.view.light_samples = 4;
            s.render.view.spp = 48;
        }
        return scenes;
    }

    // Samples of lights and rays that hit them by chance, with weights that add up to 1. Facets send a third of the
    // light to others.
    TEST(validation, rough_metal_and_glass_under_all_kinds_of_lights_equal_eye_paths)
    {
        for (const auto& s :
            square_and_ball_under_all_lights({"metal", material_kind::metal, {0.95, 0.8, 0.6}, 1.5, 0.75},
                {"frosted", material_kind::glass, dvec3(0.95), 1.5, 0.8}))
            expect_photons_equal_eye_paths(s);
    }

    // What a frosted pane reflects, and what passes it.
    TEST(validation, frosted_panes_under_all_kinds_of_lights_equal_eye_paths)
    {
        for (const auto& s :
            square_and_ball_under_all_lights({"frosted pane", material_kind::thin_glass, {0.9, 0.8, 0.7}, 1.5, 0.45},
                {"frosted", material_kind::thin_glass, dvec3(0.95), 1.5, 0.8}))
            expect_photons_equal_eye_paths(s);
    }

    // Water and ice in glass: by the sums of media that photons, eye rays and the reference keep.
    TEST(validation, glass_in_glass_equals_eye_paths)
    {
        auto s = iced_water();
        s.render.view.light_samples = 16;
        s.render.view.spp = 64;
        expect_photons_equal_eye_paths(s);
        s.name = "iced water, frosted";
        s.materials[3].roughness = 0.5;
        expect_photons_equal_eye_paths(s);
    }

    // Photons straight from the lamp, and those that other surfaces have sent, through panes alone and in mixtures.
    TEST(validation, photons_through_panes_equal_eye_paths)
    {
        auto s = with_meshes(small_cornell());
        s.name = "panes";
        s.spheres.clear();
        const auto pane = static_cast<std::uint32_t>(s.materials.size());
        s.materials.push_back({"pane", material_kind::thin_glass, {0.9, 0.7, 0.5}, 1.8});
        s.materials.push_back(mixture_of(0, pane, 0.7, {}));
        s.meshes.push_back(
            {"", std::make_shared<const mesh>(textured_rectangle({0.1f, 0.7f, 0.1f}, {0.8f, 0, 0}, {0, 0, 0.8f})),
                glm::dmat3(1), dvec3(0), pane});
        s.meshes.push_back(
            {"", std::make_shared<const mesh>(textured_rectangle({0.2f, 0.1f, 0.4f}, {0.5f, 0, 0}, {0, 0.5f, 0.2f})),
                glm::dmat3(1), dvec3(0), pane + 1});
        s.render.view.light_samples = 16;
        s.render.view.spp = 64;
        expect_photons_equal_eye_paths(s);
    }

    // Photons that a coat reflects, and photons that it lets pass, which the map holds.
    TEST(validation, plastic_under_all_kinds_of_lights_equals_eye_paths)
    {
        for (auto& s : square_and_ball_under_all_lights({"varnish", material_kind::plastic, {0.9, 0.6, 0.3}, 2},
                 {"plastic", material_kind::plastic, {0.3, 0.9, 0.5}, 1.5, 0.6})) {
            s.materials[0] = {"table", material_kind::plastic, dvec3(0.8), 1.5, 0.3};
            expect_photons_equal_eye_paths(s);
        }
    }

    // Photons that one part of a mixture stores and the other reflects, also about normals of vertices; and light that
    // passes what is clear in part: straight from the lamp, off other surfaces, and from rough ones to the lamp.
    TEST(validation, photons_of_mixtures_and_clear_surfaces_equal_eye_paths)
    {
        auto s = mixed_cornell();
        s.render.view.light_samples = 16;
        s.render.view.spp = 64;
        expect_photons_equal_eye_paths(s);
    }

} // namespace
} // namespace photongrid::testing
