// The four verbs of scattering (trace/scatter.glsl), of each kind of surface: what is sampled has the density that
// scatter_pdf() states and the weight that scatter_eval() states; scatter_eval() is the reference's in double.
#pragma once

#include "rough_tests.hpp"

#include <photongrid/reference/rebounds.hpp>

#include <probes_kernels.hpp>

namespace photongrid::testing {
namespace {

    /// A surface, the direction in which a ray meets it, and a way by which light leaves.
    constexpr uint any_way = 3;                                      ///< that which a facet chooses
    const dvec3 verb_normal = glm::normalize(dvec3(0.3, 0.8, -0.5)); ///< outward
    struct verb_case {
        material m;
        dvec3 d;
        uint way;
        dvec3 shading = verb_normal;
    };

    std::string name_of(const verb_case& c)
    {
        const double cosine = -glm::dot(c.d, verb_normal);
        return c.m.name + ", roughness " + std::to_string(c.m.roughness) + ", cosine " + std::to_string(cosine)
            + ", way " + std::to_string(c.way);
    }

    std::vector<verb_case> verb_cases()
    {
        std::vector<verb_case> cases;
        for (const double cosine : {0.9, 0.3, -0.9, -0.75}) {
            const dvec3 d = cosine > 0 ? -turned_off(verb_normal, std::acos(cosine), 1)
                                       : -turned_off(-verb_normal, std::acos(-cosine), 1);
            const auto add = [&](material m, uint way) { cases.push_back({std::move(m), d, way}); };
            add({"matte", material_kind::lambertian, dvec3(0.5)}, kernels::BY_BASE);
            add({"mirror", material_kind::mirror, dvec3(0.9)}, kernels::BY_REFLECTION);
            for (const double roughness : {0.0, 0.4, 1.0}) {
                material metal{"metal", material_kind::metal, {0.9, 0.6, 0.3}, 1.5, roughness},
                    glass{"glass", material_kind::glass, {0.3, 0.9, 0.6}, 1.5, roughness};
                const material plastic{"plastic", material_kind::plastic, {0.9, 0.6, 0.3}, 1.5, roughness},
                    pane{"pane", material_kind::thin_glass, {0.3, 0.9, 0.6}, 1.5, roughness};
                if (roughness > 0) {
                    auto white = metal; // of a colour, each bounce has its own weight: rebound_tests.hpp
                    white.reflectance = dvec3(1);
                    add(white, any_way);
                    add(glass, any_way);
                }
                metal.energy = glass.energy = facet_bounces::single;
                add(metal, kernels::BY_REFLECTION);
                add(glass, kernels::BY_REFLECTION);
                add(glass, kernels::BY_REFRACTION);
                if (is_rough(pane)) { // smooth ones are meshes: see panes_let_pass_what_two_faces_do_not_reflect
                    add(pane, kernels::BY_REFLECTION);
                    add(pane, kernels::BY_REFRACTION);
                }
                add(plastic, kernels::BY_REFLECTION);
                add(plastic, kernels::BY_BASE);
            }
        }
        return cases;
    }

    /// What the verbs say for n rays.
    struct verb_answers {
        std::vector<glm::vec4> sampled, verbs, colored;
        scene_layout layout;

        verb_answers(const verb_case& c, const std::vector<glm::vec4>& towards)
        {
            auto s = rough_ball_of(c.m);
            serial_backend b;
            const auto device = upload_scene(b, s);
            layout = device.layout;
            const std::size_t n = towards.size();
            const std::vector<glm::vec4> d(n, glm::vec4(glm::vec3(c.d), 1.0f)),
                normals(n, glm::vec4(glm::vec3(verb_normal), 0.0f));
            const auto on_device = [&](const auto& v) { return b.upload(std::span<const glm::vec4>(v)); };
            auto to = b.template make<glm::vec4>(n), answers = b.template make<glm::vec4>(n),
                 colors = b.template make<glm::vec4>(n);
            const uint smooth = c.shading != verb_normal ? has_smooth_meshes : 0u;
            const std::vector<glm::vec4> shadings(n, glm::vec4(glm::vec3(c.shading), 0.0f));
            b.template run<probes::scatter_probe>({n, 0u, layout.features | smooth}, {.way = c.way, .seed = 7},
                reads(device.records, on_device(d), on_device(normals), on_device(towards), on_device(shadings)),
                writes(to, answers, colors));
            sampled = b.download(to);
            verbs = b.download(answers);
            colored = b.download(colors);
        }
    };

    bool is_wide(const verb_case& c) { return c.way == kernels::BY_BASE || c.m.roughness > 0; }

    /// Directions that are even over the sphere.
    std::vector<glm::vec4> even_directions(std::size_t n)
    {
        std::mt19937_64 random(9);
        std::normal_distribution<double> g;
        std::vector<glm::vec4> all;
        for (std::size_t i = 0; i < n; ++i)
            all.emplace_back(glm::vec3(glm::normalize(dvec3(g(random), g(random), g(random)))), 0.0f);
        return all;
    }

    TEST(verbs, a_smooth_surface_is_a_delta_and_has_no_density)
    {
        for (const auto& c : verb_cases()) {
            SCOPED_TRACE(name_of(c));
            const verb_answers a(c, std::vector<glm::vec4>(8, glm::vec4(0)));
            EXPECT_EQ(a.verbs[0].z, is_wide(c) ? 0.0f : 1.0f);
            if (!is_wide(c)) {
                EXPECT_EQ(a.verbs[0].x, 0.0f);
                EXPECT_EQ(a.verbs[0].y, 0.0f);
            }
        }
    }

    /// By its shading normal it would be refracted back into the glass, and by its geometric one it is reflected
    /// totally.
    TEST(verbs, a_ray_that_stays_in_smooth_glass_keeps_its_radiance)
    {
        const dvec3 d = turned_off(verb_normal, std::acos(0.4), 0);
        const dvec3 shading = turned_off(verb_normal, std::acos(0.4) - std::acos(0.8), 0);
        const verb_case c{{"glass", material_kind::glass, dvec3(1), 1.5}, d, kernels::BY_REFRACTION, shading};
        const verb_answers a(c, {glm::vec4(0)});
        const dvec3 reflected = d - 2 * glm::dot(d, verb_normal) * verb_normal;
        EXPECT_TRUE(close(dvec3(glm::vec3(a.sampled[0])), reflected, 1e-6));
        EXPECT_EQ(a.verbs[0].w, 1.0f);
    }

    TEST(verbs, a_sample_carries_what_the_bsdf_and_its_density_say)
    {
        for (const auto& c : verb_cases()) {
            if (!is_wide(c))
                continue;
            SCOPED_TRACE(name_of(c));
            const verb_answers a(c, std::vector<glm::vec4>(1 << 12, glm::vec4(0)));
            // What a matte base sends on is below a coat less than comes to it: by the mean share that passes.
            double base = 1;
            if (c.way == kernels::BY_BASE && c.m.kind == material_kind::plastic) {
                const auto record = a.layout.records[kernels::FIRST_MATERIAL + kernels::MATERIAL_RECORDS + 1];
                const double cosine = std::abs(glm::dot(c.d, verb_normal));
                if (c.m.roughness > 0)
                    continue; // what passes is a table: see a_base_sends_what_passes_its_coat
                base = 1 - reference::coat_reflectance(cosine, double(record.x));
            }
            std::size_t compared = 0;
            for (std::size_t i = 0; i < a.sampled.size(); ++i) {
                const double share = double(a.sampled[i].w), scale = double(a.verbs[i].w),
                             cosine = std::abs(glm::dot(dvec3(glm::vec3(a.sampled[i])), verb_normal));
                if (share == 0)
                    continue;
                const double weight = double(a.verbs[i].x) * cosine / double(a.verbs[i].y);
                ASSERT_NEAR(weight, base * share * scale, 2e-3 * base * share * scale + 1e-6) << i;
                ++compared;
            }
            const bool totally_reflected
                = c.m.kind == material_kind::glass && c.way == kernels::BY_REFRACTION && glm::dot(c.d, verb_normal) > 0;
            EXPECT_TRUE(compared > 100 || totally_reflected) << compared;
        }
    }

    /// Compares moments of sampled directions with their integrals over the sphere.
    TEST(verbs, samples_have_the_density_that_is_stated)
    {
        constexpr std::size_t n = 1 << 16;
        const auto even = even_directions(n);
        for (const auto& c : verb_cases()) {
            if (!is_wide(c) || (c.way != kernels::BY_BASE && c.m.roughness < 0.9))
                continue; // narrow lobes: rough_surfaces
            SCOPED_TRACE(name_of(c));
            const verb_answers drawn(c, std::vector<glm::vec4>(n, glm::vec4(0))), asked(c, even);
            for (int moment = 0; moment < 7; ++moment) {
                const auto of = [&](const dvec3& v) {
                    return moment == 0 ? 1.0 : moment < 4 ? v[moment - 1] : v[moment - 4] * v[moment - 4];
                };
                double sums[2] = {}, squares[2] = {};
                for (std::size_t i = 0; i < n; ++i) {
                    const double x[2] = {double(drawn.sampled[i].w) > 0 && double(drawn.verbs[i].y) > 0
                            ? of(dvec3(glm::vec3(drawn.sampled[i])))
                            : 0,
                        double(asked.verbs[i].y) * 4 * pi * of(dvec3(glm::vec3(even[i])))};
                    for (int k = 0; k < 2; ++k) {
                        sums[k] += x[k] / n;
                        squares[k] += x[k] * x[k] / n;
                    }
                }
                const double error = std::sqrt((squares[0] - sums[0] * sums[0] + squares[1] - sums[1] * sums[1]) / n);
                EXPECT_NEAR(sums[0], sums[1], far_off * error + 1e-6) << "moment " << moment;
            }
        }
    }

    TEST(verbs, the_bsdf_of_facets_is_that_of_the_reference)
    {
        const auto even = even_directions(1 << 12);
        for (const auto& c : verb_cases()) {
            if (c.m.roughness == 0 || c.way == kernels::BY_BASE)
                continue;
            SCOPED_TRACE(name_of(c));
            const verb_answers a(c, even);
            reference::hit h{};
            h.normal = h.shading = verb_normal;
            std::optional<reference::facet_rebounds> rebounds;
            if (has_rebounds(c.m))
                rebounds.emplace(c.m);
            std::vector<double> known;
            for (const auto& towards : even) {
                const double side = glm::dot(dvec3(glm::vec3(towards)), verb_normal) * -glm::dot(c.d, verb_normal);
                known.push_back(c.way == any_way || (side > 0) == (c.way == kernels::BY_REFLECTION)
                        ? reference::rough_bsdf(
                            rebounds ? &*rebounds : nullptr, c.m, c.m.reflectance, h, c.d, dvec3(glm::vec3(towards)))
                              .x
                        : 0);
            }
            const double largest = *std::max_element(known.begin(), known.end());
            EXPECT_GT(largest, 0);
            for (std::size_t i = 0; i < even.size(); ++i)
                ASSERT_NEAR(double(a.verbs[i].x), known[i], (rebounds ? 0.03 : 2e-3) * known[i] + 1e-5 * largest) << i;
        }
    }

    /// Of the light that comes evenly from all sides, what a base sends against d, divided by its reflectance: what its
    /// coat lets through, there and back.
    TEST(verbs, a_base_sends_what_passes_its_coat)
    {
        const auto even = even_directions(1 << 16);
        for (const auto& c : verb_cases()) {
            if (c.way != kernels::BY_BASE)
                continue;
            SCOPED_TRACE(name_of(c));
            const verb_answers a(c, even);
            double known = 1;
            if (c.m.kind == material_kind::plastic) {
                reference::hit h{};
                h.normal = h.shading = verb_normal;
                reference::random_stream random(3, 0, 0);
                for (std::size_t i = 0; i < even.size(); ++i)
                    known -= reference::off_coat(c.m, h, c.d, random, false).weight / double(even.size());
            }
            double sum = 0, square = 0;
            for (std::size_t i = 0; i < even.size(); ++i) {
                const double x
                    = double(a.verbs[i].x) * 4 * pi * std::abs(glm::dot(dvec3(glm::vec3(even[i])), verb_normal));
                sum += x / double(even.size());
                square += x * x / double(even.size());
            }
            EXPECT_NEAR(sum, known, far_off * std::sqrt((square - sum * sum) / double(even.size())) + 2e-3);
        }
    }

    /// Light may go either way along a path: the BSDF of reflection is that of the way back.
    TEST(verbs, what_is_reflected_may_go_back)
    {
        for (auto c : verb_cases()) {
            if (!is_wide(c) || c.way == kernels::BY_REFRACTION)
                continue;
            SCOPED_TRACE(name_of(c));
            const double side = glm::dot(c.d, verb_normal) < 0 ? 1 : -1;
            for (const double turn : {0.0, 1.0, 2.5}) {
                const dvec3 towards = turned_off(side * verb_normal, 0.6, turn), d = c.d;
                const verb_answers there(c, {glm::vec4(glm::vec3(towards), 0.0f)});
                c.d = -towards;
                const verb_answers back(c, {glm::vec4(glm::vec3(-d), 0.0f)});
                c.d = d;
                EXPECT_GT(there.verbs[0].x, 0.0f);
                EXPECT_NEAR(there.verbs[0].x, back.verbs[0].x, 1e-4f * there.verbs[0].x);
            }
        }
    }

} // namespace
} // namespace photongrid::testing
