// Light that meets several facets of rough metal or glass (trace/rebounds.glsl): none is lost and none is made, it may
// go either way along a path, and it has the colour of its bounces. The kernel's BSDF and the reference renderer's are
// integrated over directions.
#pragma once

#include "known_coats.hpp"
#include "verb_tests.hpp"

#include <photongrid/reference/rebounds.hpp>

namespace photongrid::testing {
namespace {

    /// A ray that meets rough metal, or glass, from outside or inside.
    struct rebound_case {
        material m;
        double cosine;
        bool inside;

        dvec3 up() const { return inside ? -verb_normal : verb_normal; }
        dvec3 d() const { return -turned_off(up(), std::acos(cosine), 1); }
        /// The index of the far side, relative to that of the ray's.
        double index() const { return !refracts(m) ? 0 : inside ? 1 / m.index_of_refraction : m.index_of_refraction; }
    };
    std::string name_of(const rebound_case& c)
    {
        return c.m.name + ", roughness " + std::to_string(c.m.roughness) + ", index " + std::to_string(c.index())
            + ", cosine " + std::to_string(c.cosine);
    }

    std::vector<rebound_case> rebound_cases(const std::vector<double>& roughnesses, const std::vector<double>& cosines)
    {
        std::vector<rebound_case> cases;
        for (const double roughness : roughnesses)
            for (const double cosine : cosines) {
                cases.push_back({{"metal", material_kind::metal, dvec3(1), 1.5, roughness}, cosine, false});
                for (const double index : {1.1, 1.5, 2.5})
                    for (const bool inside : {false, true})
                        cases.push_back({{"glass", material_kind::glass, dvec3(1), index, roughness}, cosine, inside});
            }
        return cases;
    }

    /// Directions, and the solid angle for which each stands in a sum: as many that a lattice of facets reflects, that
    /// it refracts, and that are even over the sphere. Each counts by the density of all three (Veach's balance
    /// heuristic).
    struct weighed_directions {
        std::vector<glm::vec4> towards;
        std::vector<double> solid_angles;

        explicit weighed_directions(const rebound_case& c)
        {
            constexpr int n = 10946, step = 6765; // numbers of Fibonacci
            const double alpha = c.m.roughness * c.m.roughness, index = c.index();
            const dvec3 seen = -c.d(), up = c.up();
            const auto facets = [&](double z) { // GGX, per sr
                const double spread = z * z * (alpha * alpha - 1) + 1;
                return alpha * alpha / (pi * spread * spread) * z;
            };
            const auto density = [&](const dvec3& w) {
                double sum = 1 / (4 * pi);
                const bool front = glm::dot(w, up) > 0;
                if (!front && index == 0)
                    return sum;
                dvec3 facet = glm::normalize(front ? w + seen : w * index + seen);
                facet = glm::dot(facet, up) < 0 ? -facet : facet;
                const double met = glm::dot(seen, facet), lit = glm::dot(w, facet);
                if (met > 0 && (front ? lit > 0 : lit < 0))
                    sum += facets(glm::dot(facet, up))
                        * (front ? 0.25 / lit : index * index * -lit / std::pow(met + index * lit, 2));
                return sum;
            };
            const auto add = [&](const dvec3& w) {
                towards.emplace_back(glm::vec3(w), 0.0f);
                solid_angles.push_back(1 / (n * density(dvec3(glm::vec3(w)))));
            };
            for (int i = 0; i < n; ++i) {
                const double u = (i + 0.5) / n, turn = 2 * pi * ((i * step % n + 0.5) / n);
                const dvec3 facet = turned_off(up, std::atan(alpha * std::sqrt(u / (1 - u))), turn);
                const double met = glm::dot(seen, facet);
                if (met > 0) {
                    const dvec3 reflected = 2 * met * facet - seen;
                    if (glm::dot(reflected, up) > 0)
                        add(reflected);
                    const double beyond2 = index > 0 ? 1 - (1 - met * met) / (index * index) : 0;
                    const dvec3 refracted = (met / index - std::sqrt(std::max(0.0, beyond2))) * facet - seen / index;
                    if (beyond2 > 0 && glm::dot(refracted, up) < 0)
                        add(refracted);
                }
                add(turned_off(up, std::acos(1 - 2 * u), turn));
            }
        }
    };

    /// The share of the power of light against d that the BSDF sends on; `bsdf`: of radiance, of a direction's number.
    template <class Bsdf>
    double sent_on(const rebound_case& c, const weighed_directions& all, const Bsdf& bsdf)
    {
        double sum = 0;
        for (std::size_t i = 0; i < all.towards.size(); ++i) {
            const double cosine = glm::dot(dvec3(glm::vec3(all.towards[i])), c.up());
            // Refracted radiance is that of the power, over the squared index of the far side.
            sum += bsdf(i) * std::abs(cosine) * all.solid_angles[i] * (cosine < 0 ? c.index() * c.index() : 1);
        }
        return sum;
    }

    TEST(rebounds, rough_surfaces_lose_no_light)
    {
        double least = 2, most = 0, in_reference = 0;
        for (const auto& c : rebound_cases({0.03, 0.1, 0.3, 0.6, 1}, {0.95, 0.5, 0.1})) {
            SCOPED_TRACE(name_of(c));
            const weighed_directions all(c);
            const verb_answers a({c.m, c.d(), any_way}, all.towards);
            const double by_kernel = sent_on(c, all, [&](std::size_t i) { return double(a.verbs[i].x); });
            reference::hit h{};
            h.normal = h.shading = verb_normal;
            const reference::facet_rebounds rebounds(c.m);
            const double by_reference = sent_on(c, all, [&](std::size_t i) {
                return reference::rough_bsdf(&rebounds, c.m, dvec3(1), h, c.d(), dvec3(glm::vec3(all.towards[i]))).x;
            });
            for (const double sent : {by_kernel, by_reference}) {
                EXPECT_GE(sent, 0.995);
                EXPECT_LE(sent, 1.004);
            }
            least = std::min(least, by_kernel);
            most = std::max(most, by_kernel);
            in_reference = std::max(in_reference, std::abs(by_reference - 1));
        }
        std::printf("of all light, %.4f to %.4f leaves; by the reference renderer's BSDF 1 +- %.4f\n", least, most,
            in_reference);
    }

    /// What single scattering loses is what is measured: without rebounds, less leaves by as much as the table says.
    TEST(rebounds, single_scattering_loses_what_the_table_says)
    {
        for (auto c : rebound_cases({0.1, 0.3, 0.6, 1}, {0.95, 0.5, 0.2})) {
            SCOPED_TRACE(name_of(c));
            c.m.energy = facet_bounces::single;
            const weighed_directions all(c);
            const verb_answers reflected({c.m, c.d(), kernels::BY_REFLECTION}, all.towards),
                refracted({c.m, c.d(), kernels::BY_REFRACTION}, all.towards);
            const double by_kernel
                = sent_on(c, all, [&](std::size_t i) { return double(reflected.verbs[i].x + refracted.verbs[i].x); });
            const double alpha = c.m.roughness * c.m.roughness;
            EXPECT_NEAR(1 - by_kernel, detail::hidden_by_facets(c.cosine, alpha, c.index()).all(), 4e-3);
            if (!refracts(c.m)) {
                const double known = 1
                    - albedo_of_facets(
                        c.cosine, alpha, [](double) { return 1.0; }, 400);
                EXPECT_NEAR(detail::hidden_by_facets(c.cosine, alpha, 0).all(), known, 3e-3);
            }
        }
    }

    /// Light may go either way along a path, through the surface too: refracted radiance by the squared index.
    TEST(rebounds, light_may_go_back)
    {
        for (const auto& c : rebound_cases({0.3, 1}, {0.8, 0.3})) {
            SCOPED_TRACE(name_of(c));
            for (const bool across : {false, true}) {
                if (across && !refracts(c.m))
                    continue;
                const dvec3 towards = turned_off(across ? -c.up() : c.up(), 0.9, 2.5);
                const verb_answers there({c.m, c.d(), any_way}, {glm::vec4(glm::vec3(towards), 0.0f)}),
                    back({c.m, -towards, any_way}, {glm::vec4(glm::vec3(-c.d()), 0.0f)});
                const float scale = across ? static_cast<float>(c.index() * c.index()) : 1.0f;
                EXPECT_GT(there.verbs[0].x, 0.0f);
                EXPECT_NEAR(there.verbs[0].x * scale, back.verbs[0].x, 1e-3f * back.verbs[0].x) << across;
            }
        }
    }

    /// Of a colour r, light has r after one bounce, and then r times r E / (1 - r (1 - E)), E: the mean share that
    /// leaves.
    TEST(rebounds, the_colour_of_metal_counts_at_each_bounce)
    {
        const dvec3 gold(1, 0.7, 0.3);
        for (const double roughness : {0.4, 1.0}) {
            rebound_case c{{"metal", material_kind::metal, gold, 1.5, roughness}, 0.6, false};
            const double alpha = roughness * roughness;
            const auto by_one = [&](double cosine) {
                return albedo_of_facets(
                    cosine, alpha, [](double) { return 1.0; }, 200);
            };
            double mean = 0;
            for (int i = 0; i < 100; ++i)
                mean += by_one(std::sqrt((i + 0.5) / 100)) / 100;
            const dvec3 known = by_one(c.cosine) + (1 - by_one(c.cosine)) * gold * mean / (1.0 - gold * (1 - mean));
            const weighed_directions all(c);
            const verb_answers a({c.m, c.d(), any_way}, all.towards);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(
                    sent_on(c, all, [&](std::size_t i) { return double(a.colored[i][channel]); }), known[channel], 5e-3)
                    << roughness << channel;
            // The same of samples.
            const verb_answers drawn({c.m, c.d(), any_way}, std::vector<glm::vec4>(1 << 16, glm::vec4(0)));
            double sum = 0;
            for (const auto& s : drawn.colored)
                sum += double(s.w) / double(drawn.colored.size());
            EXPECT_NEAR(sum, known.y, 5e-3) << roughness;
        }
    }

    /// Photons leave as the BSDF says: all of those that no colour absorbs, to either side as much as it sends there;
    /// of gold, each colour as much as it keeps.
    TEST(rebounds, photons_leave_as_the_bsdf_says)
    {
        constexpr uint n = 1 << 16;
        for (auto c : rebound_cases({0.3, 1}, {0.7, 0.2})) {
            SCOPED_TRACE(name_of(c));
            const dvec3 color = refracts(c.m) ? dvec3(1) : dvec3(1, 0.7, 0.3);
            c.m.reflectance = color;
            const auto [positions, directions, powers] = beam(rough_ball_of(c.m), verb_normal, c.d(), n);
            dvec3 sums[2]{};
            for (std::size_t path = n; path < 2 * std::size_t{n}; ++path) {
                ASSERT_EQ(kernels::event_kind(positions[path]), kernels::SPECULAR_SURFACE);
                ASSERT_EQ(kernels::event_end(positions[path]), kernels::GOES_ON) << "red is not absorbed";
                const dvec3 power(glm::vec3(powers[path + n]));
                for (int channel = 0; channel < 3; ++channel)
                    ASSERT_LE(power[channel], 1.00001);
                const bool front = glm::dot(dvec3(glm::vec3(directions[path + n])), c.up()) > 0;
                sums[front ? 0 : 1] += power / double{n};
            }
            const weighed_directions all(c);
            const verb_answers a({c.m, c.d(), any_way}, all.towards);
            for (const bool front : {true, false})
                for (int channel = 0; channel < 3; ++channel) {
                    const double known = color[channel] * sent_on(c, all, [&](std::size_t i) {
                        const bool is_there = glm::dot(dvec3(glm::vec3(all.towards[i])), c.up()) > 0;
                        return is_there == front ? double(a.colored[i][channel]) : 0;
                    });
                    EXPECT_NEAR(sums[front ? 0 : 1][channel], known, far_off * 0.5 / std::sqrt(double{n}) + 4e-3)
                        << front << channel;
                }
        }
    }

    /// A texture of the roughness: interpolated tables are near those of each roughness.
    TEST(rebounds, tables_between_roughnesses_are_close)
    {
        for (const double index : {0.0, 1.5})
            for (const double share : {0.11, 0.37, 0.72, 0.98}) {
                material m{index > 0 ? "glass" : "metal", index > 0 ? material_kind::glass : material_kind::metal,
                    dvec3(1), index > 0 ? index : 1.5, 0.9};
                m.roughness_texture.map = std::make_shared<const texture>(
                    texture{1, 1, {glm::u16vec4(static_cast<std::uint16_t>(share * 65535 + 0.5))}});
                auto exact = m;
                exact.roughness_texture = {};
                exact.roughness *= share;
                const reference::facet_rebounds between(m), known(exact);
                for (const double cosine : {0.05, 0.3, 0.6, 0.9})
                    for (const bool inside : {false, index > 0}) {
                        EXPECT_NEAR(between.hidden(exact.roughness, inside, cosine),
                            known.hidden(exact.roughness, inside, cosine), 4e-3)
                            << index << share << cosine;
                    }
            }
    }

} // namespace
} // namespace photongrid::testing
