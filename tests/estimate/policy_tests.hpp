// Faces, rims, walls, refusals and watched searches, on any backend.
#pragma once

#include "estimators.hpp"

namespace photongrid::testing {

TYPED_TEST_P(estimators, a_photon_on_a_face_is_found_from_any_distance)
{
    // One photon on a face between cells, points on its axis: its distance and the cell that the radius reaches round
    // apart.
    auto& b = this->b();
    for (const int axis : {0, 1, 2})
        for (const int face : {13, 22, 37}) {
            photon_set set;
            uvec3 resolution(1);
            resolution[axis] = 40;
            set.g = make_grid(glm::vec3(0), glm::vec3(1), resolution);
            glm::vec3 p(0.5f);
            p[axis] = static_cast<float>(face) / 40.0f;
            set.positions.emplace_back(p, 0.0f);
            set.powers.emplace_back(1.0f);
            random_source u(static_cast<std::uint64_t>(face));
            std::vector<vec4> points;
            for (int i = 0; i < 5000; ++i) {
                p[axis] = 6 * u() - 3;
                points.emplace_back(p, 1.0f);
            }
            knn_settings k{.k = 1, .max_radius = 10};
            k.bias = bias_kind::paper;
            const auto map = sorted_map(b, upload_photons(b, set), set.g);
            std::size_t lost = 0;
            for (const auto& n : b.download(knn_grid_estimate(b, map, b.upload(std::span<const vec4>(points)), k).used))
                lost += n.x != 1 ? 1u : 0u;
            EXPECT_EQ(lost, 0u) << "axis " << axis << " face " << face;
        }
}

TYPED_TEST_P(estimators, a_radius_holds_the_photons_on_its_rim)
{
    // Eight photons at the radius itself, to the bit, one just beyond, one inside.
    auto& b = this->b();
    photon_set set;
    set.g = make_grid(glm::vec3(0), glm::vec3(1), {4, 4, 4});
    for (int i = 0; i < 8; ++i)
        set.positions.emplace_back(i < 2 ? 0.5f + (i == 0 ? 0.25f : -0.25f) : 0.5f,
            i >= 2 && i < 4 ? 0.5f + (i == 2 ? 0.25f : -0.25f) : 0.5f,
            i >= 4 ? 0.5f + (i % 2 == 0 ? 0.25f : -0.25f) : 0.5f, 0.0f);
    set.positions.emplace_back(0.75000006f, 0.5f, 0.5f, 0.0f);
    set.positions.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
    set.powers.assign(10, vec4(1.0f));
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto points = b.upload(std::span<const vec4>(std::vector<vec4>(1, {0.5f, 0.5f, 0.5f, 1.0f})));
    for (const auto search : all_searches)
        for (const auto bias : all_biases) {
            knn_settings k{.k = 100, .max_radius = 0.25f};
            k.search = search;
            k.bias = bias;
            const auto e = knn_grid_estimate(b, map, points, k);
            EXPECT_EQ(b.download(e.used)[0].x, 9u) << int(search);
            EXPECT_NEAR(b.download(e.irradiance)[0].x, 9 / (M_PI * 0.0625), 1e-4)
                << int(search); // the radius is given: none is left out
        }
}

TYPED_TEST_P(estimators, no_light_comes_through_a_thin_wall)
{
    // A wall 0.01 thick, lit from above; photons on its upper side and on the floor of a corner beside it.
    auto& b = this->b();
    random_source u(9);
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {10, 10, 10});
    for (int i = 0; i < 2000; ++i) {
        s.photons.positions.emplace_back(u(), 0.51f, u(), 0.0f);
        s.photons.powers.emplace_back(1.0f);
        s.directions.emplace_back(0.0f, -1.0f, 0.0f, 0.0f);
        s.normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
    }
    s.points = {{0.5f, 0.51f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}};
    s.point_normals = {{0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f, 0.0f}};
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    const auto points = b.upload(std::span<const vec4>(s.points)),
               normals = b.upload(std::span<const vec4>(s.point_normals));
    double leaked = 0;
    for (const auto search : all_searches) {
        knn_settings k{.k = 50, .max_radius = 0.1f};
        k.search = search;
        const auto leaking = b.download(knn_grid_estimate(b, map, points, normals, k).irradiance);
        EXPECT_GT(leaking[1].x, 0.5f * leaking[0].x);
        for (const leak_policy& leaks :
            {leak_policy{.side = true}, leak_policy{.min_cosine = 0.5f}, leak_policy{.flattening = 11}}) {
            k.leaks = leaks;
            const auto e = knn_grid_estimate(b, map, points, normals, k);
            const auto kept = b.download(e.irradiance);
            EXPECT_EQ(kept[0].x, leaking[0].x); // what was right stays
            EXPECT_EQ(kept[1].x, 0.0f);
            EXPECT_EQ(b.download(e.used)[1].x, 0u);
            leaked = std::max(leaked, static_cast<double>(kept[1].x));
        }
    }
    this->report("A10", "irradiance on the dark side of a wall under any policy:", leaked);
}

TYPED_TEST_P(estimators, no_light_comes_from_a_parallel_surface)
{
    // Two shelves, 0.015 apart, lit from above; most light falls on the upper one. Points on the upper side of both:
    // the normals of all photons agree, and all arrive from the same side.
    auto& b = this->b();
    random_source u(10);
    oriented_set s;
    s.photons.g = make_grid(glm::vec3(0), glm::vec3(1), {10, 10, 10});
    for (int i = 0; i < 4000; ++i) {
        s.photons.positions.emplace_back(u(), i < 2000 ? 0.515f : 0.5f, u(), 0.0f);
        s.photons.powers.emplace_back(i < 2000 ? 100.0f : 1.0f);
        s.directions.emplace_back(0.0f, -1.0f, 0.0f, 0.0f);
        s.normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
    }
    s.points = {{0.5f, 0.515f, 0.5f, 1.0f}, {0.5f, 0.5f, 0.5f, 1.0f}};
    s.point_normals = {{0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f, 0.0f}};
    const auto points = b.upload(std::span<const vec4>(s.points)),
               normals = b.upload(std::span<const vec4>(s.point_normals));
    double leaked = 0;
    for (const auto kind : exact_maps)
        for (const auto search : all_searches) {
            const auto m = this->known(s, kind);
            knn_settings k{.k = 50, .max_radius = 0.1f};
            k.search = search;
            k.leaks = {.side = true};
            EXPECT_GT(b.download(knn_grid_estimate(b, m.map, points, normals, k).irradiance)[1].x, 50000.0f);
            k.leaks.min_cosine = 0.5f;
            const auto kept = b.download(knn_grid_estimate(b, m.map, points, normals, k).irradiance);
            EXPECT_NEAR(kept[0].x, 200000.0f, 80000.0f) << int(search);
            EXPECT_NEAR(kept[1].x, 2000.0f, 800.0f) << int(search);
            leaked = std::max(leaked, static_cast<double>(kept[1].x) / 2000);
        }
    this->report("A10_shelf", "irradiance below a shelf 100 times as bright, over what it is:", leaked);
}

/// Random points on a surface, as photons and as query points: u() from 0 to 1 in, position and normal out.
template <class Surface>
oriented_set on_surface(const Surface& at, const glm::vec3& low, const glm::vec3& high, std::uint64_t seed)
{
    random_source u(seed);
    oriented_set s;
    s.photons.g = make_grid(low, high, {8, 8, 8});
    for (int i = 0; i < 6000; ++i) {
        const auto [position, normal] = at(u(), u());
        s.photons.positions.emplace_back(position, 0.0f);
        s.photons.powers.emplace_back(1.0f);
        s.directions.emplace_back(-normal, 0.0f);
        s.normals.emplace_back(normal, 0.0f);
        if (i < 100) {
            s.points.emplace_back(position, 1.0f);
            s.point_normals.emplace_back(normal, 0.0f);
        }
    }
    return s;
}

TYPED_TEST_P(estimators, no_photon_of_a_round_or_bent_surface_is_lost)
{
    // Nearly all that lies within the radius, and whose normal agrees, counts: on spheres and cylinders, large and
    // small and away from the origin, and where planes meet at an angle.
    auto& b = this->b();
    using glm::vec3;
    const auto direction = [](float u, float v) {
        const float z = 2 * u - 1, r = std::sqrt(std::max(0.0f, 1 - z * z)), a = 6.2831853f * v;
        return vec3(r * std::cos(a), r * std::sin(a), z);
    };
    const auto lost = [&](const oriented_set& s, float radius) {
        knn_settings k{.max_radius = radius};
        k.search = search_kind::fixed_radius;
        k.leaks = {.side = true, .min_cosine = 0.5f};
        const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
        const auto used = b.download(knn_grid_estimate(
            b, map, b.upload(std::span<const vec4>(s.points)), b.upload(std::span<const vec4>(s.point_normals)), k)
                                         .used);
        std::size_t expected = 0, found = 0;
        for (std::size_t q = 0; q < s.points.size(); ++q) {
            found += used[q].x;
            for (std::size_t i = 0; i < s.normals.size(); ++i)
                expected += glm::distance(vec3(s.points[q]), vec3(s.photons.positions[i])) <= radius
                        && glm::dot(s.point_normals[q], s.normals[i]) >= 0.5f
                    ? 1u
                    : 0u;
        }
        EXPECT_GT(expected, 10 * s.points.size());
        return 1 - static_cast<double>(found) / static_cast<double>(expected);
    };
    double worst = 0;
    for (const float size : {1.0f, 0.01f})
        for (const vec3& center : {vec3(0), vec3(3, -2, 1)}) {
            const auto ball = [&](float u, float v) {
                const vec3 n = direction(u, v);
                return std::pair(center + size * n, n);
            };
            const auto tube = [&](float u, float v) {
                const vec3 n = direction(0.5f, v);
                return std::pair(center + size * (n + vec3(0, 0, 2 * u - 1)), n);
            };
            for (const float radius : {0.2f, 0.8f, 3.0f}) {
                const vec3 reach(size);
                worst = std::max(
                    worst, std::abs(lost(on_surface(ball, center - reach, center + reach, 1), radius * size)));
                worst = std::max(
                    worst, std::abs(lost(on_surface(tube, center - reach, center + reach, 2), radius * size)));
            }
        }
    for (const float degrees : {2.0f, 20.0f, 59.0f}) {
        const float angle = glm::radians(degrees);
        const auto roof = [&](float u, float v) {
            const bool turned = u > 0.5f;
            const float along = 2 * u - 1;
            const vec3 way = turned ? vec3(std::cos(angle), -std::sin(angle), 0) : vec3(1, 0, 0);
            return std::pair(
                along * way + vec3(0, 0, v), turned ? vec3(std::sin(angle), std::cos(angle), 0) : vec3(0, 1, 0));
        };
        worst = std::max(worst, std::abs(lost(on_surface(roof, vec3(-1, -1, 0), vec3(1), 3), 0.3f)));
    }
    EXPECT_LT(worst, 1e-3);
    this->report("A10_round", "most photons of round and bent surfaces that min_cosine loses, as a share:", worst);
}

TYPED_TEST_P(estimators, searches_throw_for_wrong_settings)
{
    auto& b = this->b();
    const auto set = make_photons(distribution::uniform, 100, {4, 4, 4}, 1);
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const auto points = b.upload(std::span<const vec4>(make_points(set, 10, 1)));
    knn_settings k{.k = 5, .max_radius = 1};
    k.leaks.side = true;
    EXPECT_THROW(knn_grid_estimate(b, map, points, k), std::invalid_argument);         // no normals of points
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument); // no directions of photons
    k.leaks = {.min_cosine = 0.5f};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument); // no normals of photons
    k.leaks = {.flattening = 0.5f};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument);
    k.leaks = {.flattening = std::numeric_limits<float>::quiet_NaN()};
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument);
    k.leaks = {};
    k.radii_at_points = true; // of the k nearest, no radius is given
    EXPECT_THROW(knn_grid_estimate(b, map, points, points, k), std::invalid_argument);
}

TYPED_TEST_P(estimators, searches_can_be_watched_and_resumed)
{
    auto& b = this->b();
    const auto s = make_oriented(distribution::clustered, 4000, {12, 12, 12}, 1200, 2);
    const auto at = b.upload(std::span<const vec4>(s.points));
    const auto map = sorted_map(b, upload_photons(b, s), s.photons.g);
    for (const auto search : all_searches) {
        knn_settings k{.k = 200, .max_radius = 0.3f};
        k.search = search;
        k.errors = k.biases = true;
        const auto whole = knn_grid_estimate(b, map, at, k);
        k.visits_per_pass = 100; // another budget, the same result
        k.ranges_per_pass = 20;
        knn_search<typename TestFixture::B> watched(b, map, at, k);
        std::size_t passes = 0;
        for (bool finished = false; !finished && passes < 100000; ++passes) {
            const auto p = watched.advance(1);
            ASSERT_LE(p.passes, 1u);
            finished = p.finished;
            const auto now = watched.estimates();
            for (const auto& e : b.download(now.irradiance))
                ASSERT_TRUE(std::isfinite(e.x) && std::isfinite(e.w));
            for (const auto& e : b.download(now.standard_error))
                ASSERT_TRUE(std::isfinite(e.w) && e.w >= 0);
            for (const auto& u : b.download(now.used))
                ASSERT_LE(u.x, 4000u);
            for (const auto& e : b.download(now.biases.bias))
                ASSERT_TRUE(std::isfinite(e.x));
        }
        EXPECT_GT(passes, 4u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().irradiance), b.download(whole.irradiance)), 0u)
            << int(search);
        EXPECT_EQ(
            count_different_bits(b.download(watched.estimates().standard_error), b.download(whole.standard_error)), 0u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().used), b.download(whole.used)), 0u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().biases.bias), b.download(whole.biases.bias)), 0u);
        EXPECT_EQ(count_different_bits(b.download(watched.estimates().biases.jump), b.download(whole.biases.jump)), 0u);
        EXPECT_TRUE(watched.advance(5).finished);
    }
}

/// The paper's estimate, which has a path of its own where no bias is asked for; and points without normals or photons.
TYPED_TEST_P(estimators, biases_do_not_change_what_they_are_of)
{
    auto& b = this->b();
    const auto s = make_oriented(distribution::planar, 2000, {8, 8, 8}, 200, 3);
    const auto m = this->known(s, map_kind::sorted);
    auto points = s.points;
    points[0].w = 0;
    points[1].x = std::numeric_limits<float>::quiet_NaN();
    const auto at = b.upload(std::span<const vec4>(points)), normals = b.upload(std::span<const vec4>(s.point_normals));
    for (const auto search : all_searches) {
        knn_settings k{.k = 40, .max_radius = 0.2f};
        k.search = search;
        k.bias = bias_kind::paper;
        const auto plain = knn_grid_estimate(b, m.map, at, normals, k);
        EXPECT_EQ(plain.biases.bias.size() + plain.biases.jump.size(), 0u);
        k.biases = true;
        const auto e = knn_grid_estimate(b, m.map, at, normals, k);
        EXPECT_EQ(count_different_bits(b.download(e.used), b.download(plain.used)), 0u) << int(search);
        const auto light = b.download(e.irradiance), plain_light = b.download(plain.irradiance);
        const auto reported = this->biases_of(e);
        for (std::size_t q = 0; q < 2; ++q)
            EXPECT_EQ(reported.bias[q] + reported.tilt[q] + reported.jump[q] + reported.constant[q], vec4(0)) << q;
        double largest = 0;
        for (std::size_t q = 2; q < s.points.size(); ++q) {
            ASSERT_NEAR(light[q].x, plain_light[q].x, 1e-6f * plain_light[q].x);
            const auto expected = estimate_by_force(s, m.ids, m.powers, q, k, std::optional<float>(light[q].w));
            EXPECT_EQ(this->other_biases(reported, q, expected), "") << int(search) << ", point " << q;
            largest = std::max(largest, std::abs(expected.bias.x));
        }
        EXPECT_GT(largest, 0);
        // Without normals, offsets from the point count whole.
        const auto without = this->biases_of(knn_grid_estimate(b, m.map, at, k));
        auto no_normals = s;
        no_normals.point_normals.assign(s.points.size(), vec4(0));
        for (std::size_t q = 2; q < s.points.size(); ++q)
            EXPECT_EQ(this->other_biases(without, q,
                          estimate_by_force(no_normals, m.ids, m.powers, q, k, std::optional<float>(light[q].w))),
                "")
                << int(search) << ", point " << q;
    }
}

TYPED_TEST_P(estimators, equal_the_serial_backends_bit_for_bit)
{
    auto& b = this->b();
    serial_backend serial;
    for (const auto d : all_distributions)
        for (const auto resolution : {uvec3(1, 1, 1), uvec3(9, 9, 18)})
            for (const auto search : all_searches) {
                const auto s = make_oriented(d, 3000, resolution, 300, 11);
                const auto run = [&](auto& device) {
                    knn_settings k{.k = 64, .max_radius = 0.25f};
                    k.search = search;
                    k.filter = filter_kind::epanechnikov;
                    k.leaks = {.side = true, .flattening = 2};
                    k.errors = k.biases = true;
                    const auto map = sorted_map(device, upload_photons(device, s), s.photons.g);
                    const auto e = knn_grid_estimate(device, map, device.upload(std::span<const vec4>(s.points)),
                        device.upload(std::span<const vec4>(s.point_normals)), k);
                    return std::tuple{device.download(e.irradiance), device.download(e.used),
                        device.download(e.standard_error), device.download(e.biases.bias),
                        device.download(e.biases.tilt), device.download(e.biases.jump)};
                };
                const auto [irradiance, used, errors, bias, tilt, jump] = run(b);
                const auto [irradiance_s, used_s, errors_s, bias_s, tilt_s, jump_s] = run(serial);
                const auto where = std::string(name_of(d)) + " search " + std::to_string(int(search));
                const bool exact = b.caps().exact_division && b.caps().exact_sqrt;
                float largest_power = 0;
                for (const auto& p : s.photons.powers)
                    largest_power = std::max({largest_power, p.x, p.y, p.z});
                // Which photons: the same everywhere. How many were looked at, and their light, where division rounds
                // correctly.
                for (std::size_t i = 0; i < used.size(); ++i) {
                    ASSERT_EQ(used[i].x, used_s[i].x) << where;
                    ASSERT_EQ(irradiance[i].w, irradiance_s[i].w) << where;
                    const float tolerance = adds_as_serial<TypeParam>() ? 1e-5f : 1e-6f;
                    // Where division is loose, a photon at the radius weighs 0 or what 1 - d^2 / r^2 is off by.
                    const float all = exact || used[i].x == 0 ? 0.0f
                                                              : 6 * static_cast<float>(used[i].x) * largest_power
                            / (std::numbers::pi_v<float> * irradiance_s[i].w);
                    ASSERT_NEAR(irradiance[i].x, irradiance_s[i].x, tolerance * (irradiance_s[i].x + all)) << where;
                    ASSERT_NEAR(errors[i].w, errors_s[i].w, tolerance * (errors_s[i].w + all)) << where;
                }
                if (exact && adds_as_serial<TypeParam>()) {
                    EXPECT_EQ(count_different_bits(irradiance, irradiance_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(used, used_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(errors, errors_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(bias, bias_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(tilt, tilt_s), 0u) << where;
                    EXPECT_EQ(count_different_bits(jump, jump_s), 0u) << where;
                }
            }
}

} // namespace photongrid::testing
