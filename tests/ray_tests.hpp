// Hard cases of ray tracing (docs/hard_cases.md), on any backend. References are long double arithmetic written here,
// or analytic answers; then the serial backend, bit for bit. Each largest error is printed as "hard case ...". Included
// by each on_<backend>.cpp.
#pragma once

#include "photon_sets.hpp"
#include "render_tests.hpp"
#include "scene_file.hpp"
#include "test_kernels.hpp"

namespace photongrid::testing {

using real = long double;

/// Vectors of the references: long double throughout.
struct vec3l {
    real x = 0, y = 0, z = 0;
    vec3l() = default;
    vec3l(real a, real b, real c) : x(a), y(b), z(c) {}
    template <class V>
    explicit vec3l(const V& v) : x(static_cast<real>(v.x)), y(static_cast<real>(v.y)), z(static_cast<real>(v.z))
    {
    }
    friend vec3l operator+(vec3l a, vec3l b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend vec3l operator-(vec3l a, vec3l b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend vec3l operator*(real s, vec3l a) { return {s * a.x, s * a.y, s * a.z}; }
    friend real dot(vec3l a, vec3l b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend real length(vec3l a) { return std::sqrt(dot(a, a)); }
};

/// The distance between floats near x.
inline double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(std::abs(x)), -126) - 23); }

/// A random unit vector, rounded to float.
inline glm::vec3 random_direction(random_source& u)
{
    for (;;) {
        const dvec3 v(2 * u() - 1, 2 * u() - 1, 2 * u() - 1);
        const double l = glm::length(v);
        if (l > 0.01 && l <= 1)
            return glm::vec3(v / l);
    }
}

/// A scene to put shapes into: materials white and glass, a bulb.
inline scene empty_scene(const dvec3& bulb)
{
    scene s;
    s.name = "shapes";
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"glass", material_kind::glass, dvec3(1), 1.5}};
    s.point_lights = {{"bulb", bulb, dvec3(1)}};
    return s;
}

/// A sphere of triangles: an icosahedron, each face split into four, `splits` times.
inline std::vector<polygon> icosphere(const dvec3& center, double radius, int splits)
{
    const double g = 0.5 * (1 + std::sqrt(5.0));
    const dvec3 v[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
        {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int f[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2},
        {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10},
        {8, 6, 7}, {9, 8, 1}};
    std::vector<std::array<dvec3, 3>> faces;
    for (const auto& t : f)
        faces.push_back({glm::normalize(v[t[0]]), glm::normalize(v[t[1]]), glm::normalize(v[t[2]])});
    for (; splits > 0; --splits) {
        std::vector<std::array<dvec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            finer.push_back({a, ab, ca});
            finer.push_back({ab, b, bc});
            finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        faces = std::move(finer);
    }
    std::vector<polygon> polygons;
    for (const auto& [a, b, c] : faces)
        polygons.push_back({{center + radius * a, center + radius * b, center + radius * c}, 0});
    return polygons;
}

/// Rays, recentred as the scene's records are, and the directions in which others leave from where they hit.
struct rays {
    std::vector<glm::vec4> origins, directions, leavings;
    void add(glm::vec3 o, glm::vec3 d, glm::vec3 leaving = {0, 0, 1})
    {
        origins.emplace_back(o, 0.0f);
        directions.emplace_back(d, 0.0f);
        leavings.emplace_back(leaving, 0.0f);
    }
    /// From o towards a point.
    void aim(const glm::vec3& o, const dvec3& target) { add(o, glm::vec3(glm::normalize(target - dvec3(o)))); }
    std::size_t size() const { return origins.size(); }
};

/// What ray_probe.glsl says of them.
struct ray_hits {
    std::vector<glm::vec4> places, facings, starts;
    bool hit(std::size_t i) const { return places[i].w >= 0; }
    std::size_t misses() const
    {
        return static_cast<std::size_t>(
            std::count_if(places.begin(), places.end(), [](const auto& p) { return !(p.w >= 0); }));
    }
};

template <class Tag>
class hard_cases : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    template <class Device>
    static ray_hits trace_on(Device& b, const scene& s, const rays& r)
    {
        const auto device = upload_scene(b, s);
        auto out = std::array{b.template make<glm::vec4>(r.size()), b.template make<glm::vec4>(r.size()),
            b.template make<glm::vec4>(r.size())};
        const auto o = b.upload(std::span<const glm::vec4>(r.origins)),
                   d = b.upload(std::span<const glm::vec4>(r.directions)),
                   l = b.upload(std::span<const glm::vec4>(r.leavings));
        b.template run<kernels::ray_probe>({static_cast<uint>(r.size()), 0u, device.about.features},
            {.scene_layout = device.about.layout}, reads(device.records, o, d, l), writes(out[0], out[1], out[2]));
        return {b.download(out[0]), b.download(out[1]), b.download(out[2])};
    }

    /// Rays against a scene, on the device; where arithmetic is exact, every bit must be serial's.
    ray_hits trace(const scene& s, const rays& r)
    {
        auto mine = trace_on(this->b(), s, r);
        if (exact()) {
            serial_backend serial;
            const auto theirs = trace_on(serial, s, r);
            EXPECT_EQ(count_different_bits(mine.places, theirs.places), 0u) << "of " << r.size();
            EXPECT_EQ(count_different_bits(mine.facings, theirs.facings), 0u) << "of " << r.size();
            EXPECT_EQ(count_different_bits(mine.starts, theirs.starts), 0u) << "of " << r.size();
        }
        return mine;
    }

    bool exact() { return this->b().caps().exact_division && this->b().caps().exact_sqrt; }

    /// Irradiance of the scene's lights at points (recentred) with normals.
    std::vector<glm::vec4> direct_light_at(
        const scene& s, const std::vector<dvec3>& points, const std::vector<dvec3>& normals, uint samples)
    {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        std::vector<glm::vec4> p, n;
        for (std::size_t i = 0; i < points.size(); ++i) {
            p.emplace_back(glm::vec3(points[i] - device.about.center), 1.0f);
            n.emplace_back(glm::vec3(normals[i]), 0.0f);
        }
        detail::eye_hits<B> hits(b, p.size());
        hits.points = b.upload(std::span<const glm::vec4>(p));
        hits.surfaces = b.upload(std::span<const glm::vec4>(n));
        auto settings = s.render;
        settings.light_samples = samples;
        auto irradiance = b.template make<glm::vec4>(p.size());
        detail::direct_light(b, device, hits, settings, 0, p.size(), irradiance);
        return b.download(irradiance);
    }
};
TYPED_TEST_SUITE_P(hard_cases);

// --- B: intersection
// --------------------------------------------------------------------------------------------------

TYPED_TEST_P(hard_cases, b1_far_spheres_are_hit_within_rounding_of_the_distance)
{
    auto s = empty_scene({0, 2, 0});
    s.spheres = {{dvec3(0), 1, 0}};
    const auto about = lay_out(s);
    const vec3l center(glm::vec3(about.records[0]));
    random_source u(11);
    double largest = 0;
    for (int power = 0; power <= 5; ++power) {
        const double distance = power == 0 ? 2 : std::pow(10.0, power);
        rays r;
        for (int i = 0; i < 20000; ++i) {
            const dvec3 from(random_direction(u)), aside = glm::normalize(glm::cross(from, dvec3(random_direction(u))));
            r.aim(glm::vec3(from * distance + dvec3(glm::vec3(about.records[0]))),
                dvec3(glm::vec3(about.records[0])) + 0.98 * static_cast<double>(u()) * aside);
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
    EXPECT_NEAR(static_cast<double>(hits.places[0].w), 1.666668, 2e-6);

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
        const auto about = lay_out(s);
        rays r;
        r.add(glm::vec3(dvec3(-1000, 0.999, 0) - about.center), {1, 0, 0});
        const auto hits = this->trace(s, r);
        const real y = static_cast<real>(r.origins[0].y) - static_cast<real>(about.records[0].y),
                   x = static_cast<real>(r.origins[0].x) - static_cast<real>(about.records[0].x);
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
            const auto about = lay_out(s);
            const auto& q = about.records;
            const vec3l origin(q[0]), ax(q[1]), ay(q[2]), az(q[3]);
            const real a = static_cast<real>(q[1].w), b = static_cast<real>(q[2].w), c = static_cast<real>(q[3].w);
            rays r;
            for (int i = 0; i < 4000; ++i) {
                const double distance = std::pow(10.0, 3 * static_cast<double>(u()));
                const dvec3 inside = glm::mix(base, top, static_cast<double>(u())) - about.center
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
        const auto about = lay_out(s);
        const dvec3 center = dvec3(0.1 + aside, 0.2, -0.3) - about.center;
        random_source u(14);
        rays r;
        for (int i = 0; i < 500000; ++i) {
            const glm::vec3 o(center + 0.7 * static_cast<double>(u()) * dvec3(random_direction(u)));
            const auto& v = s.polygons[u.below(static_cast<std::uint32_t>(s.polygons.size()))].vertices;
            const double along = i % 3 == 0 ? 0.0 : static_cast<double>(u());
            if (i % 3 == 2)
                r.add(o, random_direction(u));
            else
                r.aim(o, glm::mix(v[0], v[1], along) - about.center);
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
        const auto about = lay_out(s);
        rays r;
        for (int i = 0; i < 5000; ++i) {
            const dvec3 target = glm::mix(p, q, 0.01 + 0.98 * static_cast<double>(u()));
            // Between the wings, at times close to one.
            const double lowest = angle + (i % 2 == 0 ? 1e-3 : 0.1),
                         at = lowest + (M_PI - 2 * lowest) * (i % 4 == 0 ? 0.0 : static_cast<double>(u()));
            const dvec3 away = std::cos(at) * side + std::sin(at) * up + (2 * static_cast<double>(u()) - 1) * along;
            r.aim(glm::vec3(target + 0.9 * away - about.center), target - about.center);
        }
        missed += this->trace(s, r).misses();
    }
    this->report("B4", "rays that pass between of 200,000 aimed at a common edge:", static_cast<double>(missed));
    EXPECT_EQ(missed, 0u);
}

/// A shape alone in a scene of any size, rays that hit it, and rays that leave the hits again.
inline void reintersect(std::uint64_t seed, scene& s, rays& r)
{
    random_source u(seed);
    const auto number = [&] { return static_cast<double>(u()); };
    const double size = std::pow(10.0, 16 * number() - 8);
    const dvec3 bulb = size * dvec3(random_direction(u)),
                at = -number() * bulb + 0.1 * size * dvec3(random_direction(u));
    const double own = size * std::pow(10.0, -3 * number()), radius = own * (0.05 + number());
    const dvec3 axis(random_direction(u));
    s = empty_scene(bulb);
    switch (seed % 6) {
    case 0: s.spheres = {{at, own, 0}}; break;
    case 1: s.cylinders = {{at, at + own * axis, radius, 0}}; break;
    case 2: s.cones = {{at, at + own * axis, radius, 0}}; break;
    case 3: s.paraboloids = {{at, at + own * axis, radius, 0}}; break;
    case 4: s.disks = {{at, axis, own, 0}}; break;
    default: {
        const dvec3 e = own * glm::normalize(glm::cross(axis, dvec3(random_direction(u)))),
                    f = radius * glm::normalize(glm::cross(axis, e));
        s.polygons = {{{at, at + e, at + e + f, at + f}, 0}};
    }
    }
    const auto about = lay_out(s);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 target = at - about.center + own * number() * axis + 0.9 * radius * dvec3(random_direction(u));
        const dvec3 back(random_direction(u));
        r.aim(glm::vec3(target + size * std::pow(10.0, -3 * number()) * back), target);
        r.leavings.back() = glm::vec4(random_direction(u), 0.0f);
    }
}

/// How many of the rays that leave convex shapes outwards, or flat ones on either side, hit them again.
template <class Trace>
std::size_t count_reintersections(std::uint64_t first, std::uint64_t past, Trace trace, std::size_t& rays_cast)
{
    std::size_t again = 0;
    for (std::uint64_t seed = first; seed < past; ++seed) {
        scene s;
        rays r;
        reintersect(seed, s, r);
        auto hits = trace(s, r);
        // Once more, now that the normals are known: outwards from round shapes, every fourth ray close to the surface.
        const bool flat = seed % 6 >= 4;
        for (std::size_t i = 0; i < r.size(); ++i) {
            const dvec3 n = glm::normalize(dvec3(hits.facings[i]));
            dvec3 l(r.leavings[i]);
            if (i % 4 == 0)
                l = glm::normalize(l - n * (glm::dot(l, n) * (1 - std::pow(10.0, -static_cast<double>(i % 5)))));
            if (glm::dot(l, n) < 0 && !flat)
                l = l - 2 * glm::dot(l, n) * n;
            r.leavings[i] = glm::vec4(glm::vec3(l), 0.0f);
        }
        hits = trace(s, r);
        rays away;
        for (std::size_t i = 0; i < r.size(); ++i)
            if (hits.hit(i) && (flat || glm::dot(dvec3(r.leavings[i]), dvec3(hits.facings[i])) >= 0))
                away.add(glm::vec3(hits.starts[i]), glm::vec3(r.leavings[i]));
        if (away.size() == 0)
            continue;
        const auto second = trace(s, away);
        const std::size_t n = away.size() - second.misses();
        if (n != 0)
            std::printf("  shape %d of seed %d: %zu of %zu rays hit their own surface\n", static_cast<int>(seed % 6),
                static_cast<int>(seed), n, away.size());
        again += n;
        rays_cast += away.size();
    }
    return again;
}

TYPED_TEST_P(hard_cases, b5_rays_that_leave_a_surface_do_not_hit_it)
{
    std::size_t cast = 0;
    const auto again = count_reintersections(
        0, 60, [&](const scene& s, const rays& r) { return this->trace(s, r); }, cast);
    this->report(
        "B5", "rays that hit the surface they leave of " + std::to_string(cast) + ":", static_cast<double>(again));
    EXPECT_GT(cast, 20000u);
    EXPECT_EQ(again, 0u);
}

TYPED_TEST_P(hard_cases, long_b5_rays_that_leave_a_surface_do_not_hit_it)
{
    std::size_t cast = 0;
    const auto again = count_reintersections(
        1000, 2000, [&](const scene& s, const rays& r) { return this->trace_on(this->b(), s, r); }, cast);
    this->report(
        "B5", "rays that hit the surface they leave of " + std::to_string(cast) + ":", static_cast<double>(again));
    EXPECT_EQ(again, 0u);
}

TYPED_TEST_P(hard_cases, b5_rays_inside_a_sphere_reach_its_other_side)
{
    random_source u(16);
    double largest = 0;
    for (int n = 0; n < 10; ++n) {
        const double radius = std::pow(10.0, 16 * static_cast<double>(u()) - 8);
        auto s = empty_scene(dvec3(0));
        s.spheres = {{0.5 * radius * dvec3(random_direction(u)), radius, 0}};
        const auto about = lay_out(s);
        const dvec3 center(about.records[0]);
        rays r;
        for (int i = 0; i < 5000; ++i) {
            r.add(glm::vec3(center), random_direction(u), random_direction(u));
            if (glm::dot(dvec3(r.directions.back()), dvec3(r.leavings.back())) > 0)
                r.leavings.back() *= -1.0f;
        }
        const auto hits = this->trace(s, r);
        rays on;
        for (std::size_t i = 0; i < r.size(); ++i)
            on.add(glm::vec3(hits.starts[i]), glm::vec3(r.leavings[i]));
        const auto second = this->trace(s, on);
        EXPECT_EQ(second.misses(), 0u);
        for (std::size_t i = 0; i < r.size(); ++i) {
            const vec3l f = vec3l(on.origins[i]) - vec3l(center), d(on.directions[i]);
            const real a = dot(d, d), b = dot(f, d),
                       c = dot(f, f) - static_cast<real>(about.records[0].w) * static_cast<real>(about.records[0].w);
            const real t = (-b + std::sqrt(b * b - a * c)) / a;
            largest = std::max(largest,
                static_cast<double>(std::abs(static_cast<real>(second.places[i].w) - t) / static_cast<real>(radius)));
        }
    }
    this->report("B5", "largest error of t inside a sphere, radii:", largest);
    EXPECT_LE(largest, 1e-4); // of chords hardly longer than the ray's own distance from the surface
}

/// A closed room of 1 m whose ceiling is a lamp, `gap` below it.
inline scene room_under_a_lamp(double gap)
{
    scene s = empty_scene(dvec3(0));
    s.point_lights.clear();
    const auto wall = [&](dvec3 a, dvec3 b, dvec3 c, dvec3 d) { s.polygons.push_back({{a, b, c, d}, 0}); };
    wall({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
    wall({0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0});
    wall({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
    wall({0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0});
    wall({0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0});
    wall({1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1});
    s.rectangle_lights = {{"ceiling", {0, 1 - gap, 0}, {1, 0, 0}, {0, 0, 1}, dvec3(1)}};
    s.render = {.width = 8, .height = 8, .photons = 20000, .k = 50, .grid = {8, 8, 8}, .max_radius = 0.3};
    return s;
}

TYPED_TEST_P(hard_cases, b6_nothing_blocks_the_way_to_a_lamp_close_to_a_wall)
{
    const auto s = room_under_a_lamp(1e-5);
    random_source u(17);
    std::vector<dvec3> points, normals;
    for (int i = 0; i < 100000; ++i) {
        const double a = static_cast<double>(u()),
                     h = 1 - 1e-5 - std::pow(10.0, -4 * static_cast<double>(u())) * (1 - 2e-5);
        switch (i % 5) {
        case 0: points.emplace_back(a, 0, static_cast<double>(u())), normals.emplace_back(0, 1, 0); break;
        case 1: points.emplace_back(0, h, a), normals.emplace_back(1, 0, 0); break;
        case 2: points.emplace_back(1, h, a), normals.emplace_back(-1, 0, 0); break;
        case 3: points.emplace_back(a, h, 0), normals.emplace_back(0, 0, 1); break;
        default: points.emplace_back(a, h, 1), normals.emplace_back(0, 0, -1);
        }
    }
    const auto light = this->direct_light_at(s, points, normals, 1);
    std::size_t dark = 0;
    for (const auto& e : light)
        dark += e.x > 0 ? 0u : 1u;
    this->report("B6", "points of 100,000 in a lamp's sight that its rays do not reach:", static_cast<double>(dark));
    EXPECT_EQ(dark, 0u);
}

TYPED_TEST_P(hard_cases, b7_degenerate_rays_hit_nothing)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const auto s = all_shapes();
    rays r;
    for (const float bad : {nan, infinity, -infinity})
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 o(0.1f, 0.2f, 0.3f), d(0, -1, 0);
            o[axis] = bad;
            r.add(o, {0.36f, -0.48f, 0.8f});
            d[axis] = bad;
            if (axis != 1 || bad != -infinity)
                r.add({0.1f, 0.2f, 0.3f}, d);
        }
    r.add({0.1f, 0.2f, 0.3f}, {nan, nan, nan});
    const auto hits = this->trace_on(this->b(), s, r);
    EXPECT_EQ(hits.misses(), r.size());

    // In the plane of a disk and of a polygon.
    auto flat = empty_scene({0, 1, 0});
    flat.disks = {{{0, 0, 0}, {0, 1, 0}, 1, 0}};
    flat.polygons = {{{{-1, -0.5, -1}, {-1, -0.5, 1}, {1, -0.5, 1}, {1, -0.5, -1}}, 0}};
    const auto center = lay_out(flat).center;
    rays along;
    along.add(glm::vec3(dvec3(-2, 0, 0) - center), {1, 0, 0});
    along.add(glm::vec3(dvec3(-2, -0.5, 0) - center), {1, 0, 0});
    along.add(glm::vec3(dvec3(-2, -0.5, 0) - center), {1, -0.0f, 0});
    EXPECT_EQ(this->trace(flat, along).misses(), 3u);

    flat.polygons[0].vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    EXPECT_THROW(lay_out(flat), std::invalid_argument);
}

TYPED_TEST_P(hard_cases, b8_bases_are_orthonormal)
{
    random_source u(18);
    std::vector<glm::vec4> normals = {{0, 0, 1, 0}, {0, 0, -1, 0}, {-0.0f, -0.0f, -1, 0}, {-0.0f, 0, 1, 0},
        {1, 0, -0.0f, 0}, {0, 1, 0, 0}, {0.0447102f, 0, -0.999f, 0}};
    for (int i = 0; i < 1000000; ++i) {
        if (i % 2 == 0) {
            normals.emplace_back(random_direction(u), 0.0f);
            continue;
        }
        const double tilt = std::pow(10.0, -8 * static_cast<double>(u())),
                     turn = 2 * M_PI * static_cast<double>(u()); // close to -z
        normals.emplace_back(
            glm::vec3(dvec3(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt))), 0.0f);
    }
    std::vector<glm::vec4> numbers(normals.size(), glm::vec4(0.5f));
    auto& b = this->b();
    auto first = b.template make<glm::vec4>(normals.size()), second = b.template make<glm::vec4>(normals.size()),
         diffuse = b.template make<glm::vec4>(normals.size()), anywhere = b.template make<glm::vec4>(normals.size());
    const auto n = b.upload(std::span<const glm::vec4>(normals)), r = b.upload(std::span<const glm::vec4>(numbers));
    b.template run<kernels::basis_probe>(
        static_cast<uint>(normals.size()), {}, reads(n, r), writes(first, second, diffuse, anywhere));
    const auto x = b.download(first), y = b.download(second);
    double length_error = 0, angle_error = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const vec3l a(x[i]), c(y[i]), z(normals[i]);
        length_error = std::max(
            {length_error, static_cast<double>(std::abs(length(a) - 1)), static_cast<double>(std::abs(length(c) - 1))});
        angle_error = std::max({angle_error, static_cast<double>(std::abs(dot(a, c))),
            static_cast<double>(std::abs(dot(a, z))), static_cast<double>(std::abs(dot(c, z)))});
    }
    this->report("B8", "largest error of an axis' length:", length_error);
    this->report("B8", "largest dot product of two axes:", angle_error);
    EXPECT_LE(length_error, 2 * 0x1p-22);
    EXPECT_LE(angle_error, 1e-6);
}

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
    std::vector<glm::vec4> directions, normals, refracted, mirrored;
    void add(const glm::vec3& d, const glm::vec3& n, float index)
    {
        directions.emplace_back(d, 0.0f);
        normals.emplace_back(n, index);
    }
    template <class Device>
    void run(Device& b)
    {
        const auto d = b.upload(std::span<const glm::vec4>(directions)),
                   n = b.upload(std::span<const glm::vec4>(normals)),
                   s = b.upload(std::span<const glm::vec4>(n_scene()));
        auto r = b.template make<glm::vec4>(directions.size()), m = b.template make<glm::vec4>(directions.size());
        b.template run<kernels::glass_probe>(static_cast<uint>(directions.size()), {}, reads(s, d, n), writes(r, m));
        refracted = b.download(r);
        mirrored = b.download(m);
    }
    static const std::vector<glm::vec4>& n_scene()
    {
        static const std::vector<glm::vec4> nothing(1);
        return nothing;
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
            static_cast<double>(length(vec3l(g.mirrored[i])
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
    this->report("C2", "largest error of a mirrored direction:", mirror);
    EXPECT_LE(fresnel_error, 1e-6);
    EXPECT_LE(snell, 1e-6);
    EXPECT_LE(mirror, 1e-6);
}

TYPED_TEST_P(hard_cases, c3_glass_in_glass_is_refused)
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
            EXPECT_NE(
                std::string(e.what()).find("spheres[1]: overlaps spheres[0], and both are glass"), std::string::npos)
                << e.what();
        }
    }
    s.spheres[0] = {ball.center, 0.05, 0}; // something else in glass is fine
    EXPECT_NO_THROW(lay_out(s));
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
    const auto t = trace_photons(b, s, device, s.render);
    const auto stats = count_photons(b, t, t.photons.size());
    expect_an_exact_account(stats, s.render.photons);
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
    // From the middle of a ball every ray leaves along its normal: the lamp's radiance, less (n - 1)^2 / (n + 1)^2.
    auto s = room_under_a_lamp(1e-3);
    s.spheres = {{{0.5, 0.5, 0.5}, 0.2, 1}};
    s.camera = {{0.5, 0.5, 0.5}, {0.5, 1, 0.5}, {0, 0, 1}, 40};
    s.render.depth = 1;
    s.render.photons = 500;
    render_stats stats;
    const auto im = render(this->b(), s, s.render, {}, stats);
    double largest = 0;
    for (const auto& p : im.pixels)
        largest = std::max(largest, std::abs(static_cast<double>(p.x) / (0.96 / M_PI) - 1));
    this->report("C5", "largest relative error of a lamp seen from inside a ball:", largest);
    EXPECT_LE(largest, 1e-5);
}

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
    // On a wall, from 1e-5 m to 1 m under a ceiling that is a lamp; each distance at many places.
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
    b.template run<kernels::basis_probe>(
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

// --- E: random numbers
// ------------------------------------------------------------------------------------------------

/// What random_probe.glsl makes of keys.
struct random_numbers {
    std::vector<glm::uvec4> hashes;
    std::vector<glm::vec4> numbers;
    std::vector<float> units;
};
template <class Device>
random_numbers draw_numbers(Device& b, const std::vector<glm::uvec4>& keys)
{
    const auto k = b.upload(std::span<const glm::uvec4>(keys));
    auto h = b.template make<glm::uvec4>(keys.size());
    auto r = b.template make<glm::vec4>(keys.size());
    auto f = b.template make<float>(keys.size());
    b.template run<kernels::random_probe>(static_cast<uint>(keys.size()), {.unused = 0u}, reads(k), writes(h, r, f));
    return {b.download(h), b.download(r), b.download(f)};
}

TYPED_TEST_P(hard_cases, e1_random_numbers_stay_below_one)
{
    const uint bits[] = {0u, 1u, 0xFFu, 0x100u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFF7Fu, 0xFFFFFF80u, 0xFFFFFFFFu};
    std::vector<glm::uvec4> keys;
    for (const uint b : bits)
        keys.emplace_back(b, 0u, 0u, 0u);
    const auto r = draw_numbers(this->b(), keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        EXPECT_EQ(r.units[i], static_cast<float>(std::ldexp(static_cast<double>(keys[i].x / 256u), -24))) << keys[i].x;
        EXPECT_LT(r.units[i], 1.0f);
    }
    EXPECT_EQ(r.units.back(), 1 - 0x1p-24f);
}

TYPED_TEST_P(hard_cases, e3_hashes_have_known_answers)
{
    // pcg4d of the JCGT paper, worked out in Python's integers.
    const std::vector<glm::uvec4> keys
        = {glm::uvec4(0u), {1u, 2u, 3u, 4u}, glm::uvec4(0xFFFFFFFFu), {123456789u, 7u, 1u, 20031u}};
    const std::vector<glm::uvec4> known
        = {{0x0F02F829u, 0x2D568769u, 0x32B0C43Bu, 0xD32548EAu}, {0x3622CD16u, 0xF11471D8u, 0xE1109B3Fu, 0x02B94C2Fu},
            {0x974ED892u, 0xC015DC67u, 0x9F955760u, 0xA1BBA208u}, {0x2F4B0C9Eu, 0x2C8A81EDu, 0x6B2E1A85u, 0x7FC237FFu}};
    const auto r = draw_numbers(this->b(), keys);
    EXPECT_EQ(r.hashes, known);
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_EQ(static_cast<double>(r.numbers[i][c]), std::ldexp(static_cast<double>(known[i][c] / 256u), -24));
}

/// Chi-squared of pairs over 64 x 64 bins as a standard normal deviate (Wilson and Hilferty).
inline double chi_squared_deviate(const std::vector<std::pair<float, float>>& pairs)
{
    std::vector<double> bins(4096);
    for (const auto& [x, y] : pairs)
        ++bins[static_cast<std::size_t>(x * 64) * 64 + static_cast<std::size_t>(y * 64)];
    const double expected = static_cast<double>(pairs.size()) / 4096;
    double sum = 0;
    for (const double n : bins)
        sum += (n - expected) * (n - expected) / expected;
    const double k = 4095, v = 2 / (9 * k);
    return (std::cbrt(sum / k) - (1 - v)) / std::sqrt(v);
}

TYPED_TEST_P(hard_cases, e3_streams_are_uniform_in_pairs)
{
    // Neighbouring paths, bounces, dimensions and seeds, and the four numbers of a draw: 64 x 64 bins of 262,144 pairs.
    constexpr uint n = 1u << 18;
    double worst = 0;
    const auto keys = [&](auto make) {
        std::vector<glm::uvec4> k(n);
        for (uint i = 0; i < n; ++i)
            k[i] = make(i);
        return draw_numbers(this->b(), k).numbers;
    };
    const auto base = keys([](uint i) { return glm::uvec4(i, 1u, 0u, 1u); });
    const auto compare = [&](const std::string& what, const std::vector<glm::vec4>& other) {
        for (int a = 0; a < 4; ++a)
            for (int c = 0; c < 4; ++c) {
                if (&other == &base && a >= c)
                    continue;
                std::vector<std::pair<float, float>> pairs(n);
                for (uint i = 0; i < n; ++i)
                    pairs[i] = {base[i][a], other[i][c]};
                const double z = chi_squared_deviate(pairs);
                worst = std::max(worst, std::abs(z));
                EXPECT_LE(std::abs(z), 5.0) << what << ", numbers " << a << " and " << c;
            }
    };
    compare("within a draw", base);
    compare("path + 1", keys([](uint i) { return glm::uvec4(i + 1u, 1u, 0u, 1u); }));
    compare("bounce + 1", keys([](uint i) { return glm::uvec4(i, 2u, 0u, 1u); }));
    compare("dimension + 1", keys([](uint i) { return glm::uvec4(i, 1u, 1u, 1u); }));
    compare("seed + 1", keys([](uint i) { return glm::uvec4(i, 1u, 0u, 2u); }));
    this->report("E3", "largest chi-squared deviate of pairs, standard deviations:", worst);
}

TYPED_TEST_P(hard_cases, e6_seeds_are_independent)
{
    // Variance of the mean over P seeds of a path's integrand falls as 1/P: log-log slope -1 +- 0.15.
    constexpr uint seeds = 256, pixels = 4096;
    std::vector<glm::uvec4> k;
    for (uint s = 0; s < seeds; ++s)
        for (uint i = 0; i < pixels; ++i)
            k.emplace_back(i, 1u, 0u, 1u + s);
    const auto r = draw_numbers(this->b(), k).numbers;
    std::vector<double> x, y;
    for (uint passes = 1; passes <= seeds; passes *= 2) {
        double variance = 0;
        for (uint i = 0; i < pixels; ++i) {
            double mean = 0;
            for (uint s = 0; s < passes; ++s) {
                const auto& v = r[std::size_t{s} * pixels + i];
                mean += static_cast<double>(v.x * v.y + (v.z < 0.3f ? v.w : 0.0f)) / passes;
            }
            variance += (mean - 0.4) * (mean - 0.4) / pixels; // 1/4 + 0.3/2
        }
        x.push_back(std::log2(passes));
        y.push_back(std::log2(variance));
    }
    double mx = 0, my = 0, xy = 0, xx = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mx += x[i] / static_cast<double>(x.size());
        my += y[i] / static_cast<double>(x.size());
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - mx) * (y[i] - my);
        xx += (x[i] - mx) * (x[i] - mx);
    }
    this->report("E6", "slope of log variance over log passes:", xy / xx);
    EXPECT_NEAR(xy / xx, -1, 0.15);
}

// --- F6: far from the origin
// ------------------------------------------------------------------------------------------

/// The scene moved, exactly where its coordinates and `by` are multiples of 2^-20 below 2^32.
inline scene moved(const scene& s, const dvec3& by) { return detail::moved_back(s, -by); }

/// The scene with its coordinates rounded to multiples of 2^-20.
inline scene rounded_scene(scene s)
{
    const auto to_grid = [](dvec3& v) { v = glm::round(v * 0x1p20) * 0x1p-20; };
    for (auto& x : s.spheres)
        to_grid(x.center);
    for (auto& x : s.cylinders)
        to_grid(x.base), to_grid(x.top);
    for (auto& x : s.cones)
        to_grid(x.base), to_grid(x.apex);
    for (auto& x : s.paraboloids)
        to_grid(x.vertex), to_grid(x.rim);
    for (auto& x : s.disks)
        to_grid(x.center);
    for (auto& x : s.polygons)
        for (auto& v : x.vertices)
            to_grid(v);
    for (auto& x : s.point_lights)
        to_grid(x.position);
    for (auto& x : s.rectangle_lights)
        to_grid(x.corner), to_grid(x.edge_u), to_grid(x.edge_v);
    to_grid(s.camera.position);
    to_grid(s.camera.look_at);
    return s;
}

TYPED_TEST_P(hard_cases, f6_a_scene_far_away_renders_the_same)
{
    auto blocks = read_scene(std::string(PHOTONGRID_SCENES) + "/cornell_blocks.json");
    blocks.render.width = blocks.render.height = 48;
    blocks.render.photons = 8000;
    blocks.render.k = 80;
    for (const auto& s : {rounded_scene(blocks), rounded_scene(all_shapes())}) {
        const dvec3 by(1e6, -1e6, 1e6);
        render_stats a, b;
        const auto here = render(this->b(), s, s.render, {}, a),
                   there = render(this->b(), moved(s, by), s.render, {}, b);
        EXPECT_EQ(count_different_bits(here.pixels, there.pixels), 0u) << s.name;
        EXPECT_EQ(a.photons.emitted, b.photons.emitted);
    }
    // Coordinates that are not multiples: rounding to double at 10^6 moves them by up to 2^-34 m.
    auto s = all_shapes();
    for (auto& x : s.spheres)
        x.center += dvec3(1e-3 / 3, 0, 0);
    s.spheres[0].center.y += 1e-4; // touches the floor
    render_stats a, b;
    const auto here = render(this->b(), s, s.render, {}, a),
               there = render(this->b(), moved(s, dvec3(1e6 + 0.1, 1e6 / 3, -1e6)), s.render, {}, b);
    const double difference = relative_mse(there, here);
    this->report("F6", "relMSE of a scene moved by 10^6 m, coordinates not multiples of 2^-20:", difference);
    EXPECT_LE(difference, 0.005);
}

TYPED_TEST_P(hard_cases, b9_what_is_outside_a_shaft_blocks_nothing_in_it)
{
    // Points and parallelograms anywhere in scenes of few and of more than 32 shapes; some points close above a
    // surface, some parallelograms in the plane of one.
    auto crowd = empty_scene({0, 3, 0});
    crowd.polygons = icosphere({0.5, 0.5, 0}, 0.5, 1);
    for (int i = 0; i < 40; ++i)
        crowd.spheres.push_back({{0.1 * i - 2, 0.3 + 0.02 * i, 0.5}, 0.04, 0});
    for (const auto& s : {all_shapes(), small_cornell(), crowd}) {
        auto& b = this->b();
        const auto device = upload_scene(b, s);
        const glm::vec3 low(device.about.low), size(glm::vec3(device.about.high) - low);
        random_source u(9);
        std::vector<glm::vec4> points, corners, edges_u, edges_v;
        for (int i = 0; i < 20000; ++i) {
            const auto place = [&] { return low + size * glm::vec3(u(), u(), u()); };
            auto from = place(), corner = place(), edge_u = 0.3f * size * random_direction(u),
                 edge_v = 0.3f * size * random_direction(u);
            if (i % 4 == 1)
                from.y = low.y + 1e-5f * size.y; // just above the floor, or below what stands there
            if (i % 4 == 2)
                corner.y = low.y + size.y, edge_u.y = edge_v.y = 0; // on the ceiling
            if (i % 16 == 3)
                edge_v = edge_u; // no area
            points.emplace_back(from, i % 3 == 0 ? 0.0f : u());
            corners.emplace_back(corner, i % 5 == 0 ? 1.0f : u());
            edges_u.emplace_back(edge_u, 0.0f);
            edges_v.emplace_back(edge_v, 0.0f);
        }
        const auto up = [&](const auto& v) { return b.upload(std::span<const glm::vec4>(v)); };
        const auto p = up(points), c = up(corners), eu = up(edges_u), ev = up(edges_v);
        auto answer = b.template make<glm::uvec4>(points.size());
        b.template run<kernels::shaft_probe>({points.size(), 0u, device.about.features},
            {.scene_layout = device.about.layout}, reads(device.records, p, c, eu, ev), writes(answer));
        std::size_t wrong = 0, blocked = 0, empty = 0;
        for (const auto& a : b.download(answer)) {
            wrong += a.x != a.y ? 1u : 0u;
            blocked += a.y;
            empty += a.z == 0 && a.w == 0 ? 1u : 0u;
        }
        EXPECT_EQ(wrong, 0u) << s.name;
        EXPECT_GT(blocked, points.size() / 100) << s.name;
        if (s.polygons.size() < 32) { // else most shafts meet the shapes that share a bit
            EXPECT_GT(empty, points.size() / 100) << s.name;
        }
        this->report("B9", s.name + ": shafts that nothing is in, of 20,000:", static_cast<double>(empty));
    }
}

REGISTER_TYPED_TEST_SUITE_P(hard_cases, b9_what_is_outside_a_shaft_blocks_nothing_in_it,
    b1_far_spheres_are_hit_within_rounding_of_the_distance, b2_a_large_sphere_is_hit_from_close_above,
    b3_hits_lie_on_their_quadric, b4_no_ray_escapes_a_closed_mesh, b4_no_ray_passes_between_two_polygons,
    b5_rays_that_leave_a_surface_do_not_hit_it, long_b5_rays_that_leave_a_surface_do_not_hit_it,
    b5_rays_inside_a_sphere_reach_its_other_side, b6_nothing_blocks_the_way_to_a_lamp_close_to_a_wall,
    b7_degenerate_rays_hit_nothing, b8_bases_are_orthonormal, c1_refraction_is_finite_about_the_critical_angle,
    c2_energy_is_kept_down_to_grazing, c3_glass_in_glass_is_refused, c4_endless_total_reflection_is_cut_off_and_counted,
    c5_a_camera_in_glass_sees_through_it, d2_irradiance_close_to_a_lamp_is_bounded,
    d3_samples_at_the_ends_of_the_unit_interval_are_finite, d4_a_point_light_on_a_surface_is_finite,
    d5_dark_lights_are_refused, e1_random_numbers_stay_below_one, e3_hashes_have_known_answers,
    e3_streams_are_uniform_in_pairs, e6_seeds_are_independent, f6_a_scene_far_away_renders_the_same);

} // namespace photongrid::testing
