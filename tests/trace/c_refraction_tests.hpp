// Hard cases C: reflection and refraction.
#pragma once

#include "b_leaving_tests.hpp"
#include "hard_cases.hpp"

namespace photongrid::testing {

// --- C: reflection and refraction
// -------------------------------------------------------------------------------------

/// Fresnel's reflectance of a dielectric in long double; eta: index on this side over that on the other.
inline real fresnel(real cos_i, real eta)
{
    const real cos2_t = 1 - eta * eta * (1 - cos_i * cos_i);
    if (cos2_t <= 0)
        return 1;
    const real cos_t = std::sqrt(cos2_t);
    const real parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t),
               perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// Directions, normals and indices for glass_probe.glsl, and what it says.
struct glass_cases {
    std::vector<glm::vec4> directions, normals, refracted, reflected;
    void add(const glm::vec3& d, const glm::vec3& n, float index)
    {
        directions.emplace_back(d, 0.0f);
        normals.emplace_back(n, index);
    }
    template <class Device>
    void run(Device& b)
    {
        const auto d = b.upload(std::span<const glm::vec4>(directions)),
                   n = b.upload(std::span<const glm::vec4>(normals));
        auto r = b.template make<glm::vec4>(directions.size()), m = b.template make<glm::vec4>(directions.size());
        b.template run<probes::glass_probe>(static_cast<uint>(directions.size()), {}, reads(d, n), writes(r, m));
        refracted = b.download(r);
        reflected = b.download(m);
    }
};

TYPED_TEST_P(hard_cases, c1_refraction_is_finite_about_the_critical_angle)
{
    // From inside, the outward normal along z: 1000 floats either side of the critical cosine, for several indices.
    double length_error = 0, step_back = 0;
    for (const float index : {1.0001f, 1.33f, 1.5f, 2.4f, 10.0f}) {
        glass_cases g;
        float c = static_cast<float>(std::sqrt(1 - 1 / (static_cast<double>(index) * static_cast<double>(index))));
        if (index == 1.5f)
            c = 0.745355964f;
        for (int i = 0; i < 1000; ++i)
            c = std::nextafter(c, 0.0f);
        for (int i = 0; i < 2001; ++i, c = std::nextafter(c, 1.0f))
            g.add({static_cast<float>(std::sqrt(1 - static_cast<double>(c) * static_cast<double>(c))), 0, c}, {0, 0, 1},
                index);
        g.run(this->b());
        float least = 1;
        EXPECT_EQ(g.refracted.front().w, 1.0f) << index;
        EXPECT_LT(g.refracted.back().w, 1.0f) << index;
        for (std::size_t i = 0; i < g.refracted.size(); ++i) {
            const auto& r = g.refracted[i];
            ASSERT_TRUE(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z) && std::isfinite(r.w))
                << index << " case " << i;
            ASSERT_GE(r.w, 0.0f);
            ASSERT_LE(r.w, 1.0f);
            length_error = std::max(length_error, static_cast<double>(std::abs(length(vec3l(r)) - 1)));
            step_back = std::max(
                step_back, static_cast<double>(r.w - least)); // away from the critical angle, less is reflected
            least = std::min(least, r.w);
        }
    }
    this->report("C1", "largest error of a refracted direction's length:", length_error);
    this->report("C1", "largest step back of the reflected share:", step_back);
    EXPECT_LE(length_error, 1e-6);
    EXPECT_LE(step_back, 1e-5); // at an index of 1.0001: one unit of sin^2 lasts for many cosines
}

TYPED_TEST_P(hard_cases, c2_energy_is_kept_down_to_grazing)
{
    random_source u(22);
    glass_cases g;
    for (int i = 0; i < 1000000; ++i) {
        const double index = 1 + 2 * static_cast<double>(u());
        double c = i % 3 == 0 ? std::pow(10.0, -10 * static_cast<double>(u())) : static_cast<double>(u());
        if (i < 3)
            c = i == 0 ? 0.0 : i == 1 ? -0.0 : 1e-8;
        const double side = i % 2 == 0 ? 1 : -1; // entering, leaving
        g.add(glm::vec3(dvec3(std::sqrt(1 - c * c), 0, -side * c)), {0, 0, 1}, static_cast<float>(index));
    }
    for (const float index : {1.0f, 1.5f, 10.0f}) // exactly grazing
        for (const float z : {0.0f, -0.0f, 1e-8f, -1e-8f, 1e-38f})
            g.add({1, 0, z}, {0, 0, 1}, index);
    g.run(this->b());
    double fresnel_error = 0, snell = 0, mirror = 0;
    for (std::size_t i = 0; i < g.directions.size(); ++i) {
        const auto& d = g.directions[i];
        const auto& r = g.refracted[i];
        ASSERT_TRUE(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z)) << i;
        ASSERT_TRUE(r.w >= 0 && r.w <= 1) << i << ": " << r.w;
        const bool entering = -d.z > 0;
        const real index = static_cast<real>(g.normals[i].w);
        const real eta = entering ? static_cast<real>(1.0f / g.normals[i].w) : index;
        const real cos_i = std::abs(static_cast<real>(d.z));
        const real cos2_t = 1 - eta * eta * (1 - cos_i * cos_i);
        mirror = std::max(mirror,
            static_cast<double>(length(vec3l(g.reflected[i])
                - vec3l(static_cast<real>(d.x), static_cast<real>(d.y), -static_cast<real>(d.z)))));
        if (cos2_t < 1e-5L) // at the critical angle the share's derivative has no bound (C1)
            continue;
        // The transmitted share by its own formula, T = 4 c_i c_t eta / ..., so that reflected + transmitted = 1 is
        // tested.
        const real cos_t = std::sqrt(cos2_t);
        const real tp = 2 * cos_i / (cos_i + eta * cos_t), ts = 2 * eta * cos_i / (eta * cos_i + cos_t);
        const real transmitted = cos_t / cos_i * (eta * tp * tp + ts * ts / eta) / 2;
        if (cos_i > 0)
            fresnel_error = std::max(
                fresnel_error, static_cast<double>(cos_t * std::abs(static_cast<real>(r.w) + transmitted - 1)));
        if (r.w < 1)
            snell = std::max(snell,
                static_cast<double>(
                    std::abs(std::abs(static_cast<real>(r.x)) - eta * std::abs(static_cast<real>(d.x)))));
    }
    this->report("C2", "largest error of reflected + transmitted, times the refracted cosine:", fresnel_error);
    this->report("C2", "largest error of the refracted sine:", snell);
    this->report("C2", "largest error of a reflected direction:", mirror);
    EXPECT_LE(fresnel_error, 1e-6);
    EXPECT_LE(snell, 1e-6);
    EXPECT_LE(mirror, 1e-6);
}

TYPED_TEST_P(hard_cases, c3_bodies_of_one_glass_must_not_overlap)
{
    auto s = small_cornell();
    const auto ball = s.spheres[1];
    for (const auto& [aside, radius, good] :
        {std::tuple{0.0, 0.05, false}, {0.3, 0.15, false}, {0.33, 0.15, true}, {0.4, 0.15, true}}) {
        s.spheres[0] = {ball.center + dvec3(aside, 0, 0), radius, ball.material};
        if (good) {
            EXPECT_NO_THROW(lay_out(s));
            continue;
        }
        try {
            lay_out(s);
            ADD_FAILURE() << "accepted at " << aside;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find("spheres[1]: overlaps spheres[0], and both are of one glass"),
                std::string::npos)
                << e.what();
        }
    }
    s.spheres[0] = {ball.center, 0.05, 0}; // something else in glass is fine, and so is other glass
    EXPECT_NO_THROW(lay_out(s));
    s.materials.push_back(s.materials[ball.material]);
    s.spheres[0].material = static_cast<std::uint32_t>(s.materials.size() - 1);
    EXPECT_NE(lay_out(s).features & has_media, 0u);
}

/// A bulb in a cube of glass, in a closed white room.
inline scene cube_of_glass()
{
    auto s = room_under_a_lamp(1e-3);
    s.rectangle_lights.clear();
    s.point_lights = {{"bulb", {0.45, 0.55, 0.5}, dvec3(1)}};
    const dvec3 low(0.3), high(0.7);
    const auto corner = [&](int i) {
        return dvec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
    };
    for (const auto& [a, b, c, d] :
        {std::tuple{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        s.polygons.push_back({{corner(a), corner(b), corner(c), corner(d)}, 1});
    return s;
}

TYPED_TEST_P(hard_cases, c4_endless_total_reflection_is_cut_off_and_counted)
{
    // Inside the cube, directions whose three components are all below sqrt(1 - 1/1.5^2) in their cosine never leave
    // it.
    auto s = cube_of_glass();
    auto& b = this->b();
    const auto device = upload_scene(b, s);
    const auto t = trace_photons(b, device, s.render);
    const auto stats = count_photons(b, t);
    expect_an_exact_account(stats, s.render.map.photons);
    EXPECT_EQ(stats.escaped, 0u);
    // The share that is caught for ever: three cones of half angle asin(1/1.5) about each axis both ways let light out,
    // but for the little that Fresnel's share sends back in; caught for ever is 1 - 3 (1 - sqrt(1 - 1/1.5^2)), cut off
    // at 32.
    const double caught = 1 - 3 * (1 - std::sqrt(1 - 1 / 2.25));
    const double share = static_cast<double>(stats.cut_off) / static_cast<double>(stats.emitted);
    this->report("C4", "share of paths cut off:", share);
    EXPECT_GT(share, caught - 4 * std::sqrt(caught / static_cast<double>(stats.emitted)));
    EXPECT_LT(share, caught + 0.05);
}

TYPED_TEST_P(hard_cases, c5_a_camera_in_glass_sees_through_it)
{
    // From the middle of a ball every ray leaves along its normal: the lamp's radiance, less (n - 1)^2 / (n + 1)^2,
    // times n^2, since radiance over the index squared is constant.
    auto s = room_under_a_lamp(1e-3);
    s.spheres = {{{0.5, 0.5, 0.5}, 0.2, 1}};
    s.camera = {{0.5, 0.5, 0.5}, {0.5, 1, 0.5}, {0, 0, 1}, 40};
    s.render.view.depth = 1;
    s.render.map.photons = 500;
    const auto im = render(this->b(), s).picture;
    double largest = 0;
    for (const auto& p : im.pixels)
        largest = std::max(largest, std::abs(static_cast<double>(p.x) / (2.25 * 0.96 / M_PI) - 1));
    this->report("C5", "largest relative error of a lamp seen from inside a ball:", largest);
    EXPECT_LE(largest, 1e-5);
}

} // namespace photongrid::testing
