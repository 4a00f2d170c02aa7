// The moments of discs that polygons cover in part, and the bias of sloped light that they tell, on any backend.
#pragma once

#include "share_tests.hpp"

namespace photongrid::testing {

TYPED_TEST_P(edges, moments_equal_integration_over_lines)
{
    auto& b = this->b();
    serial_backend serial;
    random_source u(12);
    double largest = 0;
    for (int round = 0; round < 12; ++round) {
        const auto parts = convex_parts(round, u);
        const auto board = random_board(u);
        const auto s = surface_beside_others(parts, board, u);
        const auto places = places_on(parts, u);
        auto d = discs_at(places, board, u);
        const auto scene = upload_scene(b, s);
        const auto reference = upload_scene(serial, s);
        for (auto& p : d.points)
            p = glm::vec4(glm::vec3(dvec3(p) - scene.layout.center), p.w);
        std::vector<disc_part> expected(places.size());
        for (std::size_t i = 0; i < places.size(); ++i)
            for (const auto& p : parts) {
                const auto part = part_by_lines(p, places[i].first, places[i].second);
                expected[i].share += part.share;
                expected[i].first_x += part.first_x;
                expected[i].first_y += part.first_y;
                expected[i].second += part.second;
            }
        for (const auto& f : filters) {
            const auto on = [&](auto& device, const auto& uploaded) {
                const auto m = covered_moments(device, uploaded, device.upload(std::span<const glm::vec4>(d.points)),
                    device.upload(std::span<const glm::vec4>(d.normals)),
                    device.upload(std::span<const glm::vec4>(d.estimates)), f.kind);
                return std::array{device.download(m.shares), device.download(m.firsts), device.download(m.seconds)};
            };
            const auto [shares, firsts, seconds] = on(b, scene);
            if (b.caps().exact_division && b.caps().exact_sqrt) {
                const auto same = on(serial, reference);
                EXPECT_EQ(count_different_bits(shares, same[0]), 0u);
                EXPECT_EQ(count_different_bits(firsts, same[1]), 0u);
                EXPECT_EQ(count_different_bits(seconds, same[2]), 0u);
            }
            for (std::size_t i = 0; i < places.size(); ++i) {
                // The board's axes in the basis of the point's normal.
                const auto n = glm::vec3(d.normals[i]);
                const auto basis = kernels::basis_about(n);
                const auto axis = [&](const glm::vec3& a) {
                    return glm::dvec2(glm::dot(dvec3(a), board.right), glm::dot(dvec3(a), board.up));
                };
                const glm::dvec2 e1 = axis(basis.u), e2 = axis(basis.v);
                const auto& x = expected[i];
                const auto first = [&](filter_kind kind) {
                    const auto number = static_cast<int>(kind);
                    const glm::dvec2 on_board(x.first_x[number], x.first_y[number]);
                    return glm::dvec2(glm::dot(on_board, e1), glm::dot(on_board, e2));
                };
                const auto second = [&](const glm::dvec2& v, const glm::dvec2& w) {
                    return v.x * w.x * x.second.x + (v.x * w.y + v.y * w.x) * x.second.y + v.y * w.y * x.second.z;
                };
                const auto even = first(filter_kind::constant), inner = first(filter_kind::epanechnikov),
                           filtered = first(f.kind);
                const glm::dvec4 known[] = {{x.share[0], x.share[2], filtered.x, filtered.y},
                    {even.x, even.y, inner.x, inner.y}, {second(e1, e1), second(e1, e2), second(e2, e2), 0}};
                for (const auto& [found, is] :
                    {std::pair{shares[i], known[0]}, {firsts[i], known[1]}, {seconds[i], known[2]}})
                    for (int c = 0; c < 4; ++c) {
                        largest = std::max(largest, std::abs(static_cast<double>(found[c]) - is[c]));
                        ASSERT_NEAR(found[c], is[c], 4e-6)
                            << "filter " << f.name << ", surface " << round << ", point " << i << ", component " << c;
                    }
            }
        }
    }
    std::printf("edges: largest error of a moment %.2g\n", largest);
}

/// Light with a slope, of which an estimate at an edge is too high or too low by as much as it tells.
TYPED_TEST_P(edges, a_slope_beside_an_edge_is_reported)
{
    auto& b = this->b();
    const squares all;
    const auto scene = upload_scene(b, all.s);
    const uint n = all.rows * all.rows, photons_each = 1500;
    const double squares_drawn = n;
    const auto light = [](double x, double z) { return 1 + 1.2 * (x - 0.5) - 0.6 * (z - 0.5); };
    random_source u(7);
    photon_set set;
    set.g = make_grid(scene.layout.low, scene.layout.high, {96, 1, 96});
    while (set.positions.size() < n * photons_each) {
        const double x = static_cast<double>(u()), z = static_cast<double>(u());
        if (static_cast<double>(u()) * 1.9 > light(x, z))
            continue;
        const dvec3 p = all.corner(u.below(n)) + dvec3(x, 0, z) - scene.layout.center;
        set.positions.emplace_back(glm::vec3(p), 0.0f);
        set.powers.emplace_back(0.5f / photons_each, 1.0f / photons_each, 1.5f / photons_each, 0.0f);
    }
    const auto map = sorted_map(b, upload_photons(b, set), set.g);
    const std::vector<glm::dvec2> places{
        {0, 0.5}, {0.1, 0.5}, {0.5, 1}, {0.97, 0.5}, {0, 0}, {1, 1}, {0.05, 0.12}, {0.9, 0.03}};
    std::vector<glm::vec4> points, normals;
    for (uint i = 0; i < n; ++i)
        for (const auto& at : places) {
            points.emplace_back(glm::vec3(all.corner(i) + dvec3(at.x, 0, at.y) - scene.layout.center), 1.0f);
            normals.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
        }
    const auto p = b.upload(std::span<const glm::vec4>(points)), np = b.upload(std::span<const glm::vec4>(normals));
    for (const auto& f : filters) {
        const knn_settings k{
            .max_radius = 0.45f, .search = search_kind::fixed_radius, .filter = f.kind, .biases = true};
        auto e = knn_grid_estimate(b, map, p, np, k);
        correct_edges(b, scene, p, np, e, f.kind);
        const auto estimates = b.download(e.irradiance), reported = b.download(e.biases.bias);
        for (std::size_t place = 0; place < places.size(); ++place) {
            const double known = light(places[place].x, places[place].y);
            glm::dvec3 bias(0), difference(0), squares(0);
            for (std::size_t i = place; i < points.size(); i += places.size()) {
                const glm::dvec3 is = glm::dvec3(estimates[i]) - known * glm::dvec3(0.5, 1, 1.5),
                                 off = glm::dvec3(reported[i]) - is;
                bias += is / squares_drawn;
                difference += off / squares_drawn;
                squares += off * off / squares_drawn;
            }
            for (int c = 0; c < 3; ++c) {
                const double error = std::sqrt((squares[c] - difference[c] * difference[c]) / squares_drawn);
                EXPECT_NEAR(difference[c], 0, 4 * error) << f.name << ", place " << place << ", channel " << c;
                EXPECT_LT(error, 0.03) << "the test sees enough";
            }
            if (f.kind == filter_kind::silverman)
                std::printf("edges: slope, %s, (%g, %g): bias %+.3f, reported %+.3f\n", f.name, places[place].x,
                    places[place].y, bias.y, bias.y + difference.y);
        }
    }
}

} // namespace photongrid::testing
