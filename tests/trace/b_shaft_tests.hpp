// Hard case B9: shafts of shadow rays.
#pragma once

#include "hard_cases.hpp"

namespace photongrid::testing {

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
        const glm::vec3 low(device.layout.low), size(glm::vec3(device.layout.high) - low);
        random_source u(9);
        std::vector<glm::vec4> points, corners, edges_u, edges_v;
        for (int i = 0; i < 20000; ++i) {
            const auto place = [&] { return low + size * glm::vec3(u(), u(), u()); };
            auto from = place(), corner = place(), edge_u = 0.3f * size * random_direction(u),
                 edge_v = 0.3f * size * random_direction(u);
            if (i % 4 == 1)
                from.y = low.y + 1e-5f * size.y; // just above the floor, or below an object there
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
        b.template run<probes::shaft_probe>(
            {points.size(), 0u, device.layout.features}, {}, reads(device.records, p, c, eu, ev), writes(answer));
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

} // namespace photongrid::testing
