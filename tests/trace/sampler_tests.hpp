// What is drawn at random has the distribution that it should have: lamps, light paths, eye rays and shadow rays. Bins
// are compared with the exact probabilities by chi-square, and what must be independent by its correlation. The file is
// long because each sampler has its case.
#pragma once

#include "../scene/test_scenes.hpp"
#include "eye_ray_tests.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/trace/eye_rays.hpp>
#include <photongrid/trace/final_gather_ray.kernel.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace photongrid::testing {
namespace {

    constexpr double pi = std::numbers::pi;
    /// Standard deviations. By chance a test of this file fails once in millions of seeds; the seeds are fixed.
    constexpr double far_off = 5;

    /// Counts in equally probable bins. Coordinates are in [0, 1).
    template <std::size_t D>
    class even_bins {
    public:
        explicit even_bins(std::size_t per_axis)
            : per_axis_(per_axis), counts_(static_cast<std::size_t>(std::lround(std::pow(per_axis, D))))
        {
        }
        void add(const std::array<double, D>& x)
        {
            std::size_t at = 0;
            for (const double c : x) {
                const double cell = std::floor(c * static_cast<double>(per_axis_));
                outside_ += cell < 0 || cell >= static_cast<double>(per_axis_) ? 1 : 0;
                at = at * per_axis_
                    + static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(per_axis_ - 1)));
            }
            ++counts_[at];
            ++n_;
        }
        /// Chi-square as a standard normal deviate (Wilson and Hilferty 1931).
        double deviate() const
        {
            const double expected = static_cast<double>(n_) / static_cast<double>(counts_.size());
            double sum = 0;
            for (const auto c : counts_) {
                const double d = static_cast<double>(c) - expected;
                sum += d * d / expected;
            }
            const double k = static_cast<double>(counts_.size()) - 1, v = 2 / (9 * k);
            return (std::cbrt(sum / k) - (1 - v)) / std::sqrt(v);
        }
        /// Coordinates below 0 or from 1 on; rounding may cause a few.
        std::size_t outside() const { return outside_; }

    private:
        std::size_t per_axis_;
        std::vector<std::size_t> counts_;
        std::size_t n_ = 0, outside_ = 0;
    };

    /// An angle as a fraction of a turn, from 0 to 1.
    double turn(double y, double x)
    {
        const double t = std::atan2(y, x) / (2 * pi);
        return t < 0 ? t + 1 : t;
    }

    double correlation(const std::vector<double>& a, const std::vector<double>& b)
    {
        const double n = static_cast<double>(a.size());
        double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            ma += a[i] / n;
            mb += b[i] / n;
        }
        for (std::size_t i = 0; i < a.size(); ++i) {
            ab += (a[i] - ma) * (b[i] - mb);
            aa += (a[i] - ma) * (a[i] - ma);
            bb += (b[i] - mb) * (b[i] - mb);
        }
        return ab / std::sqrt(aa * bb);
    }

    /// A floor, so that the scene has a diffuse surface.
    scene floor_scene()
    {
        scene s;
        s.name = "floor";
        s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}};
        s.polygons = {{{{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, 0}};
        return s;
    }
    /// A lamp that is parallel to no axis.
    const rectangle_light tilted{"tilted", {0.3, 1.2, -0.4}, {0.6, 0.2, 0.1}, {0.1, -0.6, 0.6}, {3, 2, 1}};

    /// The first frame of light paths; positions are those of the scene.
    struct emission {
        std::vector<dvec3> positions, directions;
        std::vector<glm::vec4> powers;
    };
    emission emit(const scene& s, uint paths, uint first = 0)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        detail::photon_frames<serial_backend> f(b, paths);
        detail::emit_photons(b, device, f, {paths, first}, s.render.seed);
        emission e{{}, {}, b.download(f.powers)};
        for (const auto& p : b.download(f.positions))
            e.positions.push_back(dvec3(glm::vec3(p)) + device.layout.center);
        for (const auto& d : b.download(f.directions))
            e.directions.emplace_back(glm::vec3(d));
        return e;
    }

    TEST(samplers, a_lamp_emits_uniformly_over_its_area_and_by_the_cosine)
    {
        auto s = floor_scene();
        s.rectangle_lights = {tilted};
        const dvec3 u = glm::normalize(tilted.edge_u), v = glm::normalize(tilted.edge_v), normal = glm::cross(u, v);
        even_bins<2> directions(64), places(64);
        even_bins<4> both(8);
        const auto e = emit(s, 1u << 20);
        for (std::size_t i = 0; i < e.positions.size(); ++i) {
            const auto& d = e.directions[i];
            const double height = glm::dot(d, normal);
            ASSERT_GT(height, 0);
            const dvec3 from = e.positions[i] - tilted.corner;
            const std::array<double, 2> way{height * height, turn(glm::dot(d, v), glm::dot(d, u))},
                place{glm::dot(from, u) / glm::length(tilted.edge_u), glm::dot(from, v) / glm::length(tilted.edge_v)};
            directions.add(way);
            places.add(place);
            both.add({way[0], way[1], place[0], place[1]});
        }
        EXPECT_LE(std::abs(directions.deviate()), far_off);
        EXPECT_LE(std::abs(places.deviate()), far_off);
        EXPECT_LE(std::abs(both.deviate()), far_off) << "direction and place depend on each other";
        EXPECT_LE(directions.outside() + places.outside(), 10u);
    }

    TEST(samplers, a_bulb_emits_in_all_directions_alike)
    {
        auto s = floor_scene();
        s.point_lights = {{"bulb", {0.3, 1, 0.2}, {1, 2, 3}}};
        even_bins<2> directions(64);
        const auto e = emit(s, 1u << 20);
        for (const auto& d : e.directions)
            directions.add({0.5 * (1 + d.z), turn(d.y, d.x)});
        EXPECT_LE(std::abs(directions.deviate()), far_off);
    }

    /// Each light is chosen with a probability proportional to its power, and its paths carry its power divided by
    /// that.
    TEST(samplers, lights_are_chosen_by_power_and_none_is_brighter_than_it_is)
    {
        auto s = floor_scene();
        s.rectangle_lights = {tilted, {"small", {-2, 2, 0}, {0.1, 0, 0}, {0, 0, 0.1}, {0, 0.2, 0.1}}};
        s.point_lights = {{"bulb", {2, 1, 0.2}, {1, 2, 3}}, {"spark", {-2, 1, -2}, {0.3, 0, 0}}};
        const dvec3 powers[] = {
            s.rectangle_lights[0].power, s.rectangle_lights[1].power, s.point_lights[0].power, s.point_lights[1].power};
        const dvec3 middles[] = {tilted.corner + 0.5 * (tilted.edge_u + tilted.edge_v), dvec3(-1.95, 2, 0.05),
            s.point_lights[0].position, s.point_lights[1].position};
        double total = 0;
        for (const auto& p : powers)
            total += p.x + p.y + p.z;
        constexpr uint paths = 1u << 20;
        const auto e = emit(s, paths);
        std::array<double, 4> chosen{};
        for (std::size_t i = 0; i < paths; ++i) {
            std::size_t light = 0;
            for (std::size_t l = 1; l < 4; ++l)
                if (glm::distance(e.positions[i], middles[l]) < glm::distance(e.positions[i], middles[light]))
                    light = l;
            ++chosen[light];
            const double probability = (powers[light].x + powers[light].y + powers[light].z) / total;
            for (int c = 0; c < 3; ++c) {
                const double expected = powers[light][c] / probability;
                ASSERT_NEAR(static_cast<double>(e.powers[i][c]), expected, 1e-6 * expected) << "light " << light;
            }
        }
        for (std::size_t l = 0; l < 4; ++l) {
            const double p = (powers[l].x + powers[l].y + powers[l].z) / total;
            EXPECT_LE(std::abs(chosen[l] - paths * p), far_off * std::sqrt(paths * p * (1 - p))) << "light " << l;
        }
    }

    bool before(const glm::vec4& a, const glm::vec4& b) { return std::memcmp(&a, &b, sizeof a) < 0; }

    /// Paths are traced in batches. Whatever the batches, each path is traced once: no two photons of a scene without
    /// symmetry are the same.
    TEST(samplers, no_path_is_traced_twice)
    {
        auto s = integrating_sphere(dvec3(0.2));
        s.point_lights[0].position = {0.3, 0.1, -0.2};
        serial_backend b;
        const auto device = upload_scene(b, s);
        const auto t = trace_photons(b, device, s.render);
        ASSERT_GT(t.emitted, 4u * 32768u) << "several batches";
        auto photons = b.download(t.photons.positions);
        std::sort(photons.begin(), photons.end(), before);
        EXPECT_EQ(std::adjacent_find(photons.begin(), photons.end(),
                      [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; }),
            photons.end());

        // A later batch has the paths of its own numbers.
        const auto all = emit(s, 5000), some = emit(s, 1000, 4000);
        EXPECT_TRUE(std::equal(some.directions.begin(), some.directions.end(), all.directions.begin() + 4000));
    }

    // Eye rays.

    /// Where in the picture rays pass, in pixels from the top left corner.
    std::vector<glm::dvec2> eye_rays(const camera& c, const render_settings& settings, uint sample)
    {
        const dvec3 forward = glm::normalize(c.look_at - c.position), right = glm::normalize(glm::cross(forward, c.up)),
                    up = glm::cross(right, forward);
        const double pixel = 2 * std::tan(c.vertical_fov * pi / 360) / settings.output.height;
        std::vector<glm::dvec2> places;
        for (const auto& way : eye_directions(c, settings, sample)) {
            const dvec3 d{glm::vec3(way)};
            const double depth = glm::dot(d, forward);
            places.emplace_back(0.5 * settings.output.width + glm::dot(d, right) / depth / pixel,
                0.5 * settings.output.height - glm::dot(d, up) / depth / pixel);
        }
        return places;
    }
    const camera oblique{{1, 2, 3}, {0.2, 0.5, -1}, {0.1, 1, 0.2}, 50};

    TEST(samplers, the_only_eye_ray_passes_through_the_middle_of_its_pixel)
    {
        const render_settings settings{.view = {.spp = 1}, .output = {.width = 60, .height = 40}};
        const auto rays = eye_rays(oblique, settings, 0);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            EXPECT_NEAR(rays[i].x, static_cast<double>(i % 60) + 0.5, 1e-4);
            EXPECT_NEAR(rays[i].y, static_cast<double>(i / 60) + 0.5, 1e-4);
        }
    }

    /// Each of a pixel's eye rays is uniform in a stratum of its own.
    TEST(samplers, eye_rays_are_uniform_in_their_strata)
    {
        for (const uint spp : {2u, 4u, 6u, 9u, 16u}) {
            render_settings settings{.view = {.spp = spp}, .output = {.width = 128, .height = 128}};
            even_bins<2> in_pixel(32), in_stratum(16);
            const auto strata = detail::strata_of(spp);
            std::vector<std::set<std::size_t>> hit(128 * 128), columns(128 * 128), rows(128 * 128);
            for (uint sample = 0; sample < spp; ++sample) {
                const auto rays = eye_rays(oblique, settings, sample);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const double x = rays[i].x - static_cast<double>(i % 128),
                                 y = rays[i].y - static_cast<double>(i / 128);
                    in_pixel.add({x, y});
                    const double column = x * strata.x, row = y * strata.y;
                    in_stratum.add({column - std::floor(column), row - std::floor(row)});
                    // Rounding may carry a ray over its stratum's edge.
                    if (std::abs(column - std::round(column)) > 1e-3 && std::abs(row - std::round(row)) > 1e-3) {
                        const auto stratum = static_cast<std::size_t>(std::floor(row) * 100 + std::floor(column));
                        EXPECT_TRUE(hit[i].insert(stratum).second) << "a second ray in a stratum of pixel " << i;
                    }
                    const auto once = [&](std::set<std::size_t>& taken, double at) {
                        if (std::abs(at - std::round(at)) > 1e-3 * spp) {
                            EXPECT_TRUE(taken.insert(static_cast<std::size_t>(at)).second)
                                << "a second ray in an n-th of the width or height of pixel " << i;
                        }
                    };
                    once(columns[i], x * spp);
                    once(rows[i], y * spp);
                }
            }
            EXPECT_LE(std::abs(in_stratum.deviate()), far_off) << spp;
            EXPECT_LE(in_pixel.deviate(), far_off) << spp;
        }
    }

    /// With a tent a ray's place has the density 1 - |x| about the pixel's middle, along both axes, and the shares of
    /// the tent up to it are strata as places in a pixel are.
    TEST(samplers, eye_rays_are_distributed_as_a_tent)
    {
        const auto share = [](double x) { // of the tent up to x, from its middle
            return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
        };
        for (const uint spp : {2u, 4u, 9u}) {
            const render_settings settings{
                .view = {.spp = spp, .filter = pixel_filter::tent}, .output = {.width = 128, .height = 128}};
            even_bins<2> in_tent(32);
            std::vector<std::set<std::size_t>> columns(128 * 128);
            for (uint sample = 0; sample < spp; ++sample) {
                const auto rays = eye_rays(oblique, settings, sample);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const double x = rays[i].x - static_cast<double>(i % 128) - 0.5,
                                 y = rays[i].y - static_cast<double>(i / 128) - 0.5;
                    ASSERT_LE(std::max(std::abs(x), std::abs(y)), 1.001);
                    in_tent.add({std::clamp(share(x), 0.0, 1 - 1e-9), std::clamp(share(y), 0.0, 1 - 1e-9)});
                    const double column = share(x) * spp;
                    if (std::abs(column - std::round(column)) > 2e-3 * spp) {
                        EXPECT_TRUE(columns[i].insert(static_cast<std::size_t>(column)).second) << i;
                    }
                }
            }
            EXPECT_LE(in_tent.deviate(), far_off) << spp;
        }
    }

    TEST(samplers, eye_rays_of_other_pixels_samples_and_seeds_are_independent)
    {
        render_settings settings{.view = {.spp = 9}, .output = {.width = 256, .height = 128}};
        const auto offsets = [&](uint seed, uint sample) {
            auto with = settings;
            with.seed = seed;
            std::vector<double> x;
            for (const auto& r : eye_rays(oblique, with, sample))
                x.push_back(3 * r.x - std::floor(3 * r.x));
            return x;
        };
        const auto first = offsets(1, 0);
        const double limit = far_off / std::sqrt(static_cast<double>(first.size()));
        auto shifted = first;
        std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
        EXPECT_LE(std::abs(correlation(first, shifted)), limit) << "neighbouring pixels";
        std::rotate(shifted.begin(), shifted.begin() + 255, shifted.end());
        EXPECT_LE(std::abs(correlation(first, shifted)), limit) << "pixels of neighbouring rows";
        EXPECT_LE(std::abs(correlation(first, offsets(1, 1))), limit) << "samples of another column";
        EXPECT_LE(std::abs(correlation(first, offsets(1, 4))), limit) << "samples of another column and row";
        EXPECT_LE(std::abs(correlation(first, offsets(2, 0))), limit) << "seeds";
    }

    /// The settings of a pass, as settings_of_pass makes them but with seeds that are easy to read.
    render_settings in_pass(render_settings s, uint pass)
    {
        s.output.passes = 64;
        s.pass = {pass, pass * 1000};
        s.seed ^= s.pass.seed_change;
        return s;
    }

    /// How often places in the unit square are in each of `across` columns of the rows that 64 such rectangles have; -1
    /// if one of them is near an edge of its rectangle, where rounding may have moved it.
    std::vector<int> in_rectangles(const std::vector<glm::dvec2>& places, std::size_t across)
    {
        std::vector<int> hits(places.size());
        for (const auto& p : places) {
            const double x = p.x * static_cast<double>(across), y = p.y * static_cast<double>(places.size() / across);
            if (std::abs(x - std::round(x)) < 0.01 || std::abs(y - std::round(y)) < 0.01)
                return {};
            ++hits.at(static_cast<std::size_t>(x) * (places.size() / across) + static_cast<std::size_t>(y));
        }
        return hits;
    }

    /// The rays of several passes are spread as those of one would be: of 64, each of 64 equal rectangles of a pixel
    /// has one, whatever their proportions. Of 9 rays per pass the first stratum has so many of its own.
    TEST(samplers, eye_rays_are_stratified_over_passes)
    {
        for (const uint spp : {1u, 4u, 9u, 16u}) {
            SCOPED_TRACE(spp);
            const render_settings settings{.view = {.spp = spp}, .output = {.width = 16, .height = 8}};
            const uint of_pass = spp == 9 ? 1 : spp, passes = 64 / of_pass;
            const double scale = spp == 9 ? 3 : 1;
            std::vector<std::vector<glm::dvec2>> places(128);
            for (uint pass = passes; pass < 2 * passes; ++pass)
                for (uint sample = 0; sample < of_pass; ++sample) {
                    const auto rays = eye_rays(oblique, in_pass(settings, pass), sample);
                    for (std::size_t i = 0; i < rays.size(); ++i)
                        places[i].push_back(
                            scale * (rays[i] - glm::dvec2(static_cast<double>(i % 16), static_cast<double>(i / 16))));
                }
            std::size_t seen = 0;
            for (const auto& of_pixel : places)
                for (const std::size_t across : {1u, 2u, 4u, 8u, 16u, 32u, 64u})
                    if (const auto hits = in_rectangles(of_pixel, across); !hits.empty()) {
                        ASSERT_EQ(hits, std::vector<int>(64, 1)) << across;
                        ++seen;
                    }
            EXPECT_GT(seen, 30u);
        }
    }

    // Shadow rays.

    /// Irradiance of direct light at one point of the floor, estimated by each of many pixels.
    std::vector<double> estimates(
        const scene& s, const dvec3& point, const render_settings& settings, uint ray, std::size_t pixels)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        detail::eye_hits<serial_backend> hits(b, pixels);
        hits.points = b.upload(std::span<const glm::vec4>(
            std::vector<glm::vec4>(pixels, glm::vec4(glm::vec3(point - device.layout.center), 1.0f))));
        hits.surfaces
            = b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(pixels, glm::vec4(0.0f, 1.0f, 0.0f, 0.0f))));
        auto light = b.make<glm::vec4>(pixels);
        detail::direct_light(b, device, {settings, ray, launch(pixels)}, hits, light);
        std::vector<double> out;
        for (const auto& e : b.download(light))
            out.push_back(static_cast<double>(e.x));
        return out;
    }
    render_settings with_samples(render_settings settings, uint samples, uint seed)
    {
        settings.view.light_samples = samples;
        settings.seed = seed;
        return settings;
    }
    std::vector<double> estimates(const scene& s, const dvec3& point, uint samples, uint seed = 1)
    {
        return estimates(s, point, with_samples(s.render, samples, seed), 0, 16384);
    }

    struct moments {
        double mean = 0, variance = 0;
    };
    moments moments_of(const std::vector<double>& x)
    {
        moments m;
        for (const double v : x)
            m.mean += v / static_cast<double>(x.size());
        for (const double v : x)
            m.variance += (v - m.mean) * (v - m.mean) / static_cast<double>(x.size() - 1);
        return m;
    }

    /// Mean and variance of an estimate with one uniform sample in each stratum, by quadrature in double. The normal of
    /// the surface is +y.
    moments expected_of(const rectangle_light& l, const dvec3& point, glm::uvec2 strata)
    {
        constexpr int steps = 48;
        const double n = static_cast<double>(strata.x) * strata.y;
        const dvec3 normal = glm::normalize(glm::cross(l.edge_u, l.edge_v));
        moments m;
        for (uint row = 0; row < strata.y; ++row)
            for (uint column = 0; column < strata.x; ++column) {
                double first = 0, second = 0;
                for (int i = 0; i < steps; ++i)
                    for (int j = 0; j < steps; ++j) {
                        const double u = (column + (i + 0.5) / steps) / strata.x,
                                     v = (row + (j + 0.5) / steps) / strata.y;
                        const dvec3 to = l.corner + u * l.edge_u + v * l.edge_v - point, d = glm::normalize(to);
                        const double f = l.power.x / pi * d.y * -glm::dot(d, normal) / glm::dot(to, to);
                        first += f / (steps * steps);
                        second += f * f / (steps * steps);
                    }
                m.mean += first / n;
                m.variance += (second - first * first) / (n * n);
            }
        return m;
    }

    /// A lamp above the floor, at an angle, so that its samples differ.
    scene lamp_over_floor()
    {
        auto s = floor_scene();
        s.rectangle_lights = {{"lamp", {0.4, 1.5, -0.3}, {0.5, 0.1, 0}, {-0.01, 0.05, 0.6}, dvec3(3)}};
        auto& l = s.rectangle_lights[0]; // shines down, edges at right angles
        l.edge_v -= glm::dot(l.edge_v, l.edge_u) / glm::dot(l.edge_u, l.edge_u) * l.edge_u;
        if (glm::cross(l.edge_u, l.edge_v).y > 0)
            std::swap(l.edge_u, l.edge_v);
        return s;
    }

    /// The mean is the known irradiance, and the variance that of independent samples, one in each stratum. If strata
    /// shared their jitter, or there were no strata, it would be several times as large.
    TEST(samplers, shadow_rays_are_independent_in_each_stratum_of_a_lamp)
    {
        const auto s = lamp_over_floor();
        const dvec3 point(-0.2, 0, 0.3);
        for (const uint samples : {4u, 6u, 16u, 32u}) {
            const auto known = expected_of(s.rectangle_lights[0], point, detail::strata_of(samples));
            const auto e = moments_of(estimates(s, point, samples));
            const double pixels = 16384;
            EXPECT_NEAR(e.mean, known.mean, far_off * std::sqrt(known.variance / pixels) + 1e-5 * known.mean)
                << samples;
            // The variance of a variance is (kurtosis - 1) V^2 / n, and these distributions have no tails.
            EXPECT_NEAR(e.variance / known.variance, 1, far_off * std::sqrt(2 / pixels)) << samples;
        }
    }

    TEST(samplers, shadow_rays_of_other_pixels_lights_and_seeds_are_independent)
    {
        const auto s = lamp_over_floor();
        const dvec3 point(-0.2, 0, 0.3);
        const auto first = estimates(s, point, 4);
        const double limit = far_off / std::sqrt(static_cast<double>(first.size()));
        auto shifted = first;
        std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
        EXPECT_LE(std::abs(correlation(first, shifted)), limit) << "neighbouring pixels";
        EXPECT_LE(std::abs(correlation(first, estimates(s, point, 4, 2))), limit) << "seeds";
        // Two lamps in the same place: variances add. With the same jitter the variance would be four times one's.
        auto two = s;
        two.rectangle_lights.push_back(s.rectangle_lights[0]);
        const auto known = expected_of(s.rectangle_lights[0], point, detail::strata_of(4));
        EXPECT_NEAR(
            moments_of(estimates(two, point, 4)).variance / (2 * known.variance), 1, far_off * std::sqrt(2.0 / 16384));
    }

    /// The samples of several eye rays and passes are spread over each stratum of a lamp: the variance of the mean of
    /// 16 is far below a sixteenth, and how they are divided among passes does not matter. It is so for a lamp as it is
    /// (direct_light.glsl), and for all kinds of lights together (shadow_ray.glsl).
    TEST(samplers, shadow_rays_are_stratified_over_eye_rays_and_passes)
    {
        auto lamp = lamp_over_floor(), lamps = lamp;
        lamps.sphere_lights = {{"ball", {-0.6, 1.2, 0.4}, 0.3, dvec3(2)}};
        const dvec3 point(-0.2, 0, 0.3);
        for (const auto& s : {lamp, lamps}) {
            const auto mean_of = [&](uint passes, uint spp) {
                std::vector<double> mean(4096);
                for (uint pass = 0; pass < passes; ++pass)
                    for (uint ray = 0; ray < spp; ++ray) {
                        auto settings = with_samples(in_pass(s.render, pass), 4, 1 ^ (pass * 1000));
                        settings.view.spp = spp;
                        const auto e = estimates(s, point, settings, ray, mean.size());
                        for (std::size_t i = 0; i < mean.size(); ++i)
                            mean[i] += e[i] / (passes * spp);
                    }
                return mean;
            };
            const auto alone = mean_of(1, 1), passes = mean_of(16, 1), mixed = mean_of(4, 4);
            EXPECT_LT(moments_of(passes).variance, 0.2 * moments_of(alone).variance / 16);
            EXPECT_NEAR(moments_of(passes).mean / moments_of(alone).mean, 1, 0.01);
            for (std::size_t i = 0; i < passes.size(); ++i)
                ASSERT_NEAR(passes[i], mixed[i], 1e-6 * passes[i]) << i;
        }
    }

    /// A lamp of which something covers a half, the nearer one. For a final gather a lamp that is so near is taken
    /// whole, and seen or not by its sample; for paths the mean is exact.
    TEST(samplers, paths_see_the_part_of_a_lamp_that_is_not_covered)
    {
        auto s = floor_scene();
        s.rectangle_lights = {{"lamp", {-1, 1, -0.5}, {2, 0, 0}, {0, 0, 1}, dvec3(3)}};
        s.polygons.push_back({{{-1.5, 0.99, -2}, {0, 0.99, -2}, {0, 0.99, 2}, {-1.5, 0.99, 2}}, 0});
        const dvec3 point(-0.9, 0, 0);
        // Quadrature over the lamp: what covers it hides x < 0, up to the parallax over 1 cm.
        double known = 0;
        constexpr int steps = 1000;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const dvec3 at(-1 + 2 * (i + 0.5) / steps, 1, -0.5 + (j + 0.5) / steps), to = at - point;
                if ((point + 0.99 * to).x > 0)
                    known += 3 / pi / std::pow(glm::dot(to, to), 2) / (steps * steps);
            }
        auto settings = with_samples(s.render, 1, 1);
        const auto mean = [&](indirect_kind kind) {
            settings.estimate.indirect = kind;
            return moments_of(estimates(s, point, settings, 0, 65536));
        };
        const auto exact = mean(indirect_kind::paths), whole = mean(indirect_kind::gather);
        EXPECT_NEAR(exact.mean, known, far_off * std::sqrt(exact.variance / 65536));
        EXPECT_GT(std::abs(whole.mean - known), 2 * far_off * std::sqrt(whole.variance / 65536));
    }

    /// The first rays of a final gather are stratified over eye rays and passes, each in its stratum of the hemisphere.
    TEST(samplers, gather_rays_are_stratified_over_eye_rays_and_passes)
    {
        constexpr uint pixels = 64, rays = 4;
        serial_backend b;
        const auto device = upload_scene(b, lamp_over_floor());
        const std::vector<glm::vec4> ends(pixels, {0, 0, 0, 1}), up(pixels, {0, 0, 1, 0});
        const auto points = b.upload(std::span<const glm::vec4>(ends)),
                   normals = b.upload(std::span<const glm::vec4>(up));
        std::size_t seen = 0;
        for (uint number = 0; number < rays; ++number) {
            std::vector<std::vector<glm::dvec2>> places(pixels);
            for (uint nth = 64; nth < 128; ++nth) {
                detail::eye_hits<serial_backend> hits(b, pixels);
                auto branches = b.make<uint>(pixels);
                b.run<kernels::final_gather_ray>({pixels, 0u, device.layout.features},
                    {.strata = {2, 2}, .number = number, .first = 0, .first_pixel = 0, .nth = nth, .seed = 3},
                    reads(device.records, points, normals),
                    writes(hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, branches));
                const auto directions = b.download(hits.directions);
                const auto axes = kernels::basis_about(glm::vec3(0, 0, 1));
                for (uint i = 0; i < pixels; ++i) {
                    const dvec3 d{glm::vec3(directions[i])};
                    const glm::dvec2 at(1 - d.z * d.z, turn(glm::dot(d, dvec3(axes.v)), glm::dot(d, dvec3(axes.u))));
                    places[i].push_back(2.0 * at - glm::dvec2(number % 2, number / 2));
                }
            }
            for (const auto& of_pixel : places)
                for (const std::size_t across : {4u, 8u, 16u})
                    if (const auto hits = in_rectangles(of_pixel, across); !hits.empty()) {
                        ASSERT_EQ(hits, std::vector<int>(64, 1)) << across;
                        ++seen;
                    }
        }
        EXPECT_GT(seen, 30u);
    }

    TEST(samplers, a_bulbs_direct_light_is_the_inverse_square_law)
    {
        auto s = floor_scene();
        s.point_lights = {{"bulb", {0.5, 1.5, -0.25}, dvec3(7)}};
        for (const auto& point : {dvec3(0.5, 0, -0.25), dvec3(-1, 0, 1), dvec3(2.5, 0, 2.5)}) {
            const dvec3 to = s.point_lights[0].position - point;
            const double known = 7 / (4 * pi) * to.y / std::pow(glm::length(to), 3);
            EXPECT_NEAR(estimates(s, point, with_samples(s.render, 1, 1), 0, 1)[0], known, 2e-6 * known);
        }
    }

} // namespace
} // namespace photongrid::testing
