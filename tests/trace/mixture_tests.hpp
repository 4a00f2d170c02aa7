// Mixtures of materials, surfaces that are clear in part, and textures of numbers, on any backend: against formulas,
// their parts alone, and the serial backend's pictures. Included by each on_<backend>.cpp.
#pragma once

#include "light_kind_tests.hpp"
#include "mixture_scenes.hpp"
#include "texture_tests.hpp"

namespace photongrid::testing {

template <class Tag>
class mixtures : public textures<Tag> {
};
TYPED_TEST_SUITE_P(mixtures);

/// Sheets between the sun, the camera beside it, and a wall. Light meets each sheet twice: from the sun and to the eye.
TYPED_TEST_P(mixtures, sheets_stop_the_light_of_their_opacity)
{
    const double grey = 0.5;
    auto s = rectangle_in_even_light(textured_rectangle({-1, -1, 0}, {4, 0, 0}, {0, 3, 0}), {});
    s.materials[0].reflectance = dvec3(grey);
    const auto sheet = [&](float z, const dvec3& reflectance, double opacity, texture_use texture) {
        material m{"sheet", material_kind::lambertian, reflectance};
        m.opacity = opacity;
        m.opacity_texture = std::move(texture);
        s.materials.push_back(m);
        s.meshes.push_back({"", std::make_shared<const mesh>(textured_rectangle({-1, -1, z}, {4, 0, 0}, {0, 3, 0})),
            glm::dmat3(1), dvec3(0), static_cast<std::uint32_t>(s.materials.size() - 1)});
    };
    sheet(0.25f, dvec3(0.2, 0.4, 0.8), 0.25, {});
    sheet(0.5f, dvec3(0.9, 0.3, 0.6), 0.8, use_of_numbers({1, 0, 0, 1, 0.5}, texture_channel::blue));
    const auto opacity = [](double x) { // of the second sheet, by x
        const double at = (x + 1) / 4 * 5 - 0.5;
        const double values[] = {1, 0, 0, 1, 0.5};
        const double left = std::clamp(std::floor(at), 0.0, 3.0);
        const auto i = static_cast<std::size_t>(left);
        return 0.8 * (values[i] + (values[i + 1] - values[i]) * std::clamp(at - left, 0.0, 1.0));
    };
    const auto seen = this->picture(s);
    const double half = std::tan(glm::radians(8.0));
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 48; ++x) {
            const double slope = half * 1.5 * ((x + 0.5) / 24 - 1);
            const auto at = [&](double z) { return 0.75 + (3 - z) * slope; };
            const double first = opacity(at(0.5));
            for (int c = 0; c < 3; ++c) {
                const auto of = [&](std::size_t m) { return s.materials[m].reflectance[c]; };
                const double behind
                    = (1 - opacity(at(0.25))) * 0.25 * of(1) + (1 - opacity(at(0))) * 0.75 * 0.75 * grey;
                EXPECT_NEAR(static_cast<double>(seen.pixels[y * 48 + x][c]), first * of(2) + (1 - first) * behind, 2e-4)
                    << x << ' ' << y << ' ' << c;
            }
        }
    // Another sheet where one is already, or closer to it than the offset of rays, counts as one with it.
    for (const double gap : {0.0, 1e-8}) {
        auto doubled = s;
        doubled.meshes.push_back(
            {"", std::make_shared<const mesh>(*s.meshes[1].surface), glm::dmat3(1), {0, 0, -gap}, 1});
        EXPECT_LE(relative_mse(this->picture(doubled), seen), 1e-9) << gap;
    }
}

/// What two faces of glass let pass, with all reflections between them (Stokes 1862).
inline double passes_pane(double cosine, double index)
{
    const double sine = std::sqrt(1 - cosine * cosine) / index, inside = std::sqrt(1 - sine * sine),
                 s = (cosine - index * inside) / (cosine + index * inside),
                 p = (inside - index * cosine) / (inside + index * cosine), face = (s * s + p * p) / 2;
    return (1 - face) / (1 + face);
}

/// Shadow rays go straight on through a pane, from either side, whatever else it is mixed with.
TYPED_TEST_P(mixtures, panes_let_pass_what_two_faces_do_not_reflect)
{
    const dvec3 tint(0.9, 0.5, 0.2);
    auto s = rectangle_in_even_light(textured_rectangle({-1, -1, 0}, {4, 0, 0}, {0, 3, 0}), {});
    s.materials.push_back({"pane", material_kind::thin_glass, tint, 1.7});
    s.materials.push_back({"black", material_kind::lambertian, dvec3(0)});
    s.materials.push_back(mixture_of(2, 1, 0.25, {}));
    s.materials.push_back(mixture_of(1, 2, 0.25, {}));
    s.materials[4].opacity = 0.5;
    const std::vector<dvec3> points(16, {0.3, 0.4, 0.1}), normals(16, {0, 0, 1});
    for (const dvec3& towards : {dvec3(0, 0, 1), dvec3(0.6, 0, 0.8), dvec3(0.3, 0.8, 0.25)}) {
        const dvec3 d = glm::normalize(towards);
        s.directional_lights = {{"sun", -d, dvec3(2)}};
        s.environment_lights.clear();
        const auto bare = direct_light_at(this->b(), s, points, normals, 1);
        for (const bool turned : {false, true})
            for (const std::uint32_t m : {1u, 3u, 4u}) {
                auto behind = s;
                auto sheet = textured_rectangle({-9, -9, 0.5f}, {18, 0, 0}, {0, 18, 0});
                if (turned)
                    for (auto& t : sheet.triangles)
                        std::swap(t.y, t.z);
                behind.meshes.push_back({"", std::make_shared<const mesh>(sheet), glm::dmat3(1), dvec3(0), m});
                const auto found = direct_light_at(this->b(), behind, points, normals, 1);
                const double share = m == 1 ? 1 : m == 3 ? 0.25 : 0.5 * 0.75, past = m == 4 ? 0.5 : 0;
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(
                        double(found[0][c]) / double(bare[0][c]), past + share * tint[c] * passes_pane(d.z, 1.7), 1e-5)
                        << m << turned << c;
            }
    }
}

/// The eye sees the share of a sheet that is its opacity, so photons on it are of all the light that it receives.
TYPED_TEST_P(mixtures, what_is_clear_in_part_receives_all_light)
{
    auto& b = this->b();
    const auto power_on_sheet = [&](double opacity, bool in_a_mixture) {
        scene s;
        s.materials
            = {{"wall", material_kind::lambertian, dvec3(0.8)}, {"sheet", material_kind::lambertian, dvec3(0.01)}};
        if (in_a_mixture) {
            s.materials.push_back({"mirror", material_kind::mirror, dvec3(0)});
            s.materials.push_back({"both", material_kind::mixture});
            s.materials.back().parts = {1, 2};
        }
        s.materials.back().opacity = opacity;
        s.polygons = {{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0}};
        s.meshes = {{"", std::make_shared<const mesh>(textured_rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0})),
            glm::dmat3(1), dvec3(0), in_a_mixture ? 3u : 1u}};
        s.point_lights = {{"bulb", {0, 0, 0.5}, dvec3(1)}};
        s.render.map.photons = 20000;
        const auto device = upload_scene(b, s);
        const auto t = trace_photons(b, device, s.render);
        const auto positions = b.download(t.photons.positions), powers = b.download(t.photons.powers);
        double sum = 0;
        for (std::size_t i = 0; i < positions.size(); ++i)
            if (static_cast<double>(positions[i].z) + device.layout.center.z > 0.5)
                sum += static_cast<double>(powers[i].x);
        return sum;
    };
    const double opaque = power_on_sheet(1, false);
    EXPECT_GT(opaque, 0.05);
    for (const bool in_a_mixture : {false, true})
        for (const double opacity : {0.2, 0.7})
            EXPECT_NEAR(power_on_sheet(opacity, in_a_mixture), opaque, 0.04 * opaque) << opacity << in_a_mixture;
}

/// Where nothing stops light, and where all is stopped, a sheet is not there, or as if it had no opacity.
TYPED_TEST_P(mixtures, what_is_clear_is_not_seen_and_what_is_opaque_is_as_before)
{
    auto s = with_meshes(small_cornell());
    s.spheres.clear();
    s.render.output.only = light_part::direct; // photons that pass a sheet have other random numbers from there on
    const auto plain = this->picture(s);
    auto clear = s.materials[1];
    clear.opacity = 0;
    s.materials.push_back(clear);
    s.meshes.push_back(
        {"", std::make_shared<const mesh>(textured_rectangle({0.1f, 0.7f, 0.1f}, {0.8f, 0, 0}, {0, 0, 0.8f})),
            glm::dmat3(1), dvec3(0), 5});
    // Rays start anew at the sheet, and hit elsewhere by their rounding.
    EXPECT_LE(relative_mse(this->picture(s), plain), 1e-6);
    s.render.output.only = light_part::all;
    s.materials[5].opacity = 1;
    const auto opaque = this->picture(s);
    s.materials[5].opacity_texture.map = std::make_shared<const texture>(); // white
    EXPECT_LE(relative_mse(this->picture(s), opaque), 1e-6);
}

TYPED_TEST_P(mixtures, matte_parts_add_up_by_their_shares)
{
    auto rectangle = textured_rectangle({0, 0, 0}, {1.5f, 0, 0}, {0, 1, 0});
    rectangle.colors = {{1, 0.5f, 0.25f}, {1, 0.5f, 0.25f}, {1, 0.5f, 0.25f}, {1, 0.5f, 0.25f}};
    auto s = rectangle_in_even_light(rectangle, {});
    const dvec3 first(0.9, 0.8, 0.7), second(0.1, 0.3, 0.6);
    s.materials[0] = mixture_of(1, 2, 0.75, use_of_numbers({0, 1}, texture_channel::green));
    s.materials.push_back({"first", material_kind::lambertian, first});
    s.materials.push_back({"second", material_kind::lambertian, second});
    s.materials[2].texture = use_of_numbers({0.5, 0.5}, texture_channel::red);
    s.materials[2].texture.map = std::make_shared<const texture>(texture{1, 1, {{32768, 16384, 65535, 65535}}});
    this->expect_reflectance(s, [&](double u, double) {
        const double share = 0.75 * std::clamp(2 * u - 0.5, 0.0, 1.0);
        const dvec3 textured = second * dvec3(32768, 16384, 65535) / 65535.0;
        return ((1 - share) * first + share * textured) * dvec3(1, 0.5, 0.25);
    });
}

/// In light that is the same from everywhere.
TYPED_TEST_P(mixtures, of_all_kinds_have_the_albedo_of_their_parts)
{
    const dvec3 gold(1, 0.5, 0.25), base(1, 0.5, 0);
    const known_coat coat{1.5, 0.09};
    const dvec3 left = coat.left(base);
    const double share = 0.3;
    const auto [mean, known] = ball_in_even_light(
        mixture_of(2, 3, share), 16,
        [&](scene s) {
            s.materials.push_back({"plastic", material_kind::plastic, base, 1.5, 0.3});
            s.materials.push_back({"metal", material_kind::metal, gold, 1.5, 0.4});
            s.materials.back().energy = facet_bounces::single;
            return this->picture(s);
        },
        [&](double cosine) {
            const double reflected = coat.reflected(cosine);
            const dvec3 of_metal = gold * albedo_of_facets(cosine, 0.16, [](double) { return 1.0; });
            return (1 - share) * (reflected + (1 - reflected) * left) + share * of_metal;
        });
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c] / known[c], 1, 0.01) << c;
}

/// A mixture of one part alone, and textures of numbers that are everywhere the same, against materials without.
TYPED_TEST_P(mixtures, of_one_part_and_even_textures_are_as_plain_materials)
{
    auto s = with_meshes(small_cornell());
    s.spheres.clear();
    s.materials[3].roughness = 0.3;
    s.meshes[0] = {"", std::make_shared<const mesh>(textured_rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1})), glm::dmat3(1),
        dvec3(0), 3};
    const auto metal = this->picture(s);
    auto with_texture = s;
    with_texture.materials[3].roughness = 0.6;
    with_texture.materials[3].roughness_texture = use_of_numbers({0.5}, texture_channel::alpha);
    EXPECT_LE(relative_mse(this->picture(with_texture), metal), 1e-4);
    // What walls reflect is rounded to 2^-12 in scenes with mixtures.
    for (const double share : {0.0, 1.0}) {
        auto mixed = s;
        mixed.materials.push_back({"silver", material_kind::mirror, dvec3(0.9)});
        mixed.materials.push_back(share > 0 ? mixture_of(5, 3, share) : mixture_of(3, 5, share));
        mixed.materials.push_back(share > 0 ? mixture_of(2, 1, share) : mixture_of(1, 2, share));
        mixed.meshes[0].material = 6;
        mixed.meshes[3].material = 7;
        ASSERT_EQ(s.meshes[3].material, 1u);
        EXPECT_LE(relative_mse(this->picture(mixed), metal), 1e-5) << share;
    }
}

/// A matte part stores all photons that a surface receives, not only those that leave as from it.
TYPED_TEST_P(mixtures, store_all_photons_that_reach_a_matte_part)
{
    auto plain = small_cornell();
    plain.spheres.clear();
    plain.render.map.photon_depth = 2;
    auto mixed = plain;
    mixed.materials.push_back({"silver", material_kind::mirror, dvec3(0.9)});
    mixed.materials.push_back(mixture_of(5, 0, 0.1));
    mixed.polygons[0].material = 6; // the floor
    constexpr uint paths = 8192;
    const auto frames_of = [&](const scene& s) {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        detail::photon_frames<typename TestFixture::B> f(b, std::size_t{paths} * 3);
        trace_batch(b, device, f, {paths}, s.render);
        return std::tuple{b.download(f.positions), b.download(f.powers), static_cast<float>(device.layout.center.y)};
    };
    const auto [positions, powers, height] = frames_of(plain);
    const auto [mixed_positions, mixed_powers, same_height] = frames_of(mixed);
    const auto is_on_floor = [floor = -height](const glm::vec4& p) {
        return kernels::event_is_diffuse(p) && std::abs(p.y - floor) < 1e-3f;
    };
    std::size_t stored = 0;
    for (std::size_t p = 0; p < paths; ++p) {
        const std::size_t second = 2 * paths + p;
        const auto& first = positions[paths + p];
        if (kernels::event_end(first) != kernels::GOES_ON || is_on_floor(first) || !is_on_floor(positions[second]))
            continue;
        ++stored;
        ASSERT_TRUE(kernels::event_is_stored(mixed_positions[second], kernels::CAUSTICS | kernels::OTHER_PHOTONS)) << p;
        ASSERT_EQ(glm::vec3(mixed_positions[second]), glm::vec3(positions[second])) << p;
        for (int c = 0; c < 3; ++c) // colours are rounded to 2^-12 where there are mixtures
            ASSERT_LE(std::abs(mixed_powers[second][c] - powers[second][c]), 1e-3f * powers[second].x) << p;
    }
    EXPECT_GT(stored, 200u);
}

TYPED_TEST_P(mixtures, equal_the_serial_backends)
{
    const auto s = mixed_cornell();
    this->expect_serial(s, s.render);
}

TYPED_TEST_P(mixtures, account_for_every_path)
{
    auto s = mixed_cornell();
    s.render.map.photons = 20000;
    expect_an_exact_account(this->traced(s), 20000);
}

REGISTER_TYPED_TEST_SUITE_P(mixtures, sheets_stop_the_light_of_their_opacity,
    panes_let_pass_what_two_faces_do_not_reflect, what_is_clear_in_part_receives_all_light,
    what_is_clear_is_not_seen_and_what_is_opaque_is_as_before, matte_parts_add_up_by_their_shares,
    of_all_kinds_have_the_albedo_of_their_parts, of_one_part_and_even_textures_are_as_plain_materials,
    store_all_photons_that_reach_a_matte_part, equal_the_serial_backends, account_for_every_path);

} // namespace photongrid::testing
