// Light of lamps without size by smooth glass on rough surfaces, which only photons find: see render/rough_photons.hpp.
#pragma once

#include "pictures.hpp"

namespace photongrid::testing {

/// A dark plate under the sun, behind a pane of glass or bare.
inline scene plate_under_the_sun(const material& plate, bool behind_a_pane)
{
    scene s;
    s.name = "plate";
    s.materials
        = {plate, {"pane", material_kind::glass, dvec3(1), 1.5}, {"matte", material_kind::lambertian, dvec3(0)}};
    s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 0}};
    if (behind_a_pane)
        s.boxes = {{{-2.5, 0.9, -2.5}, {5, 0, 0}, {0, 0, 5}, {0, 0.02, 0}, 1}};
    s.directional_lights = {{"the sun", {0, -0.8, -0.6}, dvec3(3)}};
    s.camera = {{0, 0.7, -1.2}, {0, 0, 0}, {0, 1, 0}, 20};
    s.render.map.photons = 160000;
    s.render.map.photon_depth = 8;
    s.render.estimate.k = 50;
    s.render.output.width = 8;
    s.render.output.height = 6;
    s.render.output.passes = 4;
    s.render.view.spp = 4;
    s.render.view.depth = 8;
    return s;
}

inline material rough_material(material_kind kind, double roughness, double reflectance)
{
    material m{"plate", kind, dvec3(reflectance)};
    m.roughness = roughness;
    return m;
}

inline double red_of(const image& im) { return mean_of(im).x; }

/// A pane lets (1 - r) / (1 + r) of the sun's light pass, with r by Fresnel, at two faces and by all reflections
/// between.
TYPED_TEST_P(pictures, rough_surfaces_behind_a_pane_have_the_known_light)
{
    const double cosine = 0.8, sine = 0.6 / 1.5, inside = std::sqrt(1 - sine * sine);
    const double s = (cosine - 1.5 * inside) / (cosine + 1.5 * inside),
                 p = (inside - 1.5 * cosine) / (inside + 1.5 * cosine), r = (s * s + p * p) / 2;
    // Dark, so that what the plate sends to the pane and back is little.
    for (const auto& plate : {rough_material(material_kind::metal, 0.5, 0.05),
             rough_material(material_kind::metal, 0.9, 0.05), rough_material(material_kind::plastic, 0.6, 0.0)}) {
        const auto bare = plate_under_the_sun(plate, false), behind = plate_under_the_sun(plate, true);
        const double passes = red_of(this->picture(behind)) / red_of(this->picture(bare));
        EXPECT_NEAR(passes, (1 - r) / (1 + r), 0.04) << plate.roughness; // of noise and of what goes to and fro
    }
}

/// Where the plate shows light by a part of a mixture alone, the other part takes nothing of its photons.
TYPED_TEST_P(pictures, parts_of_mixtures_show_their_share_of_light_behind_a_pane)
{
    const auto plate = rough_material(material_kind::metal, 0.5, 0.05);
    const auto whole = plate_under_the_sun(plate, true);
    for (const auto kind : {material_kind::lambertian, material_kind::mirror}) {
        auto s = whole;
        s.materials[0].kind = material_kind::mixture;
        s.materials[0].parts = {3, 4};
        s.materials[0].share = 0.7;
        s.materials.push_back({"other", kind, dvec3(0)});
        s.materials.push_back(plate);
        EXPECT_NEAR(red_of(this->picture(s)) / red_of(this->picture(whole)), 0.7, 0.04) << static_cast<int>(kind);
    }
}

TYPED_TEST_P(pictures, photons_on_rough_surfaces_equal_serials)
{
    auto& b = this->b();
    if (!b.caps().exact_division || !b.caps().exact_sqrt)
        GTEST_SKIP() << "this device rounds division or square root loosely";
    serial_backend serial;
    auto s = plate_under_the_sun(rough_material(material_kind::glass, 0.4, 0.9), true);
    s.materials[2].reflectance = dvec3(0.5);
    s.spheres = {{{0, -0.5, 0}, 0.3, 2}}; // lit through the plate
    s.render.map.photons = 8000;
    s.render.output.passes = 2;
    for (const auto only : {light_part::all, light_part::caustic}) {
        s.render.output.only = only;
        const auto mine = this->picture(s), theirs = render(serial, s, s.render).picture;
        EXPECT_LE(relative_mse(mine, theirs), 1e-9) << static_cast<int>(only);
        EXPECT_GT(red_of(mine), 0.01);
    }
}

/// Rays find what a lamp sends through the pane, so that no photon may bring it once more.
TYPED_TEST_P(pictures, light_of_lamps_with_a_size_behind_a_pane_is_not_counted_twice)
{
    auto sun = plate_under_the_sun(rough_material(material_kind::metal, 0.7, 0.05), true);
    sun.render.view.spp = 64;
    auto lamp = sun, both = sun;
    lamp.directional_lights.clear();
    lamp.rectangle_lights = both.rectangle_lights
        = {{"lamp", {-2, 2, -4}, {4, 0, 0}, {0, 0, 4}, dvec3(120)}}; // faces down, beside the sun
    const double of_lamp = red_of(this->picture(lamp)), of_sun = red_of(this->picture(sun));
    EXPECT_GT(of_lamp, 0.2 * of_sun);
    EXPECT_NEAR(red_of(this->picture(both)), of_lamp + of_sun, 0.05 * of_lamp + 0.02 * of_sun);
}

/// A plate of metal is seen without any matte surface, in every way of drawing.
TYPED_TEST_P(pictures, scenes_without_matte_surfaces_are_drawn)
{
    auto s = plate_under_the_sun(rough_material(material_kind::metal, 0.5, 0.9), false);
    s.render.map.photons = 4000;
    s.render.output.passes = 2;
    const double plain = red_of(this->picture(s));
    EXPECT_GT(plain, 0.1);
    for (const auto indirect : {indirect_kind::map, indirect_kind::gather, indirect_kind::paths})
        for (const std::uint32_t caustic_photons : {0u, 1000u}) {
            s.render.estimate.indirect = indirect;
            s.render.map.caustic_photons = caustic_photons;
            render_stats stats;
            EXPECT_NEAR(red_of(this->picture(s, s.render, &stats)), plain, 1e-6) << static_cast<int>(indirect);
            EXPECT_EQ(stats.photons.emitted, 0u);
        }
}

TYPED_TEST_P(pictures, light_on_rough_surfaces_does_not_depend_on_how_passes_are_run)
{
    auto s = plate_under_the_sun(rough_material(material_kind::metal, 0.5, 0.9), true);
    s.render.map.photons = 16000;
    s.render.output.passes = 3;
    (void)this->expect_the_same_however_it_is_run(s, s.render, {.target_ms = 1});
    s.render.estimate.radii = radius_kind::per_pass;
    (void)this->expect_the_same_however_it_is_run(s, s.render);
}

/// Only scenes that need them trace them.
TYPED_TEST_P(pictures, photons_are_on_rough_surfaces_only_where_rays_find_no_light)
{
    auto& b = this->b();
    const auto of = [&](scene s) {
        s.render.map.photons = 2000;
        return build_map(b, s, s.render).on_rough.has_value();
    };
    const auto needs = plate_under_the_sun(rough_material(material_kind::metal, 0.5, 0.9), true);
    EXPECT_TRUE(of(needs));
    auto other = needs;
    other.render.output.only = light_part::direct;
    EXPECT_FALSE(of(other));
    EXPECT_FALSE(of(plate_under_the_sun(needs.materials[0], false))) << "nothing is smooth";
    other = needs;
    other.materials[0].roughness = 0;
    EXPECT_FALSE(of(other)) << "nothing is rough";
    other = needs;
    other.directional_lights.clear();
    other.rectangle_lights = {{"lamp", {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, dvec3(1)}};
    EXPECT_FALSE(of(other)) << "rays hit the lamp";
}

} // namespace photongrid::testing
