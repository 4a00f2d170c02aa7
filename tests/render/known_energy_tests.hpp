// Scenes whose light is known to the last digits, so that an error of 0.2 % in one lamp, one material, one channel or
// one picture is seen.
#pragma once

#include "../trace/known_coats.hpp"
#include "pictures.hpp"

namespace photongrid::testing {

/// A ball of one material amid six lamps that close a room, each of radiance 1, 2 and 4 W/(m^2 sr) in red, green and
/// blue: all that anybody sees there. Nothing in it reflects light that the ball can gather from the photon map.
inline scene ball_amid_lamps(const material& of)
{
    const double area = 4;
    scene s;
    s.name = "ball_amid_lamps";
    s.materials = {{"behind the lamps", material_kind::lambertian, dvec3(0.5)}, of};
    s.polygons = {{{{-1, -1, 3}, {1, -1, 3}, {0, 1, 3}}, 0}};
    s.spheres = {{dvec3(0), 0.5, 1}};
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            dvec3 corner(-1), u(0), v(0);
            corner[axis] = side;
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2; // u x v: along the axis
            if (side > 0)
                std::swap(u, v);
            s.rectangle_lights.push_back(
                {"lamp " + std::to_string(s.rectangle_lights.size()), corner, u, v, M_PI * area * dvec3(1, 2, 4)});
        }
    s.camera = {{0, 0.1, -0.9}, {0, 0, 0}, {0, 1, 0}, 75};
    s.render = {.map = {.photons = 100, .grid = {4, 4, 4}},
        .estimate = {.k = 5, .max_radius = 0.1},
        .view = {.spp = 1, .light_samples = 16, .depth = 64},
        .output = {.width = 32, .height = 32}};
    s.render.output.only = light_part::direct;
    return s;
}

/// The direction in which a camera looks through the middle of a pixel.
inline dvec3 through_pixel(const camera& c, const output_settings& out, std::uint32_t x, std::uint32_t y)
{
    const dvec3 forward = glm::normalize(c.look_at - c.position), right = glm::normalize(glm::cross(forward, c.up)),
                up = glm::cross(right, forward);
    const double half = std::tan(glm::radians(c.vertical_fov) / 2) / (0.5 * out.height);
    return glm::normalize(
        forward + right * half * (x + 0.5 - 0.5 * out.width) - up * half * (y + 0.5 - 0.5 * out.height));
}

/// For each pixel the cosine at which the ray through its middle meets the ball; -1 beside it, 2 too close to its rim.
inline std::vector<double> cosines_at_the_ball(const scene& s)
{
    const auto& out = s.render.output;
    std::vector<double> cosines;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double off_axis
                = glm::length(glm::cross(s.camera.position, through_pixel(s.camera, out, x, y))) / s.spheres[0].radius;
            cosines.push_back(off_axis > 1.001 ? -1 : off_axis > 0.999 ? 2 : std::sqrt(1 - off_axis * off_axis));
        }
    return cosines;
}

TYPED_TEST_P(pictures, a_ball_of_each_material_amid_lamps_has_the_known_radiance)
{
    const dvec3 radiance(1, 2, 4);
    const material balls[]
        = {{"white", material_kind::lambertian, {0.8, 0.5, 0.3}}, {"mirror", material_kind::mirror, {0.9, 0.7, 0.4}},
            {"metal", material_kind::metal, {0.9, 0.7, 0.4}}, {"glass", material_kind::glass, {0.95, 0.9, 0.8}, 1.5},
            {"plastic", material_kind::plastic, {0.95, 0.5, 0.1}, 1.5}};
    const dvec3 below_coat = known_coat{1.5, 0}.left(balls[4].reflectance);
    for (const auto& m : balls) {
        SCOPED_TRACE(m.name);
        auto s = ball_amid_lamps(m);
        const bool diffuse = m.kind == material_kind::lambertian || m.kind == material_kind::plastic;
        if (m.kind == material_kind::plastic) // no lamp is taken whole there, so that samples are noisy
            s.render.view.light_samples = 64;
        const auto cosines = cosines_at_the_ball(s);
        const auto drawn = this->picture(s);
        dvec3 seen(0), known(0);
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            if (cosines[i] > 1)
                continue;
            for (int c = 0; c < 3; ++c) {
                const double rho = m.reflectance[c];
                double of_pixel = radiance[c];
                if (cosines[i] >= 0 && m.kind == material_kind::plastic) {
                    const double f = unpolarised_reflectance(cosines[i], m.index_of_refraction);
                    of_pixel *= f + (1 - f) * below_coat[c];
                } else if (cosines[i] >= 0 && m.kind != material_kind::glass) {
                    of_pixel *= rho;
                } else if (cosines[i] >= 0) {
                    // Reflected, or through two surfaces after 0, 1, 2, ... reflections within.
                    const double f = unpolarised_reflectance(cosines[i], m.index_of_refraction);
                    of_pixel *= f * rho + (1 - f) * (1 - f) * rho * rho / (1 - f * rho);
                }
                const auto got = static_cast<double>(drawn.pixels[i][c]);
                if (cosines[i] >= 0) {
                    seen[c] += got;
                    known[c] += of_pixel;
                }
                if (cosines[i] < 0 || (!diffuse && m.kind != material_kind::glass)) {
                    ASSERT_NEAR(got, of_pixel, 1e-5 * of_pixel) << "pixel " << i << ", channel " << c;
                }
            }
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c] / known[c], 1, 0.002) << "channel " << c;
    }
}

/// Of four eye rays per pixel that chose between reflection and refraction independently, the mean would have a quarter
/// of the variance of one; they share the choices out, so it has less.
TYPED_TEST_P(pictures, eye_rays_of_a_pixel_share_out_the_choices_in_glass)
{
    auto s = ball_amid_lamps({"dark glass", material_kind::glass, dvec3(0.5), 2.5});
    const auto cosines = cosines_at_the_ball(s);
    const auto variance = [&](std::uint32_t spp) {
        constexpr std::uint32_t seeds = 6;
        s.render.view.spp = spp;
        std::vector<double> sums(cosines.size()), squares(cosines.size());
        for (s.render.seed = 1; s.render.seed <= seeds; ++s.render.seed) {
            const auto drawn = this->picture(s);
            for (std::size_t i = 0; i < cosines.size(); ++i) {
                const auto v = static_cast<double>(drawn.pixels[i].x);
                sums[i] += v;
                squares[i] += v * v;
            }
        }
        double of_all = 0;
        for (std::size_t i = 0; i < cosines.size(); ++i)
            if (cosines[i] > 0.5 && cosines[i] <= 1) // away from the rim, where rays of one pixel meet different light
                of_all += (squares[i] - sums[i] * sums[i] / seeds) / (seeds - 1);
        return of_all;
    };
    const double of_one = variance(1), of_four = variance(4);
    EXPECT_GT(of_one, 0);
    EXPECT_LT(of_four, of_one / 4);
}

TYPED_TEST_P(pictures, a_floor_under_a_bulb_has_the_known_radiance)
{
    const dvec3 reflectance(0.8, 0.5, 0.3), power(10, 20, 40), bulb(0.3, 1.2, -0.4);
    scene s;
    s.name = "floor_under_a_bulb";
    s.materials = {{"floor", material_kind::lambertian, reflectance}};
    s.polygons = {{{{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}}, 0}};
    s.point_lights = {{"bulb", bulb, power}};
    s.camera = {{0.2, 2, 0.1}, {0, 0, 0}, {0, 0, 1}, 50};
    s.render = {.map = {.photons = 100, .grid = {4, 4, 4}},
        .estimate = {.k = 5, .max_radius = 0.1},
        .view = {.spp = 1, .light_samples = 1},
        .output = {.width = 24, .height = 16}};
    s.render.output.only = light_part::direct;
    const auto drawn = this->picture(s);
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 24; ++x) {
            const dvec3 d = through_pixel(s.camera, s.render.output, x, y);
            const dvec3 point = s.camera.position - d * (s.camera.position.y / d.y);
            const double distance = glm::length(bulb - point);
            for (int c = 0; c < 3; ++c) {
                const double irradiance = power[c] / (4 * M_PI * distance * distance) * bulb.y / distance;
                const double known = reflectance[c] / M_PI * irradiance;
                ASSERT_NEAR(static_cast<double>(drawn.pixels[y * 24 + x][c]), known, 1e-4 * known)
                    << x << ", " << y << ", channel " << c;
            }
        }
}

/// A path has the share of one of all that were sent out; at each surface roulette keeps it with the probability of the
/// largest reflectance, by which it is divided.
TYPED_TEST_P(pictures, photons_have_the_power_that_their_surfaces_left_them)
{
    const dvec3 reflectance(0.4, 0.8, 0.6);
    auto s = integrating_sphere(reflectance);
    s.point_lights[0].power = dvec3(10, 20, 40);
    s.render.map.photons = 5000;
    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, device, s.render);
    const auto powers = b.download(t.photons.powers);
    const auto emitted = static_cast<double>(t.emitted);
    double hits = 0;
    for (std::size_t i = 0; i < 5000; ++i) {
        const dvec3 share = dvec3(glm::vec3(powers[i])) * emitted / s.point_lights[0].power;
        ASSERT_NEAR(share.y, 1, 1e-5) << i;
        const double surfaces = std::round(std::log(share.x) / std::log(0.5));
        ASSERT_GE(surfaces, 1) << i << ": the first hit is direct light's";
        ASSERT_NEAR(share.x, std::pow(0.5, surfaces), 1e-5) << i;
        ASSERT_NEAR(share.z, std::pow(0.75, surfaces), 1e-5) << i;
        hits += surfaces;
    }
    // Of surfaces before a stored photon there are n with a probability proportional to 0.8^n: 5 on the average.
    EXPECT_NEAR(hits / 5000, 5, 5 * std::sqrt(20 / 5000.0) * 2);
}

} // namespace photongrid::testing
