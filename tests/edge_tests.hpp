// Edge correction (docs/hard_cases.md, A9), on any backend: shares of discs against integration over scan lines in
// double, uniform fields and a picture whose light is known up to the rim. Included by each on_<backend>.cpp.
#pragma once

#include "known_answers.hpp"
#include "ray_tests.hpp"

#include <photongrid/edge_correction.hpp>

namespace photongrid::testing {

inline constexpr filter_kernel kernels_over_discs[]
    = {filter_kernel::constant, filter_kernel::cone, filter_kernel::epanechnikov, filter_kernel::silverman};

/// A plane's frame, to draw polygons in.
struct drawing_board {
    dvec3 origin{0}, right{1, 0, 0}, up{0, 0, 1};
    dvec3 at(glm::dvec2 p) const { return origin + p.x * right + p.y * up; }
    dvec3 normal() const { return glm::cross(right, up); }
    polygon draw(const std::vector<glm::dvec2>& corners) const
    {
        polygon p;
        for (const auto& c : corners)
            p.vertices.push_back(at(c));
        return p;
    }
};

inline drawing_board random_board(random_source& u)
{
    drawing_board d;
    const dvec3 n = glm::normalize(dvec3(random_direction(u)));
    d.origin = dvec3(u(), u(), u());
    d.right = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    d.up = glm::cross(n, d.right);
    return d;
}

/// Points on the surfaces of a scene, with their discs.
struct discs {
    std::vector<glm::vec4> points, normals, estimates;
    void add(const dvec3& p, const dvec3& n, double radius)
    {
        points.emplace_back(glm::vec3(p), 1.0f);
        normals.emplace_back(glm::vec3(n), 0.0f);
        estimates.emplace_back(0.0f, 0.0f, 0.0f, static_cast<float>(radius * radius));
    }
};

/// Squares of 1 m in rows on the floor, 2 m apart from middle to middle, so that no disc below 0.5 m meets two.
struct squares {
    scene s;
    uint rows = 16;
    dvec3 corner(uint i) const { return {2.0 * (i % rows), 0, 2.0 * (i / rows)}; }
    squares()
    {
        s = empty_scene({rows, 3, rows});
        s.camera = {{0, 5, 0}, {1, 0, 1}, {0, 1, 0}, 40};
        for (uint i = 0; i < rows * rows; ++i) {
            const dvec3 c = corner(i);
            s.polygons.push_back({{c, c + dvec3(0, 0, 1), c + dvec3(1, 0, 1), c + dvec3(1, 0, 0)}, 0});
        }
    }
};

template <class Tag>
class edges : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    template <class Device>
    static std::vector<glm::vec4> cover_on(
        Device& b, const device_scene<Device>& scene, const discs& d, filter_kernel kernel)
    {
        const auto p = b.upload(std::span<const glm::vec4>(d.points)),
                   n = b.upload(std::span<const glm::vec4>(d.normals)),
                   e = b.upload(std::span<const glm::vec4>(d.estimates));
        return b.download(covered_shares(b, scene, p, n, e, kernel, 0));
    }
    /// Positions of `d` are the scene's; they are recentred here. Serial's bits are compared.
    std::vector<glm::vec4> cover(const scene& s, discs d, filter_kernel kernel)
    {
        auto& b = this->b();
        const auto scene = upload_scene(b, s);
        serial_backend serial;
        const auto reference = upload_scene(serial, s);
        for (auto& p : d.points)
            p = glm::vec4(glm::vec3(dvec3(p) - scene.about.center), p.w);
        const auto shares = cover_on(b, scene, d, kernel);
        if (b.caps().exact_division && b.caps().exact_sqrt) {
            EXPECT_EQ(count_different_bits(shares, cover_on(serial, reference, d, kernel)), 0u);
        }
        return shares;
    }
    double largest_error(const std::vector<glm::vec4>& cover, double expected)
    {
        double largest = 0;
        for (const auto& c : cover)
            largest = c.y == 1 ? std::max(largest, std::abs(static_cast<double>(c.x) - expected)) : 1;
        return largest;
    }
};
TYPED_TEST_SUITE_P(edges);

TYPED_TEST_P(edges, angles_and_logarithms_are_those_of_the_library)
{
    auto& b = this->b();
    random_source u(1);
    std::vector<glm::vec4> numbers{{0, 1, 1, 0}, {1, 0, std::nextafter(1.0f, 2.0f), 0}, {0, -1, 1.41421356f, 0},
        {1, 1, 1.41421366f, 0}, {1, -1, 2, 0}, {1e-30f, 1, 1e30f, 0}, {1e-30f, -1, 3e38f, 0}, {1e30f, 1e-5f, 4, 0}};
    for (int i = 0; i < 100000; ++i) {
        const float scale = std::exp2(40 * u() - 20);
        numbers.emplace_back(u() * scale, (2 * u() - 1) * scale * (i % 3 == 0 ? 1e-3f : 1.0f),
            i % 2 == 0 ? std::exp2(100 * u() * u() * u()) : 1 + u(), 0.0f);
    }
    auto out = b.template make<glm::vec2>(numbers.size());
    b.template run<kernels::angle_probe>(
        numbers.size(), {}, reads(b.upload(std::span<const glm::vec4>(numbers))), writes(out));
    const auto values = b.download(out);
    double angle = 0, logarithm = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const glm::dvec4 n(numbers[i]);
        angle = std::max(angle, std::abs(static_cast<double>(values[i].x) - std::atan2(n.x, n.y)));
        logarithm = std::max(
            logarithm, std::abs(static_cast<double>(values[i].y) - std::log(n.z)) / std::max(1.0, std::log(n.z)));
    }
    std::printf("edges: largest error of an angle %.2g, of a logarithm %.2g (over 1 or itself)\n", angle, logarithm);
    EXPECT_LE(angle, 3e-7);
    EXPECT_LE(logarithm, 2e-7);
}

TYPED_TEST_P(edges, shares_equal_integration_over_lines)
{
    // Surfaces made of convex polygons of one plane, wound either way; beside them what must not count: a wall, a floor
    // 1 mm below, a mirror and a lamp in the plane.
    random_source u(2);
    const auto number = [&] { return static_cast<double>(u()); };
    double largest = 0;
    for (int round = 0; round < 24; ++round) {
        std::vector<std::vector<glm::dvec2>> parts;
        switch (round % 4) {
        case 0: { // a convex polygon
            std::vector<double> angles;
            for (int i = 0; i < 3 + round % 7; ++i)
                angles.push_back(2 * M_PI * (i + 0.8 * number()) / (3 + round % 7));
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
        const auto board = random_board(u);
        auto s = empty_scene(board.at({0.2, 0.1}) + board.normal());
        s.materials.push_back({"mirror", material_kind::mirror, dvec3(1)});
        for (const auto& p : parts) {
            auto wound = p;
            if (u() < 0.5f)
                std::reverse(wound.begin(), wound.end());
            s.polygons.push_back(board.draw(wound));
        }
        s.polygons.push_back({{board.at({-1, 0}), board.at({1, 0}), board.at({1, 0}) + board.normal(),
                                  board.at({-1, 0}) + board.normal()},
            0});
        auto below = board;
        below.origin -= 1e-3 * board.normal();
        s.polygons.push_back(below.draw({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}));
        s.polygons.push_back(board.draw({{-1.2, -1}, {-0.3, -1}, {-0.3, 1}, {-1.2, 1}}));
        s.polygons.back().material = 2;
        s.rectangle_lights.push_back({"lamp", board.at({0.3, -1}), 0.8 * board.right, 2.0 * board.up, dvec3(1)});
        s.camera = {board.at({0, 0}) + 3.0 * board.normal(), board.at({0, 0}), board.up, 40};

        discs d;
        std::vector<std::pair<glm::dvec2, double>> places;
        while (places.size() < 20) { // corners' and edges' neighbours more often than others
            const auto& part = parts[u.below(static_cast<std::uint32_t>(parts.size()))];
            const auto c = u.below(static_cast<std::uint32_t>(part.size()));
            glm::dvec2 middle(0),
                on_edge = glm::mix(part[c], part[(c + 1) % part.size()], places.size() % 4 == 0 ? 0.0 : number());
            for (const auto& p : part)
                middle += p / static_cast<double>(part.size());
            const auto p = glm::mix(on_edge, middle, places.size() % 3 == 0 ? 0.0 : number() * number());
            places.emplace_back(p, 0.1 + 0.7 * number() * number());
            d.add(board.at(p), u() < 0.5f ? board.normal() : -board.normal(), places.back().second);
        }
        std::vector<glm::dvec4> expected(places.size(), glm::dvec4(0));
        for (std::size_t i = 0; i < places.size(); ++i)
            for (const auto& p : parts)
                expected[i] += share_by_lines(p, places[i].first, places[i].second);
        for (const auto kernel : kernels_over_discs) {
            const auto cover = this->cover(s, d, kernel);
            for (std::size_t i = 0; i < places.size(); ++i) {
                const double error = std::abs(static_cast<double>(cover[i].x) - expected[i][static_cast<int>(kernel)]);
                largest = std::max(largest, error);
                EXPECT_EQ(cover[i].y, 1.0f);
                ASSERT_LE(error, 3e-6) << "kernel " << int(kernel) << ", surface " << round << ", point " << i << ": "
                                       << cover[i].x << ", not " << expected[i][static_cast<int>(kernel)];
            }
        }
    }
    std::printf("edges: largest error of a share %.2g\n", largest);
}

TYPED_TEST_P(edges, shares_have_the_known_values_of_a_square)
{
    random_source u(3);
    for (const auto kernel : kernels_over_discs)
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
            EXPECT_LE(this->largest_error(this->cover(s, inside, kernel), 1), 2e-6);
            EXPECT_LE(
                this->largest_error(this->cover(s, edge, kernel), 0.5), 2e-5); // rounding, over radii down to 0.01
            EXPECT_LE(this->largest_error(this->cover(s, corner, kernel), 0.25), 2e-5);
            for (const auto& c : this->cover(s, off, kernel))
                EXPECT_EQ(c.y, 0.0f);
            discs unwanted = inside;
            for (auto& p : unwanted.points)
                p.w = -1;
            for (const auto& c : this->cover(s, unwanted, kernel))
                EXPECT_EQ(c.x + c.y, 0.0f);
        }
}

TYPED_TEST_P(edges, bent_walls_hold_together_up_to_two_degrees_and_a_half)
{
    for (const auto kernel : kernels_over_discs)
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
                const auto cover = this->cover(s, side, kernel);
                if (degrees < 2.5)
                    EXPECT_LE(this->largest_error(cover, 1), 2e-3) << degrees;
                else
                    EXPECT_NEAR(cover[0].x, 0.5f, 1e-4f) << degrees;
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
    this->cover(s, inside, filter_kernel::constant);
    const auto before = passes();
    for (const auto kernel : kernels_over_discs) {
        EXPECT_LE(this->largest_error(this->cover(s, inside, kernel), 1), 2e-5);
        EXPECT_LE(this->largest_error(this->cover(s, edge, kernel), 0.5), 2e-5);
        EXPECT_LE(this->largest_error(this->cover(s, corner, kernel), 0.25), 2e-5);
    }
    EXPECT_EQ(passes() - before, 12u * 5u); // 2,592 triangles, 571 a pass

    // A polygon that no pass can hold is refused, by number.
    s.polygons.resize(1);
    s.polygons.emplace_back();
    for (int i = 0; i < 2000; ++i)
        s.polygons.back().vertices.emplace_back(std::cos(2 * M_PI * i / 2000), 0, -std::sin(2 * M_PI * i / 2000));
    try {
        this->cover(s, inside, filter_kernel::cone);
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
        p = glm::vec4(glm::vec3(dvec3(p) - scene.about.center), p.w);
    for (auto& e : d.estimates)
        e = glm::vec4(1, 2, 3, e.w);
    const auto p = b.upload(std::span<const glm::vec4>(d.points)), n = b.upload(std::span<const glm::vec4>(d.normals));
    const std::vector<glm::uvec2> used(d.points.size(), glm::uvec2(7, 9));
    const std::vector<glm::vec4> errors(d.points.size(), glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    knn_estimates<typename TestFixture::B> e{b.upload(std::span<const glm::vec4>(d.estimates)),
        b.upload(std::span<const glm::uvec2>(used)), b.upload(std::span<const glm::vec4>(errors))};
    correct_edges(b, scene, p, n, e, filter_kernel::silverman, 1e-3f);
    const auto irradiance = b.download(e.irradiance), error = b.download(e.standard_error);
    const double corner
        = share_by_lines({{-1, 0}, {0, 0}, {0, std::tan(glm::radians(0.5))}}, {-0.0005, 0.0005}, 1e-3)[3];
    ASSERT_NEAR(corner, 0.8, 0.1);
    const double factors[] = {1, 1, 256, 1, 1 / corner}, tolerances[] = {0, 1e-5, 0, 0, 2e-3};
    for (std::size_t i = 0; i < d.points.size(); ++i) {
        EXPECT_NEAR(irradiance[i].y / 2, factors[i], tolerances[i]) << i;
        EXPECT_NEAR(error[i].w / 0.4f, factors[i], tolerances[i] + 1e-6 * factors[i]) << i;
        EXPECT_EQ(irradiance[i].w, d.estimates[i].w) << i;
    }
}

TYPED_TEST_P(edges, uniform_squares_read_one_up_to_their_corners)
{
    auto& b = this->b();
    const squares all;
    const auto scene = upload_scene(b, all.s);
    const uint n = all.rows * all.rows, photons_each = 200;
    random_source u(5);
    photon_set set;
    set.g = make_grid(scene.about.low, scene.about.high, {96, 1, 96});
    for (uint i = 0; i < n * photons_each; ++i) { // so many on the average: a Poisson process
        const dvec3 p = all.corner(u.below(n)) + dvec3(u(), 0, u()) - scene.about.center;
        set.positions.emplace_back(glm::vec3(p), 0.0f);
        set.powers.emplace_back(1.0f / photons_each);
    }
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    std::vector<glm::vec4> points, normals;
    for (uint i = 0; i < n; ++i)
        for (const auto& at : {dvec3(0.5, 0, 0.5), dvec3(0.5, 0, 0), dvec3(0.5, 0, 1), dvec3(0, 0, 0.5),
                 dvec3(1, 0, 0.5), dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(1, 0, 1)}) {
            points.emplace_back(glm::vec3(all.corner(i) + at - scene.about.center), 1.0f);
            normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
        }
    const auto p = b.upload(std::span<const glm::vec4>(points)), np = b.upload(std::span<const glm::vec4>(normals));
    for (const auto search : {search_kind::exact_k, search_kind::fixed_radius})
        for (const auto kernel : kernels_over_discs) {
            knn_settings k{.k = 16, .max_radius = search == search_kind::exact_k ? 0.5f : 0.3f, .min_radius = 1e-6f};
            k.search = search;
            k.kernel = kernel;
            k.errors = true;
            auto e = knn_grid_estimate(b, map, p, np, k);
            const auto plain = b.download(e.irradiance), plain_errors = b.download(e.standard_error);
            correct_edges(b, scene, p, np, e, kernel, k.min_radius);
            const auto whole = b.download(e.irradiance), errors = b.download(e.standard_error);
            const char* places[] = {"middle", "edge", "corner"};
            for (int place = 0; place < 3; ++place) {
                double sum = 0, squared = 0, error = 0, without = 0, m = 0;
                for (std::size_t i = 0; i < points.size(); ++i)
                    if ((i % 9 == 0 ? 0 : i % 9 < 5 ? 1 : 2) == place) {
                        const double v = static_cast<double>(whole[i].x);
                        sum += v, squared += v * v, m += 1;
                        error += static_cast<double>(errors[i].x);
                        without += static_cast<double>(plain[i].x);
                        EXPECT_EQ(whole[i].w, plain[i].w) << "the radius stays";
                        if (plain[i].x > 0) {
                            EXPECT_NEAR(errors[i].w / whole[i].x, plain_errors[i].w / plain[i].x, 1e-5f)
                                << "the relative error stays";
                        }
                    }
                const double mean = sum / m, spread = std::sqrt(squared / m - mean * mean),
                             known = place == 0 ? 1
                    : place == 1                ? 0.5
                                                : 0.25;
                const auto where = std::string(places[place]) + ", kernel " + std::to_string(int(kernel)) + ", search "
                    + std::to_string(int(search));
                EXPECT_NEAR(mean, 1, 4 * spread / std::sqrt(m)) << where;
                EXPECT_NEAR(without / m, known, 4 * known * spread / std::sqrt(m)) << where;
                EXPECT_NEAR(error / m, spread, 0.15 * spread) << where << ": standard error reported";
                EXPECT_LE(4 * spread / std::sqrt(m), place == 0 ? 0.12 : 0.06) << "the test sees enough";
            }
        }
}

TYPED_TEST_P(edges, a_floor_lit_by_a_mirror_is_right_up_to_its_rim)
{
    // A bulb below a mirror: caustic light falls onto the floor as from a bulb as far above the mirror.
    scene s;
    s.materials = {{"white", material_kind::lambertian, dvec3(0.5)}, {"mirror", material_kind::mirror, dvec3(1)}};
    s.polygons
        = {{{{-0.5, 0, -0.5}, {-0.5, 0, 0.5}, {0.5, 0, 0.5}}, 0}, {{{-0.5, 0, -0.5}, {0.5, 0, 0.5}, {0.5, 0, -0.5}}, 0},
            {{{-3, 1.25, -3}, {3, 1.25, -3}, {3, 1.25, 3}, {-3, 1.25, 3}}, 1}};
    const double height = 1.5, power = 100;
    s.point_lights = {{"bulb", {0, 1, 0}, dvec3(power)}};
    s.camera = {{0, 1.2, 0}, {0, 0, 0}, {0, 0, -1}, glm::degrees(2 * std::atan(0.5 / 1.2)) - 0.01};
    s.render = {.width = 48, .height = 48, .photons = 15000, .k = 100, .grid = {40, 1, 40}, .max_radius = 0.2};
    s.render.only = light_part::caustic;
    s.render.leaks = {.side = true, .min_cosine = 0.5f};
    s.render.aov = true;
    image pictures[2];
    render_stats stats[2];
    const auto built = build_map(this->b(), s, s.render, {}, stats[0]);
    for (const bool corrected : {false, true}) {
        auto settings = s.render;
        settings.edges = corrected ? edge_correction::polygons : edge_correction::none;
        pictures[corrected] = draw(this->b(), built, s.camera, settings, {}, stats[corrected]);
        double sums[3] = {}, counts[3] = {};
        for (uint y = 0; y < 48; ++y)
            for (uint x = 0; x < 48; ++x) {
                const double fx = (x + 0.5) / 48 - 0.5, fz = (y + 0.5) / 48 - 0.5,
                             d2 = height * height + fx * fx + fz * fz;
                const double known = 0.5 / M_PI * power / (4 * M_PI) * height / (d2 * std::sqrt(d2)); // radiance
                const uint across = std::min(x, 47 - x), down = std::min(y, 47 - y);
                const int place = across < 1 && down < 1                   ? 2
                    : (across < 1 && down > 5) || (down < 1 && across > 5) ? 1
                    : across > 6 && down > 6                               ? 0
                                                                           : -1;
                if (place >= 0) {
                    sums[place] += static_cast<double>(pictures[corrected].pixels[y * 48 + x].x) / known;
                    counts[place] += 1;
                }
            }
        for (double* v : {&sums[0], &sums[1], &sums[2]})
            *v /= counts[v - sums];
        std::printf("edges: light over the known, %s: inside %.3f, rim %.3f, corners %.3f\n",
            corrected ? "corrected" : "as it is", sums[0], sums[1], sums[2]);
        // Discs have some 0.045 m radius, pixels of the rim lie 0.01 m inside.
        EXPECT_NEAR(sums[0], 1, 0.05);
        if (corrected) {
            EXPECT_NEAR(
                sums[1], 1, 0.09); // four standard errors: a disc sees to 14 %, and some fifty lie along the rim
            EXPECT_NEAR(sums[2], 1, 0.28);
        } else {
            EXPECT_LT(sums[1], 0.8);
            EXPECT_LT(sums[2], 0.65);
        }
    }
    // What estimates say of themselves stays.
    EXPECT_EQ(stats[0].estimate.mean_count, stats[1].estimate.mean_count);
    EXPECT_EQ(stats[0].estimate.mean_radius, stats[1].estimate.mean_radius);
    EXPECT_EQ(count_different_bits(pictures[0].layers.radius, pictures[1].layers.radius), 0u);
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i)
        ASSERT_NEAR(pictures[0].layers.relative_error[i], pictures[1].layers.relative_error[i], 1e-5f);
}

TYPED_TEST_P(edges, pictures_equal_the_serial_backends)
{
    auto& b = this->b();
    for (auto s : {small_cornell(), all_shapes()})
        for (const auto search : {search_kind::at_least_k, search_kind::exact_k}) {
            s.render.width = s.render.height = 32;
            s.render.photons = 2000;
            s.render.edges = edge_correction::polygons;
            s.render.leaks.min_cosine = 0.5f;
            s.render.search = search;
            serial_backend serial;
            render_stats stats;
            const auto mine = render(b, s, s.render, {}, stats);
            EXPECT_EQ(stats.invalid_pixels, 0u);
            if (b.caps().exact_division && b.caps().exact_sqrt) {
                EXPECT_LE(relative_mse(mine, render(serial, s, s.render, {}, stats)), 1e-9);
            }
            s.render.edges = edge_correction::none;
            EXPECT_GT(relative_mse(mine, render(b, s, s.render, {}, stats)), 1e-4);
        }
}

TYPED_TEST_P(edges, correction_needs_the_normals_policy)
{
    const auto s = small_cornell();
    for (const leak_policy& leaks :
        {leak_policy{}, leak_policy{.side = true}, leak_policy{.side = true, .compression = 4},
            leak_policy{.min_cosine = 0}, leak_policy{.min_cosine = -0.5f}}) {
        auto settings = s.render;
        settings.leaks = leaks;
        EXPECT_NO_THROW(check(settings));
        settings.edges = edge_correction::polygons;
        render_stats stats;
        try {
            render(this->b(), s, settings, {}, stats);
            FAIL() << "corrected with the light of adjoining walls";
        } catch (const std::invalid_argument& e) {
            EXPECT_EQ(std::string(e.what()).find("edge_correction: "), 0u) << e.what();
            EXPECT_NE(std::string(e.what()).find("needs the leak policy normals"), std::string::npos) << e.what();
        }
        settings.leaks.min_cosine = 0.25f;
        EXPECT_NO_THROW(check(settings));
        EXPECT_EQ(as_paper(settings).edges, edge_correction::none);
        EXPECT_NO_THROW(check(as_paper(settings)));
    }
}

REGISTER_TYPED_TEST_SUITE_P(edges, angles_and_logarithms_are_those_of_the_library, shares_equal_integration_over_lines,
    shares_have_the_known_values_of_a_square, bent_walls_hold_together_up_to_two_degrees_and_a_half,
    thousands_of_polygons_take_several_passes, shares_are_bounded_before_they_divide,
    uniform_squares_read_one_up_to_their_corners, a_floor_lit_by_a_mirror_is_right_up_to_its_rim,
    pictures_equal_the_serial_backends, correction_needs_the_normals_policy);

} // namespace photongrid::testing
