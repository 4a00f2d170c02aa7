// Hard cases B5 to B8: rays that leave a surface, and rays that are none.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

/// A shape alone in a scene of any size, rays that hit it, and rays that leave the hits again. `smaller`: a factor on
/// its size; below 1 a wall is far behind it.
inline void reintersect(std::uint64_t seed, scene& s, rays& r, double smaller = 1)
{
    random_source u(seed);
    const auto number = [&] { return static_cast<double>(u()); };
    const double size = std::pow(10.0, 16 * number() - 8);
    const dvec3 bulb = size * dvec3(random_direction(u)),
                at = -number() * bulb + 0.1 * size * dvec3(random_direction(u));
    const double own = smaller * size * std::pow(10.0, -3 * (smaller < 1 ? 1 : number())),
                 radius = own * (0.05 + number());
    const dvec3 axis(random_direction(u));
    s = empty_scene(bulb);
    if (smaller < 1) {
        const dvec3 away = glm::normalize(at), u = glm::normalize(glm::cross(away, axis)), v = glm::cross(away, u);
        s.meshes = {
            {"", std::make_shared<const mesh>(mesh{{glm::vec3(-u - v), glm::vec3(u - v), glm::vec3(u)}, {{0, 1, 2}}}),
                glm::dmat3(size), at + size * away, 0}};
    }
    switch (seed % 7) {
    case 0: s.spheres = {{at, own, 0}}; break;
    case 1: s.cylinders = {{at, at + own * axis, radius, 0}}; break;
    case 2: s.cones = {{at, at + own * axis, radius, 0}}; break;
    case 3: s.paraboloids = {{at, at + own * axis, radius, 0}}; break;
    case 4: s.disks = {{at, axis, own, 0}}; break;
    case 5: {
        const dvec3 e = glm::normalize(glm::cross(axis, dvec3(random_direction(u))));
        s.boxes = {{at, own * axis, radius * e, own * glm::cross(axis, e), 0}};
        break;
    }
    default: {
        const dvec3 e = own * glm::normalize(glm::cross(axis, dvec3(random_direction(u)))),
                    f = radius * glm::normalize(glm::cross(axis, e));
        s.polygons = {{{at, at + e, at + e + f, at + f}, 0}};
    }
    }
    const auto layout = lay_out(s);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 target = at - layout.center + own * number() * axis + 0.9 * radius * dvec3(random_direction(u));
        const dvec3 back(random_direction(u));
        r.aim(glm::vec3(target + smaller * size * std::pow(10.0, -3 * number()) * back), target);
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
        const bool flat = seed % 7 == 4 || seed % 7 == 6;
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
            std::printf("  shape %d of seed %d: %zu of %zu rays hit their own surface\n", static_cast<int>(seed % 7),
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
        1000, 2000, [&](const scene& s, const rays& r) { return trace_rays(this->b(), s, r); }, cast);
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
        const auto layout = lay_out(s);
        const auto ball = first_record(layout, shape_kind<sphere>::number);
        const dvec3 center(ball);
        const real radius2 = static_cast<real>(ball.w) * static_cast<real>(ball.w);
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
            const real a = dot(d, d), b = dot(f, d), c = dot(f, f) - radius2;
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
    s.render = {.map = {.photons = 20000, .grid = {8, 8, 8}},
        .estimate = {.k = 50, .max_radius = 0.3},
        .output = {.width = 8, .height = 8}};
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
    const auto hits = trace_rays(this->b(), s, r);
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
    b.template run<probes::basis_probe>(
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

} // namespace photongrid::testing
