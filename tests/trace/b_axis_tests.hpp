// Hard case B3, rays along a quadric's asymptotes: the equation along the ray is linear, and one of its two solutions
// is missing.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

/// A ray along an asymptote of a quadric with radius 1 and height 1, in the quadric's own frame, and where it hits.
struct asymptotic_ray {
    dvec3 origin{0}, direction{0, 0, 1};
    double height = -1;  ///< of the hit, if the quadric were unbounded; outside 0 to 1: it misses
    bool unsure = false; ///< too close to the end of a surface for single precision

    /// The distance of the hit with the quadric, or infinity.
    double distance() const
    {
        const double t = (height - origin.z) / direction.z;
        return t > 0 && height >= 0 && height <= 1 ? t : std::numeric_limits<double>::infinity();
    }
};

/// Shapes 0 and 1, cylinders and paraboloids: parallel to the axis. Shape 2, cones: parallel to a generator, in a plane
/// through the axis.
inline asymptotic_ray random_asymptotic_ray(random_source& u, int shape)
{
    const auto from_to = [&](double a, double b) { return a + (b - a) * static_cast<double>(u()); };
    const double turn = from_to(0, 2 * M_PI), x = from_to(shape == 2 ? -1.5 : 0.0, 1.5), z = from_to(-1, 2),
                 way = u() < 0.5f ? -1 : 1;
    const dvec3 outward(std::cos(turn), std::sin(turn), 0);
    asymptotic_ray r;
    r.origin = x * outward + dvec3(0, 0, z);
    r.direction = {0, 0, way};
    if (shape == 1)
        r.height = x * x;
    if (shape == 2) { // x + z stays the same; the opposite side is x = z - 1
        r.direction = way * glm::normalize(outward - dvec3(0, 0, 1));
        r.height = 0.5 * (x + z + 1);
        r.unsure = std::abs(x + z - 1) < 0.01; // along the surface itself
    }
    r.unsure = r.unsure || std::abs(r.height) < 1e-3 || std::abs(r.height - 1) < 1e-3 || std::abs(r.height - z) < 1e-3
        || (shape == 0 && std::abs(x - 1) < 1e-3);
    return r;
}

TYPED_TEST_P(hard_cases, b3_a_missing_root_is_never_a_hit)
{
    // Something else is hit before or after, a sphere by rays and any distance by shadow rays: only then did a missing
    // root look like one that is near.
    random_source u(16);
    std::size_t hits = 0, stopped = 0, misses = 0, wrong = 0, wrong_shadows = 0, shadows = 0;
    for (int shape = 0; shape < 3; ++shape)
        for (int variant = 0; variant < 8; ++variant) {
            // Half of the axes are exact in single precision.
            const dvec3 w = variant % 2 == 0 ? dvec3(0, 0, 1) : dvec3(random_direction(u)),
                        axis_u = glm::normalize(glm::cross(w, std::abs(w.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
            const glm::dmat3 frame(axis_u, glm::cross(w, axis_u), w);
            const double ball_height = -1.5 + 4 * static_cast<double>(u());
            constexpr double ball_radius = 0.7;
            auto s = empty_scene({0.25, 3, 0.5});
            if (shape == 0)
                s.cylinders = {{dvec3(0), w, 1, 0}};
            if (shape == 1)
                s.paraboloids = {{dvec3(0), w, 1, 0}};
            if (shape == 2)
                s.cones = {{dvec3(0), w, 1, 0}};
            s.spheres = {{ball_height * w, ball_radius, 0}};
            const auto layout = lay_out(s);
            rays r;
            std::vector<double> expected;
            while (r.size() < 500) {
                const auto a = random_asymptotic_ray(u, shape);
                const dvec3 f = a.origin - dvec3(0, 0, ball_height);
                const double b = glm::dot(f, a.direction), half2 = ball_radius * ball_radius - glm::dot(f, f) + b * b,
                             half = std::sqrt(std::max(0.0, half2));
                if (a.unsure || std::abs(half2) < 1e-2 || std::abs(half - std::abs(b)) < 1e-3)
                    continue;
                double t = a.distance();
                if (half2 > 0 && half - b > 0)
                    t = std::min(t, b + half < 0 ? -b - half : half - b);
                const float far = 0.05f + 3 * u();
                if (std::abs(static_cast<double>(far) - t) < 1e-3)
                    continue;
                r.add(glm::vec3(frame * a.origin - layout.center), glm::vec3(frame * a.direction));
                r.leavings.back().w = far;
                expected.push_back(t);
                stopped += t < a.distance() ? 1 : 0;
            }
            const auto found = this->trace(s, r);
            for (std::size_t i = 0; i < r.size(); ++i) {
                const double t = static_cast<double>(found.places[i].w);
                const bool misses_all = std::isinf(expected[i]);
                hits += misses_all ? 0 : 1;
                misses += misses_all ? 1 : 0;
                wrong += (misses_all ? !found.hit(i) : found.hit(i) && std::abs(t - expected[i]) < 1e-4) ? 0 : 1;
                const bool shadow = expected[i] < static_cast<double>(r.leavings[i].w);
                shadows += shadow ? 1 : 0;
                wrong_shadows += (found.starts[i].w > 0) == shadow ? 0 : 1;
            }
        }
    this->report("B3", "wrong hits of 12,000 rays along asymptotes:", static_cast<double>(wrong));
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(wrong_shadows, 0u);
    EXPECT_GT(hits, 4000u);
    EXPECT_GT(misses, 1000u);
    EXPECT_GT(stopped, 2000u);
    EXPECT_GT(shadows, 2000u);
}

} // namespace photongrid::testing
