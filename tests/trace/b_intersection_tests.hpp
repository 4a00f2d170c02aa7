// Hard cases B1 to B4: rays and shapes.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

TYPED_TEST_P(hard_cases, b1_far_spheres_are_hit_within_rounding_of_the_distance)
{
    auto s = empty_scene({0, 2, 0});
    s.spheres = {{dvec3(0), 1, 0}};
    const auto layout = lay_out(s);
    const glm::vec3 middle(first_record(layout, shape_kind<sphere>::number));
    const vec3l center(middle);
    random_source u(11);
    double largest = 0;
    for (int power = 0; power <= 5; ++power) {
        const double distance = power == 0 ? 2 : std::pow(10.0, power);
        rays r;
        for (int i = 0; i < 20000; ++i) {
            const dvec3 from(random_direction(u)), aside = glm::normalize(glm::cross(from, dvec3(random_direction(u))));
            r.aim(glm::vec3(from * distance + dvec3(middle)), dvec3(middle) + 0.98 * static_cast<double>(u()) * aside);
        }
        const auto hits = this->trace(s, r);
        EXPECT_EQ(hits.misses(), 0u) << "distance " << distance;
        for (std::size_t i = 0; i < r.size(); ++i) {
            const vec3l f = vec3l(r.origins[i]) - center, d(r.directions[i]);
            const real a = dot(d, d), b = dot(f, d), c = dot(f, f) - 1;
            const real t = (-b - std::sqrt(b * b - a * c)) / a;
            largest = std::max(
                largest, static_cast<double>(std::abs(static_cast<real>(hits.places[i].w) - t)) / ulp(distance));
        }
    }
    this->report("B1", "largest error of t, units in the last place of the distance:", largest);
    EXPECT_LE(largest, 4.0);
}

TYPED_TEST_P(hard_cases, b2_a_large_sphere_is_hit_from_close_above)
{
    auto s = empty_scene(dvec3(0));
    s.spheres = {{dvec3(0), 1e6, 0}};
    rays r;
    r.add({0, 1e6f + 1, 0}, {0.8f, -0.6f, 0});
    const auto hits = this->trace(s, r);
    // From the floats as they are, in long double.
    const real b = 1000001.0L * static_cast<real>(0.6f),
               a
        = static_cast<real>(0.8f) * static_cast<real>(0.8f) + static_cast<real>(0.6f) * static_cast<real>(0.6f);
    const real t = (b - std::sqrt(b * b - a * 2000001.0L)) / a;
    this->report("B2", "relative error of t, 1 m above a sphere of 1000 km:",
        static_cast<double>(std::abs(static_cast<real>(hits.places[0].w) / t - 1)));
    // A square root of 1000 km that is off by 2.5 units of 1/16 m, which GPUs may be, moves the height above the
    // sphere.
    const double height_error = this->exact() ? 0 : 2.5 / 16;
    EXPECT_NEAR(static_cast<double>(hits.places[0].w), 1.666668, 2e-6 + height_error / 0.6);

    // Things that float coordinates cannot resolve beside it are refused.
    s.spheres.push_back({{0, 1e6 + 1, 0}, 1, 0});
    try {
        lay_out(s);
        ADD_FAILURE() << "a ball of 1 m on a sphere of 1000 km was accepted";
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find("spheres[1]"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("single precision"), std::string::npos) << e.what();
    }
}

TYPED_TEST_P(hard_cases, b3_hits_lie_on_their_quadric)
{
    random_source u(13);
    double far_t = 0, off = 0;
    {
        auto s = empty_scene({0, 2, 0});
        s.cylinders = {{{0, 0, -1}, {0, 0, 1}, 1, 0}};
        const auto layout = lay_out(s);
        rays r;
        r.add(glm::vec3(dvec3(-1000, 0.999, 0) - layout.center), {1, 0, 0});
        const auto hits = this->trace(s, r);
        const auto axis = first_record(layout, detail::quadric_number);
        const real y = static_cast<real>(r.origins[0].y) - static_cast<real>(axis.y),
                   x = static_cast<real>(r.origins[0].x) - static_cast<real>(axis.x);
        const real t = -x - std::sqrt(1 - y * y);
        far_t = static_cast<double>(std::abs(static_cast<real>(hits.places[0].w) - t)) / ulp(1000);
    }
    for (int shape = 0; shape < 3; ++shape)
        for (int variant = 0; variant < 8; ++variant) {
            auto s = empty_scene({3, 0.5, 1});
            const dvec3 base(random_direction(u)),
                top = base + (0.3 + 2 * static_cast<double>(u())) * dvec3(random_direction(u));
            const double radius = 0.1 + static_cast<double>(u());
            if (shape == 0)
                s.cylinders = {{base, top, radius, 0}};
            if (shape == 1)
                s.cones = {{base, top, radius, 0}};
            if (shape == 2)
                s.paraboloids = {{base, top, radius, 0}};
            const auto layout = lay_out(s);
            const auto* q = &layout.records[layout.table(detail::quadric_number).first];
            const vec3l origin(q[0]), ax(q[1]), ay(q[2]), az(q[3]);
            const real a = static_cast<real>(q[1].w), b = static_cast<real>(q[2].w), c = static_cast<real>(q[3].w);
            rays r;
            for (int i = 0; i < 4000; ++i) {
                const double distance = std::pow(10.0, 3 * static_cast<double>(u()));
                const dvec3 inside = glm::mix(base, top, static_cast<double>(u())) - layout.center
                    + 0.9 * radius * dvec3(random_direction(u));
                r.aim(glm::vec3(inside + distance * dvec3(random_direction(u))), inside);
            }
            const auto hits = this->trace(s, r);
            EXPECT_LT(hits.misses(), r.size() * 7 / 8);
            for (std::size_t i = 0; i < r.size(); ++i) {
                if (!hits.hit(i))
                    continue;
                const vec3l p(hits.places[i]), f = p - origin, l(dot(f, ax), dot(f, ay), dot(f, az));
                const real value = l.x * l.x + l.y * l.y + a * l.z * l.z + b * l.z + c;
                const real slope = 2 * length(vec3l(l.x, l.y, a * l.z + b / 2));
                if (slope < static_cast<real>(radius) * 1e-3L) // a cone's apex
                    continue;
                const double size = static_cast<double>(length(p) + length(f)) + radius;
                off = std::max(off, static_cast<double>(std::abs(value / slope)) / ulp(size));
            }
        }
    this->report("B3", "error of t, cylinder at 1000 radii, units in the last place of the distance:", far_t);
    this->report("B3", "largest distance of a hit from its quadric, units in the last place of its coordinates:", off);
    EXPECT_LE(far_t, 4.0);
    EXPECT_LE(off, 8.0);
}

TYPED_TEST_P(hard_cases, b4_no_ray_escapes_a_closed_mesh)
{
    // Rays aimed anywhere, at edges and at vertices; the mesh in the scene's middle and near its rim.
    std::size_t escaped = 0, cast = 0;
    for (const double aside : {0.0, 30.0}) {
        auto s = empty_scene({-aside, 0, 0});
        s.polygons = icosphere({0.1 + aside, 0.2, -0.3}, 1, 1);
        const auto layout = lay_out(s);
        const dvec3 center = dvec3(0.1 + aside, 0.2, -0.3) - layout.center;
        random_source u(14);
        rays r;
        for (int i = 0; i < 500000; ++i) {
            const glm::vec3 o(center + 0.7 * static_cast<double>(u()) * dvec3(random_direction(u)));
            const auto& v = s.polygons[u.below(static_cast<std::uint32_t>(s.polygons.size()))].vertices;
            const double along = i % 3 == 0 ? 0.0 : static_cast<double>(u());
            if (i % 3 == 2)
                r.add(o, random_direction(u));
            else
                r.aim(o, glm::mix(v[0], v[1], along) - layout.center);
        }
        escaped += this->trace(s, r).misses();
        cast += r.size();
    }
    this->report("B4", "rays that escape of 1,000,000 from inside a mesh:", static_cast<double>(escaped));
    EXPECT_EQ(cast, 1000000u);
    EXPECT_EQ(escaped, 0u);
}

TYPED_TEST_P(hard_cases, b4_no_ray_passes_between_two_polygons)
{
    // Two rectangles with a common edge, folded towards the rays at any angle, flat and grazing ones included.
    random_source u(15);
    std::size_t missed = 0;
    for (int fold = 0; fold < 40; ++fold) {
        const double angle = fold % 4 == 0 ? 0.0
            : fold % 4 == 1                ? 1.56 * static_cast<double>(u())
                                           : std::pow(10.0, -1 - 5 * static_cast<double>(u()));
        const dvec3 along(random_direction(u)), up0(random_direction(u));
        const dvec3 side = glm::normalize(glm::cross(along, up0)), up = glm::cross(side, along);
        const dvec3 wing_a = std::cos(angle) * side + std::sin(angle) * up,
                    wing_b = -std::cos(angle) * side + std::sin(angle) * up;
        const dvec3 p = 0.5 * dvec3(random_direction(u)), q = p + along;
        auto s = empty_scene({1, 2, 1});
        s.polygons = {{{p, q, q + wing_a, p + wing_a}, 0}, {{q, p, p + wing_b, q + wing_b}, 0}};
        const auto layout = lay_out(s);
        rays r;
        for (int i = 0; i < 5000; ++i) {
            const dvec3 target = glm::mix(p, q, 0.01 + 0.98 * static_cast<double>(u()));
            // Between the wings, at times close to one.
            const double lowest = angle + (i % 2 == 0 ? 1e-3 : 0.1),
                         at = lowest + (M_PI - 2 * lowest) * (i % 4 == 0 ? 0.0 : static_cast<double>(u()));
            const dvec3 away = std::cos(at) * side + std::sin(at) * up + (2 * static_cast<double>(u()) - 1) * along;
            r.aim(glm::vec3(target + 0.9 * away - layout.center), target - layout.center);
        }
        missed += this->trace(s, r).misses();
    }
    this->report("B4", "rays that pass between of 200,000 aimed at a common edge:", static_cast<double>(missed));
    EXPECT_EQ(missed, 0u);
}

} // namespace photongrid::testing
