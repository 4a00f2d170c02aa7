// The share of a disc that polygons cover, on any backend.
#pragma once

#include "edges.hpp"

namespace photongrid::testing {

TYPED_TEST_P(edges, angles_and_logarithms_are_those_of_the_library)
{
    auto& b = this->b();
    random_source u(1);
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<glm::vec4> numbers{{0, 1, 1, infinity}, {0, 1, 1, 3e38f}, {0, 1, 1, 87.0f}, {0, 1, 1, 0},
        {1, 0, std::nextafter(1.0f, 2.0f), 0}, {0, -1, 1.41421356f, 0}, {1, 1, 1.41421366f, 0}, {1, -1, 2, 0},
        {1e-30f, 1, 1e30f, 0}, {1e-30f, -1, 3e38f, 0}, {1e30f, 1e-5f, 4, 0}};
    for (int i = 0; i < 100000; ++i) {
        const float scale = std::exp2(40 * u() - 20);
        numbers.emplace_back(u() * scale, (2 * u() - 1) * scale * (i % 3 == 0 ? 1e-3f : 1.0f),
            i % 2 == 0 ? std::exp2(100 * u() * u() * u()) : 1 + u(), i % 2 == 0 ? 90 * u() : std::exp2(-40 * u()));
    }
    auto out = b.template make<glm::vec4>(numbers.size());
    b.template run<probes::angle_probe>(
        numbers.size(), {}, reads(b.upload(std::span<const glm::vec4>(numbers))), writes(out));
    const auto values = b.download(out);
    double angle = 0, logarithm = 0, power = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const glm::dvec4 n(numbers[i]);
        angle = std::max(angle, std::abs(static_cast<double>(values[i].x) - std::atan2(n.x, n.y)));
        logarithm = std::max(
            logarithm, std::abs(static_cast<double>(values[i].y) - std::log(n.z)) / std::max(1.0, std::log(n.z)));
        const double known = n.w < 87 ? std::exp(-n.w) : 0;
        power = std::max(power, std::abs(static_cast<double>(values[i].z) - known) / std::max(known, 1e-300));
    }
    std::printf("edges: largest error of an angle %.2g, of a logarithm %.2g (over 1 or itself)\n", angle, logarithm);
    EXPECT_LE(angle, 3e-7);
    EXPECT_LE(logarithm, 2e-7);
    EXPECT_LE(power, 3e-7);
}

/// Convex polygons, in a plane of their own, of the `number`-th surface.
inline std::vector<std::vector<glm::dvec2>> convex_parts(int number, random_source& u)
{
    std::vector<std::vector<glm::dvec2>> parts;
    switch (number % 4) {
    case 0: { // a convex polygon
        std::vector<double> angles;
        for (int i = 0; i < 3 + number % 7; ++i)
            angles.push_back(2 * M_PI * (i + 0.8 * static_cast<double>(u())) / (3 + number % 7));
        parts.emplace_back();
        for (const double a : angles)
            parts[0].emplace_back(0.9 * std::cos(a), 0.5 * std::sin(a));
        break;
    }
    case 1: // a square of two triangles
        parts = {{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}}, {{-0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
        break;
    case 2: // an L
        parts = {{{-0.6, -0.6}, {0.6, -0.6}, {0.6, -0.1}, {-0.6, -0.1}},
            {{-0.6, -0.1}, {0.1, -0.1}, {0.1, 0.7}, {-0.6, 0.7}}};
        break;
    default: // a star of triangles about a square hole
        parts = {{{-0.2, -0.2}, {0, -0.8}, {0.2, -0.2}}, {{0.2, -0.2}, {0.8, 0}, {0.2, 0.2}},
            {{0.2, 0.2}, {0, 0.8}, {-0.2, 0.2}}, {{-0.2, 0.2}, {-0.8, 0}, {-0.2, -0.2}}};
    }
    return parts;
}

/// A surface made of polygons wound either way; beside it what must not count: a wall, a floor 1 mm below, a mirror and
/// a lamp in the plane.
inline scene surface_beside_others(
    const std::vector<std::vector<glm::dvec2>>& parts, const drawing_board& board, random_source& u)
{
    auto s = empty_scene(board.at({0.2, 0.1}) + board.normal());
    s.materials.push_back({"mirror", material_kind::mirror, dvec3(1)});
    for (const auto& p : parts) {
        auto wound = p;
        if (u() < 0.5f)
            std::reverse(wound.begin(), wound.end());
        s.polygons.push_back(board.draw(wound));
    }
    s.polygons.push_back(
        {{board.at({-1, 0}), board.at({1, 0}), board.at({1, 0}) + board.normal(), board.at({-1, 0}) + board.normal()},
            0});
    auto below = board;
    below.origin -= 1e-3 * board.normal();
    s.polygons.push_back(below.draw({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}));
    s.polygons.push_back(board.draw({{-1.2, -1}, {-0.3, -1}, {-0.3, 1}, {-1.2, 1}}));
    s.polygons.back().material = 2;
    s.rectangle_lights.push_back({"lamp", board.at({0.3, -1}), 0.8 * board.right, 2.0 * board.up, dvec3(1)});
    s.camera = {board.at({0, 0}) + 3.0 * board.normal(), board.at({0, 0}), board.up, 40};
    return s;
}

/// Places on a surface, and radii of discs about them: corners' and edges' neighbours more often than others.
inline std::vector<std::pair<glm::dvec2, double>> places_on(
    const std::vector<std::vector<glm::dvec2>>& parts, random_source& u)
{
    const auto number = [&] { return static_cast<double>(u()); };
    std::vector<std::pair<glm::dvec2, double>> places;
    while (places.size() < 20) {
        const auto& part = parts[u.below(static_cast<std::uint32_t>(parts.size()))];
        const auto c = u.below(static_cast<std::uint32_t>(part.size()));
        glm::dvec2 middle(0),
            on_edge = glm::mix(part[c], part[(c + 1) % part.size()], places.size() % 4 == 0 ? 0.0 : number());
        for (const auto& p : part)
            middle += p / static_cast<double>(part.size());
        const auto p = glm::mix(on_edge, middle, places.size() % 3 == 0 ? 0.0 : number() * number());
        places.emplace_back(p, 0.1 + 0.7 * number() * number());
    }
    return places;
}

inline discs discs_at(
    const std::vector<std::pair<glm::dvec2, double>>& places, const drawing_board& board, random_source& u)
{
    discs d;
    for (const auto& [at, radius] : places)
        d.add(board.at(at), u() < 0.5f ? board.normal() : -board.normal(), radius);
    return d;
}

TYPED_TEST_P(edges, shares_equal_integration_over_lines)
{
    random_source u(2);
    double largest = 0;
    for (int round = 0; round < 24; ++round) {
        const auto parts = convex_parts(round, u);
        const auto board = random_board(u);
        const auto s = surface_beside_others(parts, board, u);

        const auto places = places_on(parts, u);
        const auto d = discs_at(places, board, u);
        std::vector<glm::dvec4> expected(places.size(), glm::dvec4(0));
        for (std::size_t i = 0; i < places.size(); ++i)
            for (const auto& p : parts)
                expected[i] += part_by_lines(p, places[i].first, places[i].second).share;
        for (const auto& f : filters) {
            const auto cover = this->cover(s, d, f.kind);
            for (std::size_t i = 0; i < places.size(); ++i) {
                const double error = std::abs(static_cast<double>(cover[i].x) - expected[i][static_cast<int>(f.kind)]);
                largest = std::max(largest, error);
                EXPECT_EQ(cover[i].y, 1.0f);
                ASSERT_LE(error, 3e-6) << "filter " << f.name << ", surface " << round << ", point " << i << ": "
                                       << cover[i].x << ", not " << expected[i][static_cast<int>(f.kind)];
            }
        }
    }
    std::printf("edges: largest error of a share %.2g\n", largest);
}

TYPED_TEST_P(edges, shares_have_the_known_values_of_a_square)
{
    random_source u(3);
    for (const auto& f : filters)
        for (int round = 0; round < 8; ++round) {
            const auto board = random_board(u);
            auto s = empty_scene(board.at({0.5, 0.5}) + board.normal());
            // Of two triangles, four rectangles, or wound wrongly in part.
            if (round % 2 == 0)
                s.polygons = {board.draw({{0, 0}, {1, 0}, {1, 1}}),
                    board.draw(round % 4 == 0 ? std::vector<glm::dvec2>{{0, 0}, {1, 1}, {0, 1}}
                                              : std::vector<glm::dvec2>{{0, 1}, {1, 1}, {0, 0}})};
            else
                s.polygons = {board.draw({{0, 0}, {0.3, 0}, {0.3, 0.4}, {0, 0.4}}),
                    board.draw({{0.3, 0}, {1, 0}, {1, 0.4}, {0.3, 0.4}}),
                    board.draw({{0, 0.4}, {0.6, 0.4}, {0.6, 1}, {0, 1}}),
                    board.draw({{0.6, 0.4}, {0.6, 1}, {1, 1}, {1, 0.4}})};
            s.camera = {board.at({0, 0}) + 3.0 * board.normal(), board.at({0, 0}), board.up, 40};
            discs inside, edge, corner, off;
            for (int i = 0; i < 20; ++i) {
                const double r = 0.01 + 0.4 * static_cast<double>(u()), t = r + (1 - 2 * r) * static_cast<double>(u()),
                             v = r + (1 - 2 * r) * static_cast<double>(u());
                inside.add(board.at({t, v}), board.normal(), r * 0.9999);
                edge.add(board.at(i % 2 == 0 ? glm::dvec2(t, i % 4 / 2) : glm::dvec2(i % 4 / 2, t)), board.normal(), r);
                corner.add(board.at({i % 2, i % 4 / 2}), board.normal(), r);
                off.add(board.at({t, v}) + 0.1 * r * board.normal(), board.normal(), r); // above the square
                off.add(
                    board.at({t, v}), glm::normalize(board.normal() + 0.2 * board.up), r); // on something that meets it
                off.add(board.at({1.01, v}), board.normal(), r);                           // beside it
            }
            EXPECT_LE(this->largest_error(this->cover(s, inside, f.kind), 1), 2e-6);
            EXPECT_LE(
                this->largest_error(this->cover(s, edge, f.kind), 0.5), 2e-5); // rounding, over radii down to 0.01
            EXPECT_LE(this->largest_error(this->cover(s, corner, f.kind), 0.25), 2e-5);
            for (const auto& c : this->cover(s, off, f.kind))
                EXPECT_EQ(c.y, 0.0f);
            discs unwanted = inside;
            for (auto& p : unwanted.points)
                p.w = -1;
            for (const auto& c : this->cover(s, unwanted, f.kind))
                EXPECT_EQ(c.x + c.y, 0.0f);
        }
}

TYPED_TEST_P(edges, bent_walls_hold_together_up_to_two_degrees_and_a_half)
{
    for (const auto& f : filters)
        for (const double degrees : {0.1, 1.0, 2.4, 2.6, 30.0}) {
            const double c = std::cos(glm::radians(degrees)), h = std::sin(glm::radians(degrees));
            auto s = empty_scene({0, 2, 0});
            s.polygons = {{{{-1, 0, -1}, {-1, 0, 1}, {0, 0, 1}, {0, 0, -1}}, 0},
                {{{0, 0, -1}, {0, 0, 1}, {c, h, 1}, {c, h, -1}}, 0}};
            s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
            discs left, right;
            for (const double x : {0.0, 0.01, 0.1, 0.29}) {
                left.add({-x, 0, 0}, {0, 1, 0}, 0.3);
                right.add({x * c, x * h, 0}, {-h, c, 0}, 0.3);
            }
            for (const auto& side : {left, right}) {
                const auto cover = this->cover(s, side, f.kind);
                if (degrees < 2.5)
                    EXPECT_LE(this->largest_error(cover, 1), 2e-3) << degrees;
                else
                    EXPECT_NEAR(cover[0].x, 0.5f, 1e-4f) << degrees;
            }
        }
}

/// A square of 2 m, a plate of 0.4 m x 0.6 m at a height over it, and discs beside the plate.
TYPED_TEST_P(edges, lamps_and_mirrors_hide_what_lies_behind_them)
{
    const std::vector<glm::dvec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
        plate{{-0.2, -0.3}, {0.2, -0.3}, {0.2, 0.3}, {-0.2, 0.3}};
    enum class kind { lamp, mirror, glass };
    random_source u(9);
    const auto number = [&] { return static_cast<double>(u()); };
    const double radius = 0.2;
    for (const auto what : {kind::lamp, kind::mirror, kind::glass})
        for (const double height : {1e-4, 0.01, 0.03, 0.06, -0.01}) { // 0.05: a quarter of the radius
            const auto board = random_board(u);
            auto s = empty_scene(board.at({0, 0}) + board.normal());
            s.materials.push_back({"mirror", material_kind::mirror, dvec3(1)});
            s.materials.push_back({"glass", material_kind::glass, dvec3(1)});
            s.polygons = {board.draw(square)};
            auto above = board;
            above.origin += height * board.normal();
            if (what == kind::lamp)
                s.rectangle_lights.push_back({"lamp", above.at(plate[0]), 0.4 * board.right, 0.6 * board.up, dvec3(1)});
            else {
                s.polygons.push_back(above.draw(plate));
                s.polygons.back().material = what == kind::mirror ? 2 : 3;
            }
            s.camera = {board.at({0, 0}) + 3.0 * board.normal(), board.at({0, 0}), board.up, 40};
            discs d;
            std::vector<glm::dvec2> places{{0.2, 0.3}, {0.2, 0}, {-0.1, 0.3}, {0.05, -0.1}};
            while (places.size() < 20) // beside its longer sides
                places.emplace_back((u() < 0.5f ? 1 : -1) * (0.2 + 0.25 * number()), 0.6 * number() - 0.3);
            for (const auto& p : places)
                d.add(board.at(p), board.normal(), radius);
            const double over = height / radius,
                         hidden = what == kind::glass || height < 0 ? 0 : std::max(1 - 16 * over * over, 0.0);
            for (const auto& f : filters) {
                const auto cover = this->cover(s, d, f.kind);
                for (std::size_t i = 0; i < places.size(); ++i) {
                    const double behind = part_by_lines(plate, places[i], radius).share[static_cast<int>(f.kind)];
                    // The fourth point is behind the plate.
                    EXPECT_NEAR(cover[i].x, i == 3 ? 1 : 1 - hidden * behind, 2e-4)
                        << "filter " << f.name << ", height " << height << ", point " << i;
                    EXPECT_EQ(cover[i].y, 1.0f);
                }
            }
        }
}

TYPED_TEST_P(edges, thousands_of_polygons_take_several_passes)
{
    auto s = empty_scene({0.5, 2, 0.5});
    s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
    constexpr int rows = 36;
    const auto at = [](int x, int z) { return dvec3(static_cast<double>(x) / rows, 0, static_cast<double>(z) / rows); };
    for (int x = 0; x < rows; ++x)
        for (int z = 0; z < rows; ++z) {
            s.polygons.push_back({{at(x, z), at(x, z + 1), at(x + 1, z + 1)}, 0});
            s.polygons.push_back({{at(x, z), at(x + 1, z + 1), at(x + 1, z)}, 0});
        }
    discs inside, edge, corner;
    random_source u(4);
    for (int i = 0; i < 50; ++i) {
        const double r = 0.05 + 0.3 * static_cast<double>(u()), t = r + (1 - 2 * r) * static_cast<double>(u());
        inside.add({t, 0, r + (1 - 2 * r) * static_cast<double>(u())}, {0, 1, 0}, r);
        edge.add({t, 0, 1}, {0, 1, 0}, r);
        corner.add({0, 0, 1}, {0, -1, 0}, r);
    }
    const auto passes = [&] { return this->b().costs().at("covered_share").passes; };
    this->cover(s, inside, filter_kind::constant);
    const auto before = passes();
    for (const auto& f : filters) {
        EXPECT_LE(this->largest_error(this->cover(s, inside, f.kind), 1), 2e-5);
        EXPECT_LE(this->largest_error(this->cover(s, edge, f.kind), 0.5), 2e-5);
        EXPECT_LE(this->largest_error(this->cover(s, corner, f.kind), 0.25), 2e-5);
    }
    EXPECT_EQ(passes() - before, 12u * 5u); // 2,592 triangles, 571 a pass

    // A polygon that no pass can hold is refused, by number.
    s.polygons.resize(1);
    s.polygons.emplace_back();
    for (int i = 0; i < 2000; ++i)
        s.polygons.back().vertices.emplace_back(std::cos(2 * M_PI * i / 2000), 0, -std::sin(2 * M_PI * i / 2000));
    try {
        this->cover(s, inside, filter_kind::cone);
        FAIL() << "2,000 edges in a pass";
    } catch (const std::invalid_argument& e) {
        EXPECT_STREQ(
            e.what(), "edge_correction: polygons[1] has 2000 vertices; at most 1999 can be corrected, so split it");
    }
}

TYPED_TEST_P(edges, shares_are_bounded_before_they_divide)
{
    // A square drawn twice, a needle of half a degree, and a ball.
    auto& b = this->b();
    auto s = empty_scene({0.5, 2, 0.5});
    s.camera = {{0, 1, -3}, {0, 0, 0}, {0, 1, 0}, 45};
    const polygon square{{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, 0};
    s.polygons = {square, square, {{{2, 0, 0}, {3, 0, std::tan(glm::radians(0.5))}, {3, 0, 0}}, 0}};
    s.spheres = {{{4, 0.5, 0}, 0.5, 0}};
    const auto scene = upload_scene(b, s);
    discs d;
    d.add({0.5, 0, 0.5}, {0, 1, 0}, 0.4);     // share 2
    d.add({0, 0, 0.5}, {0, 1, 0}, 0.4);       // 1/2 twice
    d.add({2, 0, 0}, {0, 1, 0}, 0.4);         // 1/720
    d.add({4, 1, 0}, {0, 1, 0}, 0.4);         // on the ball
    d.add({2.9995, 0, 0.0005}, {0, 1, 0}, 0); // close to the needle's right corner; radius 0: the least one counts
    for (auto& p : d.points)
        p = glm::vec4(glm::vec3(dvec3(p) - scene.layout.center), p.w);
    for (auto& e : d.estimates)
        e = glm::vec4(1, 2, 3, e.w);
    const auto p = b.upload(std::span<const glm::vec4>(d.points)), n = b.upload(std::span<const glm::vec4>(d.normals));
    const std::vector<glm::uvec2> used(d.points.size(), glm::uvec2(7, 9));
    const std::vector<glm::vec4> errors(d.points.size(), glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    knn_estimates<typename TestFixture::B> e{b.upload(std::span<const glm::vec4>(d.estimates)),
        b.upload(std::span<const glm::uvec2>(used)), b.upload(std::span<const glm::vec4>(errors))};
    correct_edges(b, scene, p, n, e, {filter_kind::silverman, 1e-3f});
    const auto irradiance = b.download(e.irradiance), error = b.download(e.standard_error);
    const double corner
        = part_by_lines({{-1, 0}, {0, 0}, {0, std::tan(glm::radians(0.5))}}, {-0.0005, 0.0005}, 1e-3).share[3];
    ASSERT_NEAR(corner, 0.8, 0.1);
    const double factors[] = {1, 1, 256, 1, 1 / corner}, tolerances[] = {0, 1e-5, 0, 0, 2e-3};
    for (std::size_t i = 0; i < d.points.size(); ++i) {
        EXPECT_NEAR(irradiance[i].y / 2, factors[i], tolerances[i]) << i;
        EXPECT_NEAR(error[i].w / 0.4f, factors[i], tolerances[i] + 1e-6 * factors[i]) << i;
        EXPECT_EQ(irradiance[i].w, d.estimates[i].w) << i;
    }
}

} // namespace photongrid::testing
