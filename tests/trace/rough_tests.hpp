// Rough metal, glass and coats, compared with their definition: facets in double, drawn evenly by the distribution of
// normals, each of which reflects and refracts as a smooth surface does. No formula for a density of directions is
// used.
#pragma once

#include "scattering_tests.hpp"

namespace photongrid::testing {
namespace {

    /// The share of facets that no other hides (Smith), for GGX.
    double seen_share(double cosine, double alpha)
    {
        const double tangent = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
        return 2 / (1 + std::hypot(1, alpha * tangent));
    }

    /// The unit vector at an angle to `axis`, turned about it.
    dvec3 turned_off(const dvec3& axis, double angle, double turn)
    {
        const dvec3 x = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
        return std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * x + std::sin(turn) * glm::cross(axis, x));
    }

    /// Bins of directions about a lobe: narrow ones in its middle, wider ones outside.
    struct lobe_bins {
        static constexpr std::size_t rings = 10, sectors = 8, all = rings * sectors;
        dvec3 axis;
        double width; ///< radians

        /// For a number of rings, or a part of one.
        double angle_of_ring(double r) const
        {
            const double part = r / rings * last();
            return width * part / (1 - part);
        }
        double last() const { return pi / (pi + width); }
        std::size_t at(const dvec3& d) const
        {
            const double angle = std::atan2(glm::length(glm::cross(axis, d)), glm::dot(axis, d));
            const dvec3 x = turned_off(axis, pi / 2, 0), y = glm::cross(axis, x);
            const double turn = std::atan2(glm::dot(d, y), glm::dot(d, x)) / (2 * pi);
            std::size_t ring = 0;
            while (ring + 1 < rings && angle >= angle_of_ring(double(ring + 1)))
                ++ring;
            const auto sector = static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * sectors);
            return ring * sectors + std::min(sector, sectors - 1);
        }
        /// A direction in a bin for numbers from 0 to 1, and the solid angle that it stands for.
        std::pair<dvec3, double> direction_in(std::size_t bin, double u, double v) const
        {
            const double ring = double(bin / sectors) + u, angle = angle_of_ring(ring),
                         turn = 2 * pi * (double(bin % sectors) + v) / sectors,
                         angle_per_ring = last() / rings * width / std::pow(1 - ring / rings * last(), 2);
            return {turned_off(axis, angle, turn), std::sin(angle) * angle_per_ring * 2 * pi / sectors};
        }
    };

    /// A rough surface that light meets in direction d, and what its facets do.
    struct rough_case {
        material m;
        dvec3 d, outward;
        bool reflected; ///< what is looked at: else refracted light

        incidence whole() const { return {d, outward, m}; }
        lobe_bins bins() const
        {
            const double alpha = m.roughness * m.roughness;
            return {
                glm::normalize(reflected ? whole().reflected() : whole().refracted()), reflected ? alpha : alpha / 2};
        }
        /// Of the light that leaves into each bin: its share, and the mean square of an eye ray's weight.
        struct known_shares {
            std::vector<double> shares = std::vector<double>(lobe_bins::all), squares = shares;
        };
        known_shares known() const
        {
            const double alpha = m.roughness * m.roughness;
            const incidence at = whole();
            const auto b = bins();
            known_shares k;
            constexpr int steps = 500;
            std::mt19937_64 random(1);
            std::uniform_real_distribution<double> jitter;
            for (int i = 0; i < steps; ++i)
                for (int j = 0; j < steps; ++j) {
                    const double u = (i + jitter(random)) / steps,
                                 off_normal = std::atan(alpha * std::sqrt(u / (1 - u)));
                    const dvec3 facet = turned_off(at.normal, off_normal, 2 * pi * (j + jitter(random)) / steps);
                    const double met = -glm::dot(d, facet);
                    if (!(met > 0))
                        continue;
                    const incidence in(d, glm::dot(outward, at.normal) > 0 ? facet : -facet, m);
                    const double f = m.kind == material_kind::metal ? 1 : in.reflectance();
                    if (!reflected && !(f < 1))
                        continue;
                    const dvec3 next = reflected ? in.reflected() : in.refracted();
                    const double cosine = glm::dot(next, at.normal) * (reflected ? 1 : -1);
                    if (!(cosine > 0))
                        continue;
                    // The share of this facet in what is seen along d, and of the light that it sends on.
                    const double seen = met * seen_share(at.cosine, alpha)
                        / (at.cosine * std::cos(off_normal) * double(steps) * steps),
                                 weight = (reflected ? f : 1 - f) * seen_share(cosine, alpha);
                    k.shares[b.at(next)] += seen * weight;
                    k.squares[b.at(next)] += seen * weight * weight;
                }
            return k;
        }
    };

    /// Sums in bins over n samples, compared by chi-square with the mean and the mean square of a sample's part of
    /// each; bins of few samples are taken together. As a standard normal deviate (Wilson and Hilferty 1931).
    double deviate(
        const std::vector<double>& sums, const std::vector<double>& means, const std::vector<double>& squares, double n)
    {
        double chi = 0, k = 0, sum = 0, mean = 0, square = 0;
        for (std::size_t bin = 0; bin < sums.size(); ++bin) {
            sum += sums[bin];
            mean += means[bin];
            square += squares[bin];
            if (n * mean * mean < 25 * square || square == 0)
                continue;
            chi += (sum - n * mean) * (sum - n * mean) / (n * (square - mean * mean));
            ++k;
            sum = mean = square = 0;
        }
        EXPECT_GE(k, 8) << "bins";
        const double v = 2 / (9 * k);
        return (std::cbrt(chi / k) - (1 - v)) / std::sqrt(v);
    }

    std::vector<rough_case> rough_cases()
    {
        std::vector<rough_case> cases;
        const dvec3 outward = glm::normalize(dvec3(0.3, 0.8, -0.5));
        for (const double roughness : {0.05, 0.4, 1.0})
            for (const double cosine : {0.95, 0.3}) {
                const dvec3 from_outside = -turned_off(outward, std::acos(cosine), 1),
                            from_inside = -turned_off(-outward, std::acos(cosine), 1);
                material metal{"metal", material_kind::metal, {0.9, 0.6, 0.3}, 1.5, roughness},
                    glass{"glass", material_kind::glass, {0.3, 0.95, 0.6}, index_of_glass, roughness};
                metal.energy = glass.energy = facet_bounces::single; // several bounces: rebound_tests.hpp
                cases.push_back({metal, from_outside, outward, true});
                const material plastic{"plastic", material_kind::plastic, {0.9, 0.6, 0.3}, index_of_glass, roughness};
                for (const auto& d : {from_outside, from_inside})
                    cases.push_back({plastic, d, outward, true});
                for (const auto& d : {from_outside, from_inside})
                    for (const bool reflected : {true, false})
                        if (reflected || incidence(d, outward, glass).reflectance() < 1)
                            cases.push_back({glass, d, outward, reflected});
            }
        return cases;
    }
    std::string name_of(const rough_case& c)
    {
        return c.m.name + ", roughness " + std::to_string(c.m.roughness) + ", cosine "
            + std::to_string(c.whole().cosine) + (glm::dot(c.d, c.outward) > 0 ? " from inside" : "")
            + (c.reflected ? ", reflected" : ", refracted");
    }

    /// The ball of scattering_tests.hpp under a lamp that rays can find.
    scene rough_ball_of(const material& m)
    {
        auto s = ball_of(m, {});
        s.point_lights.clear();
        s.sphere_lights = {{"globe", {0, 5, 0}, 0.5, dvec3(4)}};
        return s;
    }

    /// Photons that all meet the ball in one direction, a narrow spotlight's: frame n of path p is element n paths + p.
    struct beam {
        std::vector<glm::vec4> positions, directions, powers;

        beam(scene s, const dvec3& outward, const dvec3& d, uint paths)
        {
            s.point_lights.clear();
            s.sphere_lights.clear();
            s.spot_lights = {{.name = "beam",
                .position = outward - 0.4 * d,
                .direction = d,
                .inner_angle = 0.01,
                .outer_angle = 0.02,
                .power = dvec3(1)}};
            serial_backend b;
            const auto device = upload_scene(b, s);
            auto settings = s.render;
            settings.map.photon_depth = 2;
            detail::photon_frames<serial_backend> f(b, std::size_t{paths} * 3);
            trace_batch(b, device, f, {paths}, settings);
            positions = b.download(f.positions);
            directions = b.download(f.directions);
            powers = b.download(f.powers);
        }
    };

    TEST(rough_surfaces, eye_rays_leave_as_facets_reflect_and_refract)
    {
        for (const auto& c : rough_cases()) {
            SCOPED_TRACE(name_of(c));
            constexpr std::size_t n = 1 << 15;
            const std::vector<dvec3> origins(n, c.outward - 0.4 * c.d), ways(n, c.d);
            // Bit 0 of the branch: whether the ray ends here for samples of lights; bit 1: whether it is reflected. Of
            // plastic the other way round.
            const bool coated = c.m.kind == material_kind::plastic;
            const uint reflected = coated ? 1 : c.m.kind == material_kind::glass ? 2 : 0;
            const auto e = step(rough_ball_of(c.m), origins, ways, c.reflected ? reflected : 0, 2);
            const dvec3 colour = coated ? dvec3(1) : c.m.reflectance;
            const auto bins = c.bins();
            const double scale = c.reflected ? 1 : c.whole().radiance_scale();
            std::vector<double> sums(lobe_bins::all);
            for (std::size_t i = 0; i < n; ++i) {
                if (e.points[i].w != 0)
                    continue; // hidden by other facets
                const dvec3 throughput(glm::vec3(e.throughputs[i]));
                const double weight = throughput.y / colour.y / scale;
                EXPECT_LE(weight, 1.0001);
                ASSERT_TRUE(close(throughput, weight * scale * colour, 1e-5)) << i;
                sums[bins.at(dvec3(glm::vec3(e.directions[i])))] += weight;
            }
            const auto known = c.known();
            EXPECT_LE(std::abs(deviate(sums, known.shares, known.squares, double(n))), far_off);
        }
    }

    TEST(rough_surfaces, photons_leave_as_facets_reflect_and_refract)
    {
        for (const auto& c : rough_cases()) {
            SCOPED_TRACE(name_of(c));
            constexpr uint n = 1 << 16;
            auto s = rough_ball_of(c.m);
            s.materials[1].reflectance = dvec3(0.9);
            const bool coated = c.m.kind == material_kind::plastic;
            const auto [positions, directions, powers] = beam(s, c.outward, c.d, n);
            const auto bins = c.bins();
            const incidence at = c.whole();
            std::vector<double> sums(lobe_bins::all);
            for (std::size_t path = 0; path < n; ++path) {
                const bool specular = kernels::event_kind(positions[n + path]) == kernels::SPECULAR_SURFACE;
                ASSERT_TRUE(specular || coated);
                if (!specular)
                    continue; // below the coat
                if (kernels::event_end(positions[n + path]) != kernels::GOES_ON)
                    continue;
                ASSERT_TRUE(close(dvec3(glm::vec3(powers[2 * n + path])), dvec3(1), 1e-5))
                    << "photons keep their power";
                const dvec3 next(glm::vec3(directions[2 * n + path]));
                if ((glm::dot(next, at.normal) > 0) == c.reflected)
                    ++sums[bins.at(next)];
            }
            auto survive = c.known().shares;
            for (auto& share : survive)
                share *= coated ? 1 : 0.9;
            EXPECT_LE(std::abs(deviate(sums, survive, survive, double(n))), far_off);
        }
    }

    /// Where an eye ray ends on a rough surface at a point, as eye_bounce.glsl writes it.
    glm::vec4 ended_at(const dvec3& point, const scene_layout& layout, const material& m)
    {
        return {glm::vec3(point - layout.center), static_cast<float>(-2 - alpha_of(m))};
    }

    /// The radiance of directional light by way of a surface, for lights all around it: its mean over the directions of
    /// a bin is what facets send there.
    TEST(rough_surfaces, highlights_are_as_bright_as_facets_make_them)
    {
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> u;
        for (const auto& c : rough_cases()) {
            SCOPED_TRACE(name_of(c));
            auto s = rough_ball_of(c.m);
            s.spheres = {{{0, -50, 0}, 1, 0}, {{0, -60, 0}, 1, 1}};
            s.sphere_lights.clear();
            s.directional_lights = {{"sun", {0, -1, 0}, dvec3(1)}};
            serial_backend b;
            const auto device = upload_scene(b, s);
            const auto bins = c.bins();
            constexpr std::size_t per_bin = 1000, n = per_bin * lobe_bins::all;
            detail::eye_hits<serial_backend> hits(b, n);
            std::vector<glm::vec4> points(n, ended_at(dvec3(0), device.layout, c.m)), directions, throughputs, surfaces,
                emissions;
            std::vector<double> solid_angles;
            for (std::size_t i = 0; i < n; ++i) {
                // The frame is turned so that the light comes from where this element wants it.
                const dvec3 up(0, 1, 0);
                const auto [wanted, solid_angle] = bins.direction_in(i / per_bin, u(random), u(random));
                solid_angles.push_back(solid_angle);
                const dvec3 axis = glm::normalize(wanted + up); // half a turn about it exchanges the two
                const auto turn = [&](const dvec3& v) { return glm::vec3(2 * glm::dot(v, axis) * axis - v); };
                const auto normal = turn(c.outward);
                directions.emplace_back(turn(c.d), normal.x);
                throughputs.emplace_back(glm::vec3(1), normal.y);
                surfaces.emplace_back(turn(c.whole().normal), 1.0f);
                emissions.emplace_back(glm::vec3(0), normal.z);
            }
            const auto upload_all
                = [&](const std::vector<glm::vec4>& v) { return b.upload(std::span<const glm::vec4>(v)); };
            hits.points = upload_all(points);
            hits.directions = upload_all(directions);
            hits.throughputs = upload_all(throughputs);
            hits.surfaces = upload_all(surfaces);
            hits.emissions = upload_all(emissions);
            detail::light_rough_surfaces(b, device, {s.render, 0, launch(n)}, hits);
            const auto seen = b.download(hits.emissions);
            // Light from there is seen against d: the way back, along which refracted radiance is scaled.
            const double scale = c.reflected ? 1 : c.whole().radiance_scale();
            const auto known = c.known().shares;
            double all = 0, all_known = 0;
            for (std::size_t bin = 0; bin < lobe_bins::all; ++bin) {
                double sum = 0, square = 0;
                for (std::size_t i = bin * per_bin; i < (bin + 1) * per_bin; ++i) {
                    const bool on_this_side = (surfaces[i].y > 0) == c.reflected;
                    const double x = on_this_side ? double(seen[i].y) / scale * solid_angles[i] : 0;
                    sum += x;
                    square += x * x;
                }
                const double mean = sum / per_bin,
                             error = std::sqrt(std::max(0.0, square / per_bin - mean * mean) / per_bin);
                EXPECT_NEAR(mean, known[bin], far_off * error + 0.02 * known[bin] + 1e-4) << bin;
                all += mean;
                all_known += known[bin];
            }
            EXPECT_NEAR(all, all_known, 0.01 * all_known);
        }
    }

    /// The mean radiance of all highlights at a point of a rough surface, seen along d.
    dvec3 mean_highlight(
        const scene& s, std::uint32_t material, const dvec3& normal, const dvec3& d, bool outside, uint n)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        detail::eye_hits<serial_backend> hits(b, n);
        const auto all
            = [&](const glm::vec4& v) { return b.upload(std::span<const glm::vec4>(std::vector<glm::vec4>(n, v))); };
        const auto outward = glm::vec3(outside ? normal : -normal);
        hits.points = all(ended_at({0, 0.5, 0}, device.layout, s.materials[material]));
        hits.directions = all(glm::vec4(glm::vec3(d), outward.x));
        hits.throughputs = all(glm::vec4(glm::vec3(1), outward.y));
        hits.surfaces = all(glm::vec4(glm::vec3(normal), static_cast<float>(material)));
        hits.emissions = all(glm::vec4(glm::vec3(0), outward.z));
        detail::light_rough_surfaces(b, device, {s.render, 0, launch(n)}, hits);
        dvec3 sum(0);
        for (const auto& e : b.download(hits.emissions))
            sum += dvec3(glm::vec3(e)) / static_cast<double>(n);
        return sum;
    }

    /// Where each sample chooses one of many lights, their mean is the sum over few lights at a time.
    TEST(rough_surfaces, highlights_of_many_lights_add_up)
    {
        auto s = bare_floor();
        s.materials = {s.materials[0], {"metal", material_kind::metal, dvec3(0.9), 1.5, 0.5},
            {"glass", material_kind::glass, dvec3(0.9), 1.5, 0.5}};
        s.polygons.push_back(
            {{{0, -5, 0}, {1, -5, 0}, {0, -5, 1}}, 1}); // features of a scene are those of its surfaces
        s.spheres = {{{0, -5, 0}, 0.5, 2}};
        s.render.view.light_samples = 16;
        const auto lit = [&](std::size_t first, std::size_t past) {
            auto few = s;
            for (std::size_t i = first; i < past; ++i) {
                const dvec3 at(-1.5 + 0.7 * double(i % 5), i % 3 == 0 ? 0.1 : 1.3, -1 + 0.4 * double(i / 5)),
                    power(0.5 + double(i % 4), 1, 2);
                if (i % 2 == 0)
                    few.point_lights.push_back({"bulb", at, power});
                else
                    few.spot_lights.push_back({"spot", at, dvec3(0, 0.5, 0) - at, 20, 40, power});
            }
            if (past == 24)
                few.directional_lights = {{"sun", {0.3, -1, 0.2}, dvec3(0.2)}};
            return few;
        };
        for (const std::uint32_t material : {1u, 2u})
            for (const bool outside : {true, false}) {
                const dvec3 normal = glm::normalize(dvec3(0.1, 1, 0.2)), d = glm::normalize(dvec3(0.5, -1, 0));
                const auto few = mean_highlight(lit(0, 12), material, normal, d, outside, 1)
                    + mean_highlight(lit(12, 24), material, normal, d, outside, 1);
                const auto chosen = mean_highlight(lit(0, 24), material, normal, d, outside, 1u << 14);
                ASSERT_GT(few.x, 0.01);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(chosen[c] / few[c], 1, 0.05) << material << outside; // of up to 1.4 % of noise
            }
    }

} // namespace
} // namespace photongrid::testing
