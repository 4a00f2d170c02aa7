// Spotlights, sphere lights, directional light and environments, on any backend: their direct light against formulas
// and brute force, their photons against their direct light, and the serial backend's pictures. Included by each
// on_<backend>.cpp.
#pragma once

#include "direct_light_at.hpp"
#include "known_coats.hpp"
#include "mesh_scene_tests.hpp"

namespace photongrid::testing {

template <class Tag>
class light_kinds : public mesh_scenes<Tag> {
protected:
    std::vector<glm::vec4> light_at(const scene& s, const std::vector<dvec3>& points, const dvec3& normal, uint samples)
    {
        return direct_light_at(
            this->b(), s, points, std::vector<dvec3>(points.size(), glm::normalize(normal)), samples);
    }
    /// The mean over samples at many equal points, and the largest deviation of a channel from `known`, as a share.
    double mean_error(const scene& s, const dvec3& point, const dvec3& normal, uint samples, const dvec3& known)
    {
        const auto all = light_at(s, std::vector<dvec3>(4096, point), normal, samples);
        dvec3 mean(0);
        for (const auto& e : all)
            mean += dvec3(e) / 4096.0;
        const dvec3 off = glm::abs(mean / known - 1.0);
        return std::max({off.x, off.y, off.z});
    }
};
TYPED_TEST_SUITE_P(light_kinds);

TYPED_TEST_P(light_kinds, a_spotlight_has_its_intensity)
{
    for (const auto& [inner, outer] : {std::pair{0.0, 0.5}, {15.0, 40.0}, {60.0, 60.0}, {30.0, 179.0}, {90.0, 180.0}}) {
        auto s = bare_floor();
        s.spot_lights = {{"spot", {0.25, 2, -0.5}, {0.3, -1, 0.1}, inner, outer, dvec3(7)}};
        const dvec3 axis = glm::normalize(s.spot_lights[0].direction);
        // Its power, from a Riemann sum over the cone.
        const double from = std::cos(glm::radians(outer)), full = std::cos(glm::radians(inner));
        const auto falloff = [&](double cosine) {
            const double t = (cosine - from) / (full - from);
            return cosine >= full ? 1.0 : cosine <= from ? 0.0 : t * t * (3 - 2 * t);
        };
        double of_one = 0;
        for (int i = 0; i < 100000; ++i)
            of_one += falloff(from + (1 - from) * (i + 0.5) / 100000) * (1 - from) / 100000 * 2 * M_PI;
        std::vector<dvec3> points;
        for (int i = 0; i < 200; ++i)
            points.emplace_back(0.25 + 0.6 - 2.8 * i / 199, 0, -0.3);
        const auto found = this->light_at(s, points, {0, 1, 0}, 1);
        double largest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const dvec3 d = points[i] - s.spot_lights[0].position;
            const double r = glm::length(d), cosine = glm::dot(d, axis) / r;
            const double known = 7 / of_one * falloff(cosine) * -d.y / (r * r * r), most = 7 / of_one / (r * r);
            // A narrow cone's edge is as sharp as single precision: 1e-6 of a cosine.
            const double slack = (1e-4 + 2e-6 / (1 - from)) * most;
            largest = std::max(largest, static_cast<double>(found[i].x));
            EXPECT_NEAR(static_cast<double>(found[i].x), known, slack) << inner << ' ' << outer << " at " << i;
        }
        EXPECT_GT(largest, 0.0) << inner;
    }
}

TYPED_TEST_P(light_kinds, a_sphere_lights_as_its_middle_does)
{
    // Wherever all of a sphere is above the horizon, its irradiance is that of a point light.
    auto s = bare_floor();
    s.sphere_lights = {{"globe", {0.5, 1.5, 0}, 0.4, dvec3(7)}};
    for (const dvec3& p : {dvec3(0.5, 0, 0), dvec3(-1, 0, 0.3), dvec3(0.5, 1.0999, 0), dvec3(2.5, 0, 2)}) {
        const dvec3 to = s.sphere_lights[0].center - p;
        const double known = 7 / (4 * M_PI) * to.y / std::pow(glm::length(to), 3);
        EXPECT_LE(this->mean_error(s, p, {0, 1, 0}, 16, dvec3(known)), 0.004) << p.x;
    }
    // Halfway below the horizon: the sum over a fine grid of directions.
    const dvec3 p(-1, 0.2, 0), normal = glm::normalize(dvec3(1, -1, 0)), to = s.sphere_lights[0].center - p;
    double known = 0;
    for (int i = 0; i < 2000; ++i)
        for (int j = 0; j < 2000; ++j) {
            const double z = 1 - 2 * (i + 0.5) / 2000, turn = 2 * M_PI * (j + 0.5) / 2000, r = std::sqrt(1 - z * z);
            const dvec3 d(r * std::cos(turn), r * std::sin(turn), z);
            const double along = glm::dot(d, to), off2 = glm::dot(to, to) - along * along;
            if (along > 0 && off2 < 0.16)
                known += std::max(0.0, glm::dot(d, normal)) * 4 * M_PI / 4e6;
        }
    known *= 7 / (4 * M_PI * M_PI * 0.16);
    ASSERT_GT(known, 0.01);
    EXPECT_LE(this->mean_error(s, p, normal, 16, dvec3(known)), 0.01);
    for (const auto& e : this->light_at(s, {s.sphere_lights[0].center + dvec3(0.1, 0, 0)}, {0, 1, 0}, 16))
        EXPECT_EQ(e.x, 0.0f) << "inside";
}

TYPED_TEST_P(light_kinds, directional_light_is_even_and_casts_shadows)
{
    auto s = bare_floor();
    s.directional_lights = {{"sun", {1, -2, 0.5}, dvec3(3, 2, 1)}};
    s.spheres = {{{0, 1, 0}, 0.25, 0}};
    const double cosine = 2 / std::sqrt(1 + 4 + 0.25);
    const auto lit = this->light_at(s, {{-1, 0, 0}, {2.9, 0, -2.9}, {0, 0, 0}}, {0, 1, 0}, 1);
    for (const auto& e : lit)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(e[c]), (3 - c) * cosine, 1e-5);
    for (const auto& e : this->light_at(s, {{0.5, 0, 0.25}, {0.6, 0, 0.3}}, {0, 1, 0}, 1))
        EXPECT_EQ(e.x, 0.0f) << "in the shadow";
    EXPECT_EQ(this->light_at(s, {{-1, 0, 0}}, {0, -1, 0}, 1)[0].x, 0.0f) << "from below";
}

TYPED_TEST_P(light_kinds, an_environment_has_the_light_of_its_texels)
{
    const auto s = floors_under_each_light()[3];
    const auto& sky = s.environment_lights[0];
    const auto turned = rotation_about(sky.axis, sky.degrees);
    for (const dvec3& normal : {dvec3(0, 1, 0), dvec3(0.6, 0.64, 0.48)}) {
        dvec3 known(0);
        const int fine = 40;
        const auto& m = *sky.map;
        for (std::uint32_t row = 0; row < m.height * fine; ++row)
            for (std::uint32_t column = 0; column < m.width * fine; ++column) {
                const double v = (row + 0.5) / (m.height * fine), u = (column + 0.5) / (m.width * fine);
                const dvec3 d = turned * environment_direction(u, v);
                if (d.y > 0) // above the floor
                    known += sky.radiance * dvec3(m.radiance[std::size_t{row / fine} * m.width + column / fine])
                        * std::max(0.0, glm::dot(d, normal)) * std::sin(M_PI * v)
                        * (2 * M_PI * M_PI / (m.height * fine * m.width * fine));
            }
        EXPECT_LE(this->mean_error(s, {0, 1e-3, 0}, normal, 64, known), 0.01);
    }
    const auto white = floors_under_each_light()[4];
    EXPECT_LE(this->mean_error(white, {0.5, 0, 0.5}, {0, 1, 0}, 64, dvec3(M_PI)), 0.003);
}

TYPED_TEST_P(light_kinds, the_camera_sees_the_environment)
{
    auto s = floors_under_each_light()[3];
    const auto& sky = s.environment_lights[0];
    s.render.output.width = 64, s.render.output.height = 48;
    s.render.view.spp = 1;
    s.render.output.only = light_part::direct;
    s.camera = {{0, 5, 0}, {1, 9, 2}, {0, 1, 0}, 120};
    const auto seen = this->picture(s);
    const auto [forward, right, up] = detail::camera_axes(s.camera);
    const double half = std::tan(glm::radians(60.0));
    std::size_t off = 0;
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const dvec3 d = glm::transpose(rotation_about(sky.axis, sky.degrees))
                * glm::normalize(
                    forward + ((x + 0.5) / 32 - 1) * half * 64 / 48 * right + (1 - (y + 0.5) / 24) * half * up);
            const double u = std::atan2(d.x, -d.z) / (2 * M_PI), v = std::acos(d.y) / M_PI;
            const auto column = static_cast<std::size_t>((u < 0 ? u + 1 : u) * 24),
                       row = static_cast<std::size_t>(v * 12);
            const dvec3 known = sky.radiance * dvec3(sky.map->radiance[row * 24 + column]);
            off += glm::length(dvec3(seen.pixels[y * 64 + x]) - known) > 1e-5 * glm::length(known) ? 1 : 0;
        }
    EXPECT_LE(off, 5u) << "pixels at the edges of texels";
}

/// Photons through glass that refracts nothing land as shadow rays say.
TYPED_TEST_P(light_kinds, photons_and_shadow_rays_agree)
{
    for (auto s : floors_under_each_light()) {
        SCOPED_TRACE(s.spot_lights.empty() ? s.sphere_lights.empty() ? "distant" : "sphere" : "spot");
        const bool outside = s.spot_lights.empty() && s.sphere_lights.empty();
        s.render.output.only = light_part::direct;
        const auto direct = this->picture(s);
        if (outside) {
            s.spheres = {{{0, 0.5, 0}, 5, 1}}; // around all, and the camera
        } else {
            s.polygons.push_back({{{-4, 0.3, -4}, {-4, 0.3, 4}, {4, 0.3, 4}, {4, 0.3, -4}}, 1});
        }
        s.render.output.only = light_part::caustic;
        const auto through_glass = this->picture(s);
        dvec3 sum(0), known(0);
        for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
            sum += dvec3(through_glass.pixels[i]);
            known += dvec3(direct.pixels[i]);
        }
        ASSERT_GT(known.x, 0);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c] / known[c], 1, 0.03) << c; // the noise of 60,000 photons is 1 %
    }
}

/// In light that is the same from everywhere, whatever absorbs nothing cannot be seen.
TYPED_TEST_P(light_kinds, what_absorbs_nothing_in_a_white_environment_cannot_be_seen)
{
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(1)}, {"mirror", material_kind::mirror, dvec3(1)},
        {"glass", material_kind::glass, dvec3(1), 1.5}};
    s.spheres = {{{-1, 0, 0}, 0.7, 1}, {{1, 0, 0}, 0.7, 2}, {{0, 1.3, 0}, 0.5, 0}};
    s.environment_lights = {{"white", "", nullptr, dvec3(1, 2, 4)}};
    s.camera = {{0, 0.3, 5}, {0, 0.3, 0}, {0, 1, 0}, 40};
    s.render = {.map = {.photons = 60000, .grid = {20, 20, 20}},
        .estimate = {.k = 150, .max_radius = 0.2},
        .view = {.spp = 2, .light_samples = 36},
        .output = {.width = 32, .height = 24}};
    const auto seen = this->picture(s);
    dvec3 mean(0);
    for (const auto& p : seen.pixels) {
        mean += dvec3(p) / double(seen.pixels.size());
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(p[c]) / (1 << c), 1, 0.2);
    }
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c] / (1 << c), 1, 0.004);
}

/// The mean of a picture of the middle of a ball in light that is the same from everywhere, of radiance 1, 2 and 4, and
/// the one that is known; `albedo`: of the ball, by the cosine at which it is seen.
template <class Picture, class Albedo>
std::pair<dvec3, dvec3> ball_in_even_light(
    const material& m, std::uint32_t light_samples, const Picture& picture, const Albedo& albedo)
{
    const dvec3 radiance(1, 2, 4);
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(1)}, m};
    s.spheres = {{{0, 0, 0}, 1, 1}, {{0, 0, -20}, 0.1, 0}};
    s.environment_lights = {{"white", "", nullptr, radiance}};
    s.camera = {{0, 0, 50}, {0, 0, 0}, {0, 1, 0}, 1.6};
    s.render = {.map = {.photons = 100, .grid = {20, 20, 20}},
        .estimate = {.k = 15, .max_radius = 0.2},
        .view = {.spp = 16, .light_samples = light_samples},
        .output = {.width = 24, .height = 24, .only = light_part::direct}};
    const auto seen = picture(s);
    dvec3 mean(0);
    for (const auto& p : seen.pixels)
        mean += dvec3(p) / double(seen.pixels.size());
    dvec3 known(0); // of the square within the ball, all seen along one direction
    constexpr int steps = 24;
    const double half = 50 * std::tan(glm::radians(0.8));
    for (int x = 0; x < steps / 2; ++x)
        for (int y = 0; y < steps / 2; ++y) {
            const double r2 = half * half * (std::pow((2 * x + 1.0) / steps, 2) + std::pow((2 * y + 1.0) / steps, 2));
            known += radiance * albedo(std::sqrt(1 - r2)) * 4.0 / double(steps * steps);
        }
    return {mean, known};
}

/// Of rough surfaces, too: light leaves facets at last.
TYPED_TEST_P(light_kinds, rough_surfaces_in_a_white_environment_cannot_be_seen)
{
    scene s;
    const auto white = [&](const char* name, material_kind kind, double roughness) {
        s.materials.push_back({name, kind, dvec3(1), 1.5, roughness});
    };
    white("brushed", material_kind::metal, 0.6);
    white("blasted", material_kind::metal, 1);
    white("frosted", material_kind::glass, 0.6);
    s.materials.push_back({.name = "both", .kind = material_kind::mixture, .parts = {1, 2}});
    white("matte", material_kind::lambertian, 0);
    for (std::uint32_t m = 0; m < 4; ++m)
        s.spheres.push_back({{1.1 * m - 1.65, 0, 0}, 0.5, m}); // from left to right
    s.spheres.push_back({{0, 0, -20}, 0.1, 4});
    s.environment_lights = {{"white", "", nullptr, dvec3(1, 2, 4)}};
    s.camera = {{0, 0, 50}, {0, 0, 0}, {0, 1, 0}, 1.26};
    s.render = {.map = {.photons = 1000, .grid = {20, 20, 20}},
        .estimate = {.k = 50, .max_radius = 0.2},
        .view = {.spp = 64, .light_samples = 1, .depth = 40},
        .output = {.width = 48, .height = 12, .only = light_part::direct}};
    const auto seen = this->picture(s);
    dvec3 means[4]{};
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) // a ball fills most of its quarter of the picture
        means[i % 48 / 12] += dvec3(seen.pixels[i]) / 144.0;
    for (int ball = 0; ball < 4; ++ball)
        for (int c = 0; c < 3; ++c) // the noise of glass is 1 %
            EXPECT_NEAR(means[ball][c] / (1 << c), 1, ball < 2 ? 0.015 : 0.03) << ball << c;
}

/// What a rough ball does not reflect, meets a second facet.
TYPED_TEST_P(light_kinds, rough_metal_has_the_albedo_of_its_facets)
{
    for (const double roughness : {0.1, 0.4, 0.7, 1.0}) {
        const dvec3 gold(1, 0.5, 0.25);
        material metal{"metal", material_kind::metal, gold, 1.5, roughness};
        metal.energy = facet_bounces::single;
        const auto [mean, known] = ball_in_even_light(
            metal, 1, [&](const scene& s) { return this->picture(s); },
            [&](double cosine) {
                return gold * albedo_of_facets(cosine, roughness * roughness, [](double) { return 1.0; });
            });
        std::printf("roughness %.1f: %.1f %% of the light meets a second facet\n", roughness, 100 * (1 - known.x));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c] / known[c], 1, 0.01) << roughness;
    }
}

/// A coat reflects, and what it does not reflect reaches the base, so that a white one loses nothing.
TYPED_TEST_P(light_kinds, plastic_has_the_albedo_of_its_coat_and_its_base)
{
    const dvec3 base(1, 0.5, 0);
    for (const auto& [index, roughness] : {std::pair(1.5, 0.0), {1.5, 0.3}, {1.5, 0.9}, {4.0, 0.6}}) {
        const known_coat coat{index, roughness * roughness};
        const dvec3 left = coat.left(base);
        const auto [mean, known] = ball_in_even_light(
            {"plastic", material_kind::plastic, base, index, roughness}, 16,
            [&](const scene& s) { return this->picture(s); },
            [&](double cosine) {
                const double reflected = coat.reflected(cosine);
                return reflected + (1 - reflected) * left;
            });
        EXPECT_NEAR(known.x, 1, 0.002);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c] / known[c], 1, 0.01) << index << ' ' << roughness;
    }
}

/// Only light `number` of a scene; the surfaces of the others are black shapes.
inline scene with_one_light(scene s, std::size_t number)
{
    const auto black = static_cast<std::uint32_t>(s.materials.size());
    s.materials.push_back({"black", material_kind::lambertian, dvec3(0)});
    std::size_t n = 0;
    for_each_light(s, [&](auto& list, auto) {
        std::decay_t<decltype(list)> kept;
        for (const auto& l : list) {
            if (n++ == number) {
                kept.push_back(l);
            } else if constexpr (requires { l.edge_u; }) {
                s.polygons.push_back(surface_of(l));
                s.polygons.back().material = black;
            } else if constexpr (requires { l.radius; }) {
                s.spheres.push_back({l.center, l.radius, black});
            } else if constexpr (requires { l.surface; }) {
                s.meshes.push_back(l.surface);
                s.meshes.back().material = black;
            }
        }
        list = kept;
    });
    return s;
}

/// Where each sample chooses one of many lights, their mean is the sum of all lights, one by one.
TYPED_TEST_P(light_kinds, of_which_samples_choose_add_up)
{
    const auto s = many_lights();
    ASSERT_GT(count_lights(s), detail::most_lights_sampled_each);
    for (const auto& [point, normal] : {std::pair{dvec3(-1, 0, -1), dvec3(0, 1, 0)},
             {dvec3(0.1, 0.3, 0.2), dvec3(1, 2, -3)}, {dvec3(-2.3, 0.1, -2.2), dvec3(1, 0.5, 0.2)}}) {
        dvec3 known(0);
        for (std::size_t n = 0; n < count_lights(s); ++n)
            for (const auto& e : this->light_at(with_one_light(s, n), std::vector<dvec3>(256, point), normal, 16))
                known += dvec3(e) / 256.0;
        ASSERT_GT(known.x, 0.01);
        EXPECT_LE(this->mean_error(s, point, normal, 32, known), 0.04) << point.x; // of 1.2 % of noise
    }
}

/// A room with a window in its ceiling, 0.5 m x 0.8 m, 2 m above the floor, and nothing but the sky outside.
inline scene room_under_a_window()
{
    auto s = bare_floor();
    const auto across = [](double x, double z, double past_x, double past_z) {
        return polygon{{{x, 2, z}, {past_x, 2, z}, {past_x, 2, past_z}, {x, 2, past_z}}, 0};
    };
    s.polygons.insert(
        s.polygons.end(), {across(-3, -3, 3, 0.2), across(-3, 1, 3, 3), across(-3, 0.2, 0.5, 1), across(1, 0.2, 3, 1)});
    for (const auto& [x, z, past_x, past_z] :
        {std::tuple{-3, -3, 3, -3}, {-3, 3, 3, 3}, {-3, -3, -3, 3}, {3, -3, 3, 3}})
        s.polygons.push_back({{{x, 0, z}, {past_x, 0, past_z}, {past_x, 2, past_z}, {x, 2, z}}, 0});
    s.environment_lights = {{"sky", "", nullptr, dvec3(1, 2, 4)}};
    s.camera = {{0, 1.9, 0}, {0.2, 0, 0.3}, {0, 0, 1}, 100};
    return s;
}

TYPED_TEST_P(light_kinds, the_sky_through_a_window_has_its_light_and_little_noise)
{
    const auto s = room_under_a_window();
    for (const dvec3& p : {dvec3(0.75, 0, 0.6), dvec3(-0.5, 0, 0.4), dvec3(1.2, 0, -0.9)}) {
        double known = 0;
        constexpr int side = 400;
        for (int i = 0; i < side * side; ++i) {
            const dvec3 to = dvec3(0.5 + 0.5 * (i % side + 0.5) / side, 2, 0.2 + 0.8 * (i / side + 0.5) / side) - p;
            known += to.y * to.y / std::pow(glm::length(to), 4) * 0.5 * 0.8 / (side * side);
        }
        constexpr std::size_t points = 16384;
        std::array<double, 2> mean{}, variance{};
        for (const bool guided : {false, true}) {
            const auto light = direct_light_at(
                this->b(), s, std::vector<dvec3>(points, p), std::vector<dvec3>(points, {0, 1, 0}), 1, guided);
            for (const auto& e : light) {
                EXPECT_NEAR(static_cast<double>(e.y), 2.0 * static_cast<double>(e.x), 1e-5 * static_cast<double>(e.y));
                mean[guided] += static_cast<double>(e.x) / points;
                variance[guided] += static_cast<double>(e.x) * static_cast<double>(e.x) / points;
            }
            variance[guided] -= mean[guided] * mean[guided];
        }
        EXPECT_NEAR(mean[1] / known, 1, 4 * std::sqrt(variance[1] / points) / known) << p.x;
        EXPECT_LT(variance[1], 16 * known * known) << p.x;
        EXPECT_LT(20 * variance[1], variance[0]) << p.x;
    }
}

TYPED_TEST_P(light_kinds, only_skies_that_few_samples_reach_need_a_guide)
{
    auto s = room_under_a_window();
    const auto table = [&](auto& backend) { return learn_sky(backend, upload_scene(backend, s), s.camera, 1.5); };
    serial_backend serial;
    const auto of_room = table(serial);
    EXPECT_FALSE(of_room.empty());
    if (const auto& caps = this->b().caps(); caps.exact_division && caps.exact_sqrt) {
        EXPECT_EQ(table(this->b()), of_room);
    }
    s.environment_lights.clear();
    s.point_lights = {{"bulb", {0, 1, 0}, dvec3(1)}};
    EXPECT_TRUE(table(this->b()).empty());
    s = room_under_a_window();
    s.polygons.resize(1);
    EXPECT_TRUE(table(this->b()).empty()) << "an open floor";
    s.camera = {{0, 5, 0}, {0, 9, 0.1}, {0, 0, 1}, 60};
    EXPECT_TRUE(table(this->b()).empty()) << "nothing is seen";
}

TYPED_TEST_P(light_kinds, equal_the_serial_backends)
{
    const auto room = room_under_a_window();
    this->expect_serial(room, room.render);

    const auto s = all_lights();
    this->expect_serial(s, s.render);
    auto many = many_lights();
    many.render.map.photons = 2000;
    this->expect_serial(many, many.render);
}

TYPED_TEST_P(light_kinds, account_for_every_path)
{
    auto s = all_lights();
    s.render.map.photons = 20000;
    expect_an_exact_account(this->traced(s), 20000);
    for (auto f : floors_under_each_light()) {
        f.spheres = {{{0, 0.5, 0}, 0.3, 0}};
        f.render.map.photons = 3000;
        expect_an_exact_account(this->traced(f), 3000);
    }
}

REGISTER_TYPED_TEST_SUITE_P(light_kinds, a_spotlight_has_its_intensity, a_sphere_lights_as_its_middle_does,
    directional_light_is_even_and_casts_shadows, an_environment_has_the_light_of_its_texels,
    the_camera_sees_the_environment, photons_and_shadow_rays_agree, of_which_samples_choose_add_up,
    what_absorbs_nothing_in_a_white_environment_cannot_be_seen, rough_surfaces_in_a_white_environment_cannot_be_seen,
    rough_metal_has_the_albedo_of_its_facets, plastic_has_the_albedo_of_its_coat_and_its_base,
    the_sky_through_a_window_has_its_light_and_little_noise, only_skies_that_few_samples_reach_need_a_guide,
    equal_the_serial_backends, account_for_every_path);

} // namespace photongrid::testing
