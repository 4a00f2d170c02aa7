// Shares of discs that short rays find (disc_probes.hpp), on any backend: on surfaces of every kind of shape, with and
// without walls; discs that end behind walls; narrow surfaces.
#pragma once

#include "edges.hpp"

#include <photongrid/render/point_estimates.hpp>

namespace photongrid::testing {

/// The kinds of shapes that squares are made of.
enum class made_of { polygons, meshes, boxes };
inline constexpr made_of all_kinds[] = {made_of::polygons, made_of::meshes, made_of::boxes};

/// Adds a rectangle of a kind. A box has 0.3 m of matter below it, on the side that u x v points away from.
inline void add_rectangle(scene& s, made_of kind, const dvec3& corner, const dvec3& u, const dvec3& v)
{
    const dvec3 below = -0.3 * glm::normalize(glm::cross(u, v));
    switch (kind) {
    case made_of::polygons: s.polygons.push_back({{corner, corner + u, corner + u + v, corner + v}, 0}); break;
    case made_of::boxes: s.boxes.push_back({corner, u, v, below, 0}); break;
    case made_of::meshes:
        s.meshes.push_back({"",
            std::make_shared<const mesh>(
                mesh{{glm::vec3(corner), glm::vec3(corner + u), glm::vec3(corner + u + v), glm::vec3(corner + v)},
                    {{0, 1, 2}, {0, 2, 3}}}),
            glm::dmat3(1), dvec3(0), 0});
    }
}
/// The square from 0 to 1 along x and z.
inline scene square_of(made_of kind)
{
    scene s = empty_scene({0.5, 1.5, 0.5});
    add_rectangle(s, kind, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    return s;
}
/// The same with walls on all sides.
inline scene room_of(made_of floor, made_of walls)
{
    scene s = square_of(floor);
    add_rectangle(s, walls, {0, 0, 0}, {0, 1, 0}, {0, 0, 1});
    add_rectangle(s, walls, {1, 0, 0}, {0, 0, 1}, {0, 1, 0});
    add_rectangle(s, walls, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_rectangle(s, walls, {0, 0, 1}, {0, 1, 0}, {1, 0, 0});
    return s;
}

template <class Tag>
class probed_edges : public edges<Tag> {
protected:
    using B = typename Tag::type;
    struct found {
        std::vector<glm::vec4> points, cover, normals;
    };

    /// Photons of one power that come from straight above to a floor.
    map_buffers<B> map_on_floor(const device_scene<B>& scene, const std::vector<dvec3>& places, float power)
    {
        auto& b = this->b();
        oriented_set set;
        set.photons.g = make_grid(scene.layout.low, scene.layout.high, {24, 1, 24});
        for (const auto& p : places) {
            set.photons.positions.emplace_back(glm::vec3(p - scene.layout.center), 0.0f);
            set.photons.powers.emplace_back(power);
            set.directions.emplace_back(0.0f, -1.0f, 0.0f, 0.0f);
            set.normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
        }
        auto photons = upload_photons(b, set.photons);
        photons.directions = b.upload(std::span<const glm::vec4>(set.directions));
        photons.normals = b.upload(std::span<const glm::vec4>(set.normals));
        return sorted_map(b, std::move(photons), set.photons.g);
    }
    template <class Device>
    static found probe_on(Device& b, const device_scene<Device>& scene, const discs& d, const disc_probing& how)
    {
        const auto p = b.upload(std::span<const glm::vec4>(d.points)),
                   n = b.upload(std::span<const glm::vec4>(d.normals));
        const auto probed = probe_discs(b, scene, p, n, how);
        return {b.download(probed.points), b.download(probed.cover), b.download(probed.normals)};
    }
    /// Positions of `d` are the scene's. Serial's bits are compared.
    found probe(const scene& s, discs d, const disc_probing& how)
    {
        auto& b = this->b();
        const auto scene = upload_scene(b, s);
        serial_backend serial;
        const auto reference = upload_scene(serial, s);
        for (std::size_t i = 0; i < d.points.size(); ++i)
            d.points[i] = glm::vec4(glm::vec3(dvec3(d.points[i]) - scene.layout.center), d.estimates[i].w);
        const auto f = probe_on(b, scene, d, how);
        if (b.caps().exact_division && b.caps().exact_sqrt) {
            const auto expected = probe_on(serial, reference, d, how);
            EXPECT_EQ(count_different_bits(f.points, expected.points), 0u);
            EXPECT_EQ(count_different_bits(f.cover, expected.cover), 0u);
            EXPECT_EQ(count_different_bits(f.normals, expected.normals), 0u);
        }
        return f;
    }
    /// The mean of the estimates at points (recentred) with normals up. With a first map they have its radii, whose
    /// squares are multiplied by share2.
    double mean_light(const device_scene<B>& scene, const map_buffers<B>& light, uint k, edge_correction edges,
        const std::vector<glm::vec4>& points, const map_buffers<B>* first, double share2)
    {
        auto& b = this->b();
        const std::vector<glm::vec4> normals(points.size(), {0, 1, 0, 0});
        const auto at = b.upload(std::span<const glm::vec4>(points)),
                   up = b.upload(std::span<const glm::vec4>(normals));
        estimate_sources<B> from;
        from.scene = &scene;
        from.map = &light;
        from.search = {.k = k, .max_radius = 0.3f, .filter = filter_kind::silverman};
        from.search.leaks = {.side = true, .min_cosine = 0.5f};
        from.edges = edges;
        if (first != nullptr) {
            from.radii = {first, k};
            from.share2 = share2;
        }
        point_estimates<B> e(b, from, at, up, running_estimate_kind::none, step_size::largest);
        while (!e.advance()) {}
        double sum = 0;
        for (const auto& v : b.download(e.take().irradiance))
            sum += static_cast<double>(v.x);
        return sum / static_cast<double>(points.size());
    }
    /// The largest error of the shares, and by how much the mean of estimates that are divided by them is too high, of
    /// random discs of 0.2 m on a convex surface.
    std::pair<double, double> errors(const scene& s, const std::vector<glm::dvec2>& corners)
    {
        random_source u(7);
        double largest = 0, most_bias = 0;
        for (const auto& f : filters) {
            discs d;
            std::vector<double> expected;
            for (int i = 0; i < 150; ++i) {
                const glm::dvec2 p(0.01 + 0.98 * static_cast<double>(u()), 0.01 + 0.98 * static_cast<double>(u()));
                bool inside = true;
                for (std::size_t c = 0; c < corners.size(); ++c) {
                    const auto along = glm::normalize(corners[(c + 1) % corners.size()] - corners[c]),
                               from = p - corners[c];
                    inside = inside && along.x * from.y - along.y * from.x > 0.005;
                }
                if (!inside)
                    continue;
                d.add({p.x, 0, p.y}, {0, 1, 0}, 0.2);
                expected.push_back(part_by_lines(corners, p, 0.2).share[static_cast<int>(f.kind)]);
            }
            const auto found = probe(s, d, {f.kind, 0.5f});
            double sum = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const auto& c = found.cover[i];
                EXPECT_EQ(c.y, 1.0f);
                EXPECT_EQ(found.points[i].w, d.estimates[i].w) << "nothing cuts the disc down";
                if (expected[i] > 1 - 1e-9) {
                    EXPECT_EQ(c.x, 1.0f) << "what is whole stays as it is";
                }
                largest = std::max(largest, std::abs(static_cast<double>(c.x) - expected[i]));
                sum += expected[i] / static_cast<double>(c.x);
            }
            most_bias = std::max(most_bias, std::abs(sum / static_cast<double>(expected.size()) - 1));
        }
        return {largest, most_bias};
    }
};
TYPED_TEST_SUITE_P(probed_edges);

TYPED_TEST_P(probed_edges, are_those_of_a_square_of_any_kind)
{
    const std::vector<glm::dvec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    double largest = 0, bias = 0;
    const auto check = [&](const scene& s, const char* of) {
        const auto [error, mean] = this->errors(s, corners);
        largest = std::max(largest, error);
        bias = std::max(bias, mean);
        EXPECT_LT(error, 0.1) << of;
        EXPECT_LT(mean, 0.01) << of;
    };
    for (const auto floor : all_kinds) {
        check(square_of(floor), "a free square");
        for (const auto walls : all_kinds)
            check(room_of(floor, walls), "a room");
    }
    this->report("A9_probes", "largest error of a share:", largest);
    this->report("A9_probes_bias", "of the mean of estimates divided by them:", bias);
}

TYPED_TEST_P(probed_edges, are_those_of_a_disk)
{
    scene s = empty_scene({0.5, 1.5, 0.5});
    s.disks.push_back({{0.5, 0, 0.5}, {0, 1, 0}, 0.5, 0});
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 100; ++i)
        corners.emplace_back(0.5 + 0.5 * std::cos(i * M_PI / 50), 0.5 + 0.5 * std::sin(i * M_PI / 50));
    const auto [error, mean] = this->errors(s, corners);
    EXPECT_LT(error, 0.1);
    EXPECT_LT(mean, 0.01);
}

TYPED_TEST_P(probed_edges, discs_end_where_the_floor_goes_on_behind_a_wall)
{
    // A wall of 0.1 m across the floor, or a sheet; and one on the floor's edge, behind which there is nothing.
    for (const auto kind : all_kinds)
        for (const auto& [goes_on, thick] : {std::pair(true, true), std::pair(false, true), std::pair(true, false)}) {
            scene s = empty_scene({0.5, 1.5, 0.5});
            const double end = goes_on ? 1 : 0.1;
            add_rectangle(s, kind, {-1, 0, -1}, {0, 0, 2}, {1 + end, 0, 0});
            if (thick)
                s.boxes.push_back({{0, 0, -1}, {0.1, 0, 0}, {0, 1, 0}, {0, 0, 2}, 0});
            else
                add_rectangle(s, made_of::meshes, {0, 0, -1}, {0, 1, 0}, {0, 0, 2});
            discs d;
            random_source u(3);
            for (int i = 0; i < 100; ++i)
                d.add({-0.05, 0, static_cast<double>(u()) - 0.5}, {0, 1, 0}, 0.3);
            const auto found = this->probe(s, d, {filter_kind::constant, 0.5f});
            double share = 0;
            for (std::size_t i = 0; i < d.points.size(); ++i) {
                EXPECT_EQ(found.points[i].w, d.estimates[i].w) << "a half space is enough";
                if (goes_on) {
                    const auto [way, far] = half_space_by_force(found.normals[i], 0.3f);
                    EXPECT_NEAR(way.x, 1, 1e-5);
                    EXPECT_NEAR(far, 0.05, 2e-4);
                } else {
                    EXPECT_EQ(found.normals[i].w, 0);
                }
                const double known = part_by_lines({{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {-0.05, 0}, 0.3).share[0];
                EXPECT_NEAR(found.cover[i].x, known, 0.1);
                share += static_cast<double>(found.cover[i].x) / known / static_cast<double>(d.points.size());
            }
            EXPECT_NEAR(share, 1, 0.02);
        }
}

TYPED_TEST_P(probed_edges, discs_are_no_wider_than_a_leg)
{
    // Legs of 0.1 m; the discs are ten times as wide.
    scene s = empty_scene({0.5, 1.5, 0.5});
    s.boxes.push_back({{0, -2, -0.05}, {0.1, 0, 0}, {0, 4, 0}, {0, 0, 0.1}, 0});
    s.cylinders.push_back({{1, -2, 0}, {1, 2, 0}, 0.05, 0});
    discs d;
    random_source u(4);
    for (int i = 0; i < 200; ++i)
        d.add(
            {i < 100 ? 0 : 0.95, static_cast<double>(u()) - 0.5, i < 100 ? 0.06 * static_cast<double>(u()) - 0.03 : 0},
            {-1, 0, 0}, 0.5);
    const auto found = this->probe(s, d, {filter_kind::silverman, 0.5f});
    for (std::size_t i = 0; i < d.points.size(); ++i) {
        const double radius = std::sqrt(static_cast<double>(found.points[i].w));
        EXPECT_GT(radius, 0.07);
        EXPECT_LT(radius, 0.13);
        EXPECT_GT(found.cover[i].x, 0.55f);
    }
}

TYPED_TEST_P(probed_edges, discs_are_no_larger_than_a_box)
{
    // Even light on the top of a box, with fewer photons than are sought: the discs reach behind the walls of the room.
    auto& b = this->b();
    constexpr double width = 0.05;
    constexpr uint photons = 2000;
    double worst = 0;
    for (const auto kind : all_kinds)
        for (const double height : {0.05, 0.2}) {
            auto s = room_of(kind, kind);
            const dvec3 corner(0.1, height, 0.15);
            s.boxes.push_back({{corner.x, 0, corner.z}, {width, 0, 0}, {0, height, 0}, {0, 0, width}, 0});
            const auto scene = upload_scene(b, s);
            random_source u(9);
            const auto on_top
                = [&] { return corner + width * dvec3(static_cast<double>(u()), 0, static_cast<double>(u())); };
            const auto map_of = [&] {
                std::vector<dvec3> places(photons);
                for (auto& p : places)
                    p = on_top();
                return this->map_on_floor(scene, places, static_cast<float>(width * width / photons));
            };
            const auto light = map_of(), first = map_of();
            std::vector<glm::vec4> points;
            for (int i = 0; i < 400; ++i)
                points.emplace_back(glm::vec3(on_top() - scene.layout.center), 1.0f);
            for (const bool given : {false, true}) {
                const auto mean = this->mean_light(
                    scene, light, photons + 1, edge_correction::probes, points, given ? &first : nullptr, 1);
                worst = std::max(worst, std::abs(mean - 1));
            }
        }
    EXPECT_LT(worst, 0.05);
    this->report("A9_probes_box", "mean of even light on a small box, off by:", worst);
}

TYPED_TEST_P(probed_edges, end_at_a_tube_and_at_a_can)
{
    // On the floor around a tube that stands on it: its inside is floor, too, unless it is closed.
    for (const bool closed : {false, true}) {
        scene s = empty_scene({0.5, 1.5, 0.5});
        add_rectangle(s, made_of::polygons, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
        add_rectangle(s, made_of::polygons, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4}); // a ceiling
        s.cylinders.push_back({{0, 0, 0}, {0, 0.3, 0}, 0.5, 0});
        if (closed)
            s.disks.push_back({{0, 0.3, 0}, {0, 1, 0}, 0.5, 0});
        discs d;
        for (int i = 0; i < 100; ++i)
            d.add({0.52 * std::cos(i), 0, 0.52 * std::sin(i)}, {0, 1, 0}, 0.2);
        const auto found = this->probe(s, d, {filter_kind::constant, 0.5f});
        for (const auto& c : found.cover)
            EXPECT_NEAR(c.x, 0.5, 0.2);
        for (const auto& n : found.normals)
            EXPECT_TRUE(closed || n.w > 0) << "a half space keeps what is in the tube out";
        for (std::size_t i = 0; i < found.points.size(); ++i)
            EXPECT_EQ(found.points[i].w, d.estimates[i].w) << "the half space before the nearest wall is enough";
    }
}

TYPED_TEST_P(probed_edges, keep_their_radius_beside_a_leg)
{
    // On the floor around a round leg: the half space before its nearest side is enough.
    scene s = empty_scene({0.5, 1.5, 0.5});
    add_rectangle(s, made_of::polygons, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0});
    s.cylinders.push_back({{0, 0, 0}, {0, 3, 0}, 0.05, 0});
    discs d;
    for (int i = 0; i < 200; ++i)
        d.add({0.07 * std::cos(i), 0, 0.07 * std::sin(i)}, {0, 1, 0}, 0.2);
    const auto found = this->probe(s, d, {filter_kind::constant, 0.5f});
    int cut = 0;
    for (std::size_t i = 0; i < d.points.size(); ++i) {
        cut += found.points[i].w < d.estimates[i].w ? 1 : 0;
        EXPECT_GT(found.normals[i].w, 0);
    }
    EXPECT_LT(cut, 20);
}

TYPED_TEST_P(probed_edges, make_even_light_even_up_to_edges_and_walls)
{
    // Even light on the floor alone; estimates near its edges, with radii of their own and with given ones.
    auto& b = this->b();
    constexpr uint side = 200, photons = side * side; // one in each small square
    double worst = 0, without = 1;
    for (const auto kind : all_kinds)
        for (const bool walled : {false, true}) {
            const auto s = walled ? room_of(kind, kind) : square_of(kind);
            const auto scene = upload_scene(b, s);
            random_source u(6);
            const auto map_of = [&] {
                std::vector<dvec3> places;
                for (uint i = 0; i < photons; ++i)
                    places.emplace_back((static_cast<double>(i % side) + static_cast<double>(u())) / side, 0,
                        (static_cast<double>(i / side) + static_cast<double>(u())) / side);
                return this->map_on_floor(scene, places, 1.0f / photons);
            };
            const auto light = map_of(), first = map_of();
            std::vector<glm::vec4> points;
            for (int i = 0; i < 800; ++i) { // a frame of 0.04 m along the edges
                dvec3 p(0.04 * static_cast<double>(u()), 0, static_cast<double>(u()));
                for (int turn = i % 4; turn > 0; --turn)
                    p = dvec3(p.z, 0, 1 - p.x);
                points.emplace_back(glm::vec3(p - scene.layout.center), 1.0f);
            }
            const auto mean = [&](edge_correction edges, bool given) {
                return this->mean_light(scene, light, 400, edges, points, given ? &first : nullptr, 0.7);
            };
            for (const bool given : {false, true}) {
                worst = std::max(worst, std::abs(mean(edge_correction::probes, given) - 1));
                without = std::min(without, mean(edge_correction::none, given));
            }
        }
    EXPECT_LT(worst, 0.01);
    EXPECT_LT(without, 0.85);
    this->report("A9_probes_light", "mean of even light near edges, off by:", worst);
}

TYPED_TEST_P(probed_edges, let_no_light_through_a_wall)
{
    // A wall across the floor, two in a corner, a pipe, or a block of glass, and light on one side alone: none comes to
    // the other, and on its own side it is even up to the wall.
    auto& b = this->b();
    struct wall {
        const char* name;
        scene s = empty_scene({0.5, 1.5, 0.5});
        std::function<bool(const dvec3&)> is_lit;
        dvec3 lit, dark;              ///< the floor's points nearest to the wall
        dvec3 out;                    ///< of the lit side
        double from = -0.5, to = 0.5; ///< along the wall; of a pipe an angle
    };
    std::vector<wall> walls;
    for (const double thick : {0.1, 0.01}) {
        walls.push_back({"a wall", empty_scene({0.5, 1.5, 0.5}), [thick](const dvec3& p) { return p.x < -thick / 2; },
            {-thick / 2, 0, 0}, {thick / 2, 0, 0}, {-1, 0, 0}});
        walls.back().s.boxes.push_back({{-thick / 2, 0, -1}, {thick, 0, 0}, {0, 1, 0}, {0, 0, 2}, 0});
    }
    walls.push_back({"a sheet", empty_scene({0.5, 1.5, 0.5}), [](const dvec3& p) { return p.x < 0; }, {0, 0, 0},
        {0, 0, 0}, {-1, 0, 0}});
    add_rectangle(walls.back().s, made_of::meshes, {0, 0, -1}, {0, 1, 0}, {0, 0, 2});
    const auto outside = [](const dvec3& p) { return p.x < -0.005 || p.z < -0.005; };
    walls.push_back(
        {"a corner", empty_scene({0.5, 1.5, 0.5}), outside, {-0.005, 0, 0}, {0.005, 0, 0}, {-1, 0, 0}, 0.02, 0.6});
    walls.back().s.boxes.push_back({{-0.005, 0, -0.005}, {0.01, 0, 0}, {0, 1, 0}, {0, 0, 2}, 0});
    walls.back().s.boxes.push_back({{-0.005, 0, -0.005}, {2, 0, 0}, {0, 1, 0}, {0, 0, 0.01}, 0});
    walls.push_back({"a block of glass", empty_scene({0.5, 1.5, 0.5}), [](const dvec3& p) { return p.x < 0; },
        {0, 0, 0}, {0, 0, 0}, {-1, 0, 0}});
    walls.back().s.materials.push_back({"glass", material_kind::glass, dvec3(1), 1.5});
    walls.back().s.boxes.push_back({{-1, 0, -1}, {1, 0, 0}, {0, 0.3, 0}, {0, 0, 2}, 1});
    walls.push_back({"a wall that hovers by 5 mm", empty_scene({0.5, 1.5, 0.5}),
        [](const dvec3& p) { return p.x < -0.05; }, {-0.05, 0, 0}, {0.05, 0, 0}, {-1, 0, 0}});
    walls.back().s.boxes.push_back({{-0.05, 0.005, -1}, {0.1, 0, 0}, {0, 1, 0}, {0, 0, 2}, 0});
    walls.push_back({"a pipe", empty_scene({0.5, 1.5, 0.5}), [](const dvec3& p) { return glm::length(p) > 0.5; },
        {0.5, 0, 0}, {0.45, 0, 0}, {1, 0, 0}});
    for (const double radius : {0.5, 0.45})
        walls.back().s.cylinders.push_back({{0, 0, 0}, {0, 1, 0}, radius, 0});
    for (auto& w : walls) {
        add_rectangle(w.s, made_of::polygons, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
        const auto scene = upload_scene(b, w.s);
        random_source u(8);
        const auto map_of = [&](bool everywhere) {
            std::vector<dvec3> places;
            for (int i = 0; i < 200000; ++i) {
                const dvec3 p(2 * static_cast<double>(u()) - 1, 0, 2 * static_cast<double>(u()) - 1);
                if (everywhere || w.is_lit(p))
                    places.push_back(p);
            }
            return this->map_on_floor(scene, places, 4.0f / 200000);
        };
        const auto light = map_of(false), first = map_of(true);
        const auto mean = [&](bool lit, edge_correction edges, bool given) {
            std::vector<glm::vec4> points;
            for (int i = 0; i < 200; ++i) {
                dvec3 p = (lit ? w.lit + 0.05 * static_cast<double>(u()) * w.out
                               : w.dark - (0.001 + 0.05 * static_cast<double>(u())) * w.out);
                const double turn = w.from + (w.to - w.from) * static_cast<double>(u());
                p = w.out.x > 0 ? dvec3(p.x * std::cos(turn), 0, p.x * std::sin(turn)) : p + dvec3(0, 0, turn);
                points.emplace_back(glm::vec3(p - scene.layout.center), 1.0f);
            }
            return this->mean_light(scene, light, 3000, edges, points, given ? &first : nullptr, 1);
        };
        for (const bool given : {false, true}) {
            EXPECT_GT(mean(false, edge_correction::none, given), 0.0005) << w.name;
            EXPECT_LT(mean(false, edge_correction::probes, given), 0.001) << w.name;
            EXPECT_NEAR(mean(true, edge_correction::probes, given), 1, 0.05) << w.name;
        }
    }
}

REGISTER_TYPED_TEST_SUITE_P(probed_edges, are_those_of_a_square_of_any_kind, are_those_of_a_disk,
    make_even_light_even_up_to_edges_and_walls, discs_end_where_the_floor_goes_on_behind_a_wall,
    discs_are_no_wider_than_a_leg, discs_are_no_larger_than_a_box, keep_their_radius_beside_a_leg,
    end_at_a_tube_and_at_a_can, let_no_light_through_a_wall);

} // namespace photongrid::testing
