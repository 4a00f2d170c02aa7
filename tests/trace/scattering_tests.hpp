// What a surface does to light, compared with Fresnel's equations in long double: how many photons it absorbs, reflects
// and refracts, in which directions, what power they carry on, and the throughput of eye rays.
#pragma once

#include "sampler_tests.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/trace/eye_rays.hpp>
#include <photongrid/trace/trace_photons.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace photongrid::testing {
namespace {

    constexpr double index_of_glass = 1.5;

    /// A ball of radius 1 around the origin, of one of these materials, in a white ball of radius 10.
    const std::vector<material> materials{{"mirror", material_kind::mirror, {0.8, 0.8, 0.8}},
        {"metal", material_kind::metal, {0.9, 0.6, 0.3}},
        {"glass", material_kind::glass, {0.3, 0.95, 0.6}, index_of_glass}};
    scene ball_of(const material& m, const dvec3& bulb)
    {
        scene s;
        s.name = "ball";
        s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, m};
        s.spheres = {{dvec3(0), 10, 0}, {dvec3(0), 1, 1}};
        s.point_lights = {{"bulb", bulb, dvec3(6, 5, 4)}};
        return s;
    }

    /// Light that arrives in direction `d` at a surface with this outward normal.
    struct incidence {
        dvec3 d, normal; ///< the normal towards the side that the light comes from
        double from = 1, to = 1;
        double cosine = 1;

        incidence(const dvec3& direction, const dvec3& outward, const material& m) : d(direction), normal(outward)
        {
            const bool outside = glm::dot(d, outward) < 0;
            if (!outside)
                normal = -outward;
            if (m.kind == material_kind::glass)
                (outside ? to : from) = m.index_of_refraction;
            if (m.kind == material_kind::plastic) // its coat is on both sides
                to = m.index_of_refraction;
            cosine = -glm::dot(d, normal);
        }
        /// The reflected share of unpolarized light (Fresnel).
        double reflectance() const
        {
            const long double ci = static_cast<long double>(cosine), a = static_cast<long double>(from),
                              b = static_cast<long double>(to), st2 = a * a / (b * b) * (1 - ci * ci);
            if (st2 >= 1)
                return 1;
            const long double ct = std::sqrt(1 - st2), s = (a * ci - b * ct) / (a * ci + b * ct),
                              p = (a * ct - b * ci) / (a * ct + b * ci);
            return static_cast<double>((s * s + p * p) / 2);
        }
        dvec3 reflected() const { return d + 2 * cosine * normal; }
        /// Of an eye ray that is refracted: radiance divided by the index squared is constant.
        double radiance_scale() const { return from * from / (to * to); }
        /// Snell's law.
        dvec3 refracted() const
        {
            const dvec3 along = from / to * (d + cosine * normal);
            return along - std::sqrt(1 - glm::dot(along, along)) * normal;
        }
    };

    double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

    bool close(const dvec3& a, const dvec3& b, double limit) { return glm::length(a - b) <= limit; }

    /// Follows every light path, and compares its next step with what the last surface should do.
    void check_photons(const material& m, const dvec3& bulb)
    {
        SCOPED_TRACE(m.name);
        const auto s = ball_of(m, bulb);
        constexpr uint n = 1u << 17, frames = 7;
        serial_backend b;
        const auto device = upload_scene(b, s);
        auto settings = s.render;
        settings.map.photon_depth = frames - 1;
        detail::photon_frames<serial_backend> f(b, std::size_t{n} * frames);
        trace_batch(b, device, f, {n}, settings);
        const auto positions = b.download(f.positions), powers = b.download(f.powers),
                   directions = b.download(f.directions);

        double hits = 0, survivors = 0, reflections = 0, expected = 0, variance = 0;
        for (std::size_t path = 0; path < n; ++path) {
            dvec3 power = s.point_lights[0].power; // of the only light, chosen with probability 1
            for (std::size_t frame = 1; frame < frames; ++frame) {
                const std::size_t at = frame * n + path;
                const auto event = positions[at];
                ASSERT_NE(kernels::event_kind(event), kernels::NO_SURFACE) << "the white ball is closed";
                ASSERT_TRUE(close(dvec3(glm::vec3(powers[at])), power, 1e-5 * glm::length(power)))
                    << "power of path " << path << " in frame " << frame;
                const bool specular = kernels::event_kind(event) == kernels::SPECULAR_SURFACE;
                const dvec3 colour = specular ? m.reflectance : dvec3(0.5);
                power *= colour / largest(colour);
                const bool goes_on = kernels::event_end(event) == kernels::GOES_ON;
                if (specular)
                    ++hits;
                if (!goes_on) {
                    survivors += specular && kernels::event_end(event) == kernels::CUT_OFF ? 1 : 0;
                    break;
                }
                if (!specular)
                    continue;
                ++survivors;
                const dvec3 outward = glm::normalize(dvec3(glm::vec3(event)) + device.layout.center);
                const incidence in(dvec3(glm::vec3(directions[at])), outward, m);
                const dvec3 next(glm::vec3(directions[at + n]));
                const double share = m.kind == material_kind::glass ? in.reflectance() : 1;
                const bool reflected = glm::dot(next, in.normal) > 0;
                ASSERT_TRUE(close(next, reflected ? in.reflected() : in.refracted(), 1e-3 / (in.cosine + 0.03)))
                    << "direction of path " << path << " in frame " << frame;
                reflections += reflected ? 1 : 0;
                expected += share;
                variance += share * (1 - share);
            }
        }
        EXPECT_GT(hits, 2000);
        const double p = largest(m.reflectance);
        EXPECT_LE(std::abs(survivors - hits * p), far_off * std::sqrt(hits * p * (1 - p))) << "of " << hits;
        EXPECT_LE(std::abs(reflections - expected), far_off * std::sqrt(variance) + 0.5) << "of " << survivors;
    }

    TEST(scattering, photons_are_absorbed_reflected_and_refracted_as_optics_says)
    {
        for (const auto& m : materials) {
            check_photons(m, {1.5, 0.5, 1});
            if (m.kind == material_kind::glass)
                check_photons(m, {0.5, 0.3, 0.6}); // from inside, with total reflection
        }
        // Most photons end here: what a survivor does next must not depend on why it survived.
        check_photons({"dark glass", material_kind::glass, {0.2, 0.4, 0.1}, index_of_glass}, {1.5, 0.5, 1});
    }

    /// How eye rays take one step.
    struct step_settings {
        uint branch = 0, splits = 0;
        float throughput = 1;
        uint nth = 0;
    };

    /// One step of eye rays from these origins in these directions.
    detail::eye_hits<serial_backend> hits_of_step(serial_backend& b, const device_scene<serial_backend>& device,
        const std::vector<dvec3>& origins, const std::vector<dvec3>& ways, const step_settings& how = {})
    {
        const std::size_t n = origins.size();
        detail::eye_hits<serial_backend> hits(b, n);
        std::vector<glm::vec4> points, directions;
        for (std::size_t i = 0; i < n; ++i) {
            points.emplace_back(glm::vec3(origins[i] - device.layout.center), 0.0f);
            directions.emplace_back(glm::vec3(ways[i]), 0.0f);
        }
        hits.points = b.upload(std::span<const glm::vec4>(points));
        hits.directions = b.upload(std::span<const glm::vec4>(directions));
        hits.throughputs = b.upload(
            std::span<const glm::vec4>(std::vector<glm::vec4>(n, glm::vec4(glm::vec3(how.throughput), 0.0f))));
        auto branches = b.make<uint>(n);
        const detail::mesh_hits<serial_backend> none(b, device, 0);
        b.run<kernels::eye_bounce>({n, 0u, device.layout.features},
            {.branch = how.branch,
                .splits = how.splits,
                .depth = 8,
                .light_samples = 0,
                .nth = how.nth,
                .seed = 1,
                .first_pixel = 0,
                .first = 0},
            reads(device.records, none.places, none.normals, none.shadings, device.environment->texels, none.colors),
            writes(hits.points, hits.directions, hits.throughputs, hits.surfaces, hits.emissions, branches));
        return hits;
    }

    struct eye_step {
        std::vector<glm::vec4> points, directions, throughputs;
    };
    eye_step step(const scene& s, const std::vector<dvec3>& origins, const std::vector<dvec3>& ways, uint branch,
        uint splits, float throughput = 1, uint nth = 0)
    {
        serial_backend b;
        const auto hits = hits_of_step(b, upload_scene(b, s), origins, ways, {branch, splits, throughput, nth});
        return {b.download(hits.points), b.download(hits.directions), b.download(hits.throughputs)};
    }

    /// Rays to random points of the ball, from a distance from its centre.
    void aim(std::vector<dvec3>& origins, std::vector<dvec3>& ways, std::vector<dvec3>& outwards, double distance)
    {
        std::mt19937_64 random(distance > 1 ? 1 : 2);
        std::uniform_real_distribution<double> u(-1, 1);
        const auto unit = [&] {
            for (;;) {
                const dvec3 v(u(random), u(random), u(random));
                if (glm::length(v) > 0.1 && glm::length(v) < 1)
                    return glm::normalize(v);
            }
        };
        while (origins.size() < 20000) {
            const dvec3 from = distance * unit(), to = unit(), d = glm::normalize(to - from);
            if (distance > 1 && glm::dot(d, to) > -0.02)
                continue; // it would hit the other side first
            origins.push_back(from);
            ways.push_back(d);
            outwards.push_back(to);
        }
    }

    TEST(scattering, eye_rays_have_the_throughput_of_their_branch)
    {
        for (const auto& m : materials)
            for (const double distance : {3.0, 0.7}) {
                if (distance < 1 && m.kind != material_kind::glass)
                    continue;
                SCOPED_TRACE(m.name + " from " + std::to_string(distance));
                std::vector<dvec3> origins, ways, outwards;
                aim(origins, ways, outwards, distance);
                const auto s = ball_of(m, {1.5, 0.5, 1});
                for (const uint branch : {0u, 1u}) {
                    const auto e = step(s, origins, ways, branch, 2);
                    for (std::size_t i = 0; i < origins.size(); ++i) {
                        const incidence in(ways[i], outwards[i], m);
                        double share = 1;
                        bool reflected = true;
                        if (m.kind == material_kind::glass) {
                            reflected = branch == 1;
                            share = reflected ? in.reflectance() : (1 - in.reflectance()) * in.radiance_scale();
                        }
                        if (share == 0) {
                            ASSERT_EQ(e.points[i].w, -1.0f) << "a branch without light ends";
                            continue;
                        }
                        // Near the critical angle and near grazing, rounding changes the share by its square root.
                        ASSERT_TRUE(close(dvec3(glm::vec3(e.throughputs[i])), share * m.reflectance, 2e-3)) << i;
                        ASSERT_TRUE(close(dvec3(glm::vec3(e.directions[i])),
                            reflected ? in.reflected() : in.refracted(), 1e-3 / (in.cosine + 0.03)))
                            << i;
                    }
                }
            }
    }

    /// After the last split a random number chooses the branch, with Fresnel's probability, at full throughput.
    TEST(scattering, eye_rays_without_splits_choose_by_fresnel)
    {
        const auto& m = materials[2];
        for (const double distance : {3.0, 0.7}) {
            std::vector<dvec3> origins, ways, outwards;
            aim(origins, ways, outwards, distance);
            const auto e = step(ball_of(m, {1.5, 0.5, 1}), origins, ways, 0, 0);
            double reflections = 0, expected = 0, variance = 0;
            for (std::size_t i = 0; i < origins.size(); ++i) {
                const incidence in(ways[i], outwards[i], m);
                const double share = in.reflectance();
                const bool reflected = glm::dot(dvec3(glm::vec3(e.directions[i])), in.normal) > 0;
                reflections += reflected ? 1 : 0;
                expected += share;
                variance += share * (1 - share);
                const double scale = reflected ? 1 : in.radiance_scale();
                ASSERT_TRUE(close(dvec3(glm::vec3(e.throughputs[i])), scale * m.reflectance, 1e-6)) << i;
            }
            EXPECT_LE(std::abs(reflections - expected), far_off * std::sqrt(variance)) << distance;
        }
    }

    /// The rarer choice of a faint ray is less rare, and counts for less: the mean throughput of each is Fresnel's
    /// share, and none is over four times its share.
    TEST(scattering, faint_eye_rays_choose_rare_branches_more_often)
    {
        const auto& m = materials[2];
        constexpr float faint = 0.04f;
        for (const double distance : {3.0, 0.7}) {
            const double inside = distance < 1 ? m.index_of_refraction * m.index_of_refraction : 1,
                         least = 0.25 * (1 - double{faint} * inside); // radiance within glass is larger
            std::vector<dvec3> origins, ways, outwards;
            aim(origins, ways, outwards, distance);
            const auto e = step(ball_of(m, {1.5, 0.5, 1}), origins, ways, 0, 0, faint);
            double reflections = 0, expected = 0, variance = 0;
            for (std::size_t i = 0; i < origins.size(); ++i) {
                const incidence in(ways[i], outwards[i], m);
                const double share = in.reflectance();
                const double p = share < 1 ? std::clamp(share, least, 1 - least) : 1;
                const bool reflected = glm::dot(dvec3(glm::vec3(e.directions[i])), in.normal) > 0;
                reflections += reflected ? 1 : 0;
                expected += p;
                variance += p * (1 - p);
                const double counts = reflected ? share / p : (1 - share) / (1 - p) * in.radiance_scale();
                ASSERT_TRUE(close(
                    dvec3(glm::vec3(e.throughputs[i])), double{faint} * counts * m.reflectance, 2e-3 * double{faint}))
                    << i;
            }
            EXPECT_LE(std::abs(reflections - expected), far_off * std::sqrt(variance)) << distance;
        }
    }

    /// The eye rays of a pixel share out the branches: of n rays, n p or a ray more or less are reflected.
    TEST(scattering, eye_rays_of_a_pixel_choose_branches_by_strata)
    {
        const auto& m = materials[2];
        constexpr uint n = 4;
        std::vector<dvec3> origins, ways, outwards;
        aim(origins, ways, outwards, 0.7);
        std::vector<double> reflections(origins.size());
        for (uint sample = 0; sample < n; ++sample) {
            const auto e = step(ball_of(m, {1.5, 0.5, 1}), origins, ways, 0, 0, 1, sample);
            for (std::size_t i = 0; i < origins.size(); ++i)
                reflections[i]
                    += glm::dot(dvec3(glm::vec3(e.directions[i])), incidence(ways[i], outwards[i], m).normal) > 0;
        }
        for (std::size_t i = 0; i < origins.size(); ++i) {
            const double p = incidence(ways[i], outwards[i], m).reflectance();
            ASSERT_GE(reflections[i], std::floor(n * p - 1e-3)) << i << ": " << p;
            ASSERT_LE(reflections[i], std::ceil(n * p + 1e-3)) << i << ": " << p;
        }
    }

} // namespace
} // namespace photongrid::testing
