// Hard cases D: lights.
#pragma once

#include "b_leaving_tests.hpp"
#include "hard_cases.hpp"

namespace photongrid::testing {

// --- D: lights
// --------------------------------------------------------------------------------------------------------

/// Irradiance of a diffuse rectangle of 1 W by Lambert's formula, clipped at the horizon, in long double.
inline double lambert(const rectangle_light& l, const dvec3& point, const dvec3& normal)
{
    const dvec3 corners[4] = {l.corner, l.corner + l.edge_u, l.corner + l.edge_u + l.edge_v, l.corner + l.edge_v};
    std::vector<vec3l> above;
    const vec3l n(normal);
    for (int i = 0; i < 4; ++i) {
        const vec3l a = vec3l(corners[i]) - vec3l(point), b = vec3l(corners[(i + 1) % 4]) - vec3l(point);
        const real ha = dot(a, n), hb = dot(b, n);
        if (ha >= 0)
            above.push_back(a);
        if ((ha < 0) != (hb < 0))
            above.push_back(a + ha / (ha - hb) * (b - a));
    }
    real sum = 0;
    for (std::size_t i = 0; i < above.size(); ++i) {
        const vec3l a = above[i], b = above[(i + 1) % above.size()];
        const vec3l c(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
        const real s = length(c);
        if (s > 0)
            sum += std::atan2(s, dot(a, b)) * dot(c, n) / s;
    }
    const double area = glm::length(glm::cross(l.edge_u, l.edge_v));
    return static_cast<double>(std::abs(sum)) / (2 * M_PI) / area;
}

TYPED_TEST_P(hard_cases, d2_irradiance_close_to_a_lamp_is_bounded)
{
    // On a wall, from 1e-5 m to 1 m under a ceiling that is a lamp; each distance at many points.
    const auto s = room_under_a_lamp(1e-3);
    const auto& lamp = s.rectangle_lights[0];
    random_source u(31);
    double worst_mean = 0, worst_point = 0;
    for (const double distance : {1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5}) {
        std::vector<dvec3> points, normals;
        double known = 0;
        for (int i = 0; i < 2000; ++i) {
            points.emplace_back(0, 1 - 1e-3 - distance, 0.3 + 0.4 * static_cast<double>(u()));
            normals.emplace_back(1, 0, 0);
            known += lambert(lamp, points.back(), normals.back()) / 2000;
        }
        double mean = 0;
        for (const auto& e : this->direct_light_at(s, points, normals, 64)) {
            mean += static_cast<double>(e.x) / 2000;
            worst_point = std::max(worst_point, static_cast<double>(e.x)); // the exitance is 1 W/m^2
        }
        this->report(
            "D2", "mean irradiance over the known one, " + std::to_string(distance) + " m from a lamp:", mean / known);
        worst_mean = std::max(worst_mean, std::abs(mean / known - 1));
    }
    this->report("D2", "largest irradiance, exitances:", worst_point);
    this->report("D2", "largest relative error of a mean:", worst_mean);
    EXPECT_LE(worst_mean, 0.02);
    EXPECT_LE(worst_point, 1.0);
}

TYPED_TEST_P(hard_cases, d3_samples_at_the_ends_of_the_unit_interval_are_finite)
{
    const float ends[] = {0.0f, 0x1p-24f, 0x1p-12f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-12f, 1 - 0x1p-23f, 1 - 0x1p-24f};
    std::vector<glm::vec4> normals, numbers;
    for (const float x : ends)
        for (const float y : ends)
            for (const float z : {1.0f, -1.0f}) {
                normals.emplace_back(0, 0, z, 0);
                numbers.emplace_back(x, y, 0, 0);
            }
    auto& b = this->b();
    auto first = b.template make<glm::vec4>(normals.size()), second = b.template make<glm::vec4>(normals.size()),
         diffuse = b.template make<glm::vec4>(normals.size()), anywhere = b.template make<glm::vec4>(normals.size());
    const auto n = b.upload(std::span<const glm::vec4>(normals)), r = b.upload(std::span<const glm::vec4>(numbers));
    b.template run<probes::basis_probe>(
        static_cast<uint>(normals.size()), {}, reads(n, r), writes(first, second, diffuse, anywhere));
    double largest = 0;
    const auto d = b.download(diffuse), a = b.download(anywhere);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        // Malley's and Archimedes' methods in long double.
        const real x = static_cast<real>(numbers[i].x),
                   y = 2 * static_cast<real>(M_PIl) * static_cast<real>(numbers[i].y);
        const real side = static_cast<real>(normals[i].z);
        const vec3l cosine(std::sqrt(x) * std::cos(y), side * std::sqrt(x) * std::sin(y), side * std::sqrt(1 - x));
        const real h = std::sqrt(std::max<real>(0, 4 * x * (1 - x)));
        const vec3l uniform(h * std::cos(y), h * std::sin(y), 1 - 2 * x);
        EXPECT_GT(d[i].z * normals[i].z, 0.0f); // never in the surface: no density of 0
        // Any frame about the normal will do: compare heights and lengths, and the uniform ones whole.
        largest = std::max({largest, static_cast<double>(std::abs(static_cast<real>(d[i].z) - cosine.z)),
            static_cast<double>(std::abs(length(vec3l(d[i])) - 1)),
            static_cast<double>(length(vec3l(a[i]) - uniform))});
    }
    this->report("D3", "largest error of a sampled direction:", largest);
    EXPECT_LE(largest, 2e-6);
}

TYPED_TEST_P(hard_cases, d4_a_point_light_on_a_surface_is_finite)
{
    auto s = empty_scene({0.5, 0, 0.5});
    s.polygons = {{{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, 0}};
    std::vector<dvec3> points, normals;
    for (const double aside : {0.0, 1e-30, 1e-20, 1e-12, 1e-8, 1e-6, 1e-3})
        for (const dvec3& way : {dvec3(0, -1, 0), dvec3(1, -1, 0)}) { // points below the light
            points.push_back(dvec3(0.5, 0, 0.5) + aside * way);
            normals.emplace_back(0, 1, 0);
        }
    for (const auto& e : this->direct_light_at(s, points, normals, 1)) {
        EXPECT_TRUE(std::isfinite(e.x) && e.x >= 0) << e.x;
        EXPECT_LE(e.x, 1e16f); // as bright as from the ray's own distance from the surface, some 1e-8 m
    }
}

TYPED_TEST_P(hard_cases, d5_dark_lights_are_refused)
{
    for (const double bad :
        {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        auto s = integrating_sphere(dvec3(0.5));
        s.point_lights[0].power = dvec3(bad);
        EXPECT_THROW(upload_scene(this->b(), s), std::invalid_argument) << bad;
        auto r = small_cornell();
        r.rectangle_lights[0].power = dvec3(bad);
        EXPECT_THROW(upload_scene(this->b(), r), std::invalid_argument) << bad;
    }
    auto none = small_cornell();
    none.rectangle_lights.clear();
    EXPECT_THROW(upload_scene(this->b(), none), std::invalid_argument);
}

} // namespace photongrid::testing
