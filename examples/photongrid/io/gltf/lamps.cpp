#include <photongrid/io/gltf/lamps.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

namespace photongrid::gltf {

bool is_closed(const mesh& m)
{
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers; // of places
    std::vector<std::uint32_t> place(m.positions.size());
    for (std::size_t v = 0; v < place.size(); ++v) {
        const auto p = m.positions[v] + 0.0f; // -0 and 0 are one
        place[v] = numbers
                       .try_emplace({std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                                        std::bit_cast<std::uint32_t>(p.z)},
                           static_cast<std::uint32_t>(numbers.size()))
                       .first->second;
    }
    std::unordered_map<std::uint64_t, int> edges; // how often each is gone along, minus how often back
    for (const auto& t : m.triangles)
        for (int c = 0; c < 3; ++c) {
            const auto from = place[t[c]], to = place[t[(c + 1) % 3]];
            if (from != to)
                edges[std::uint64_t{std::min(from, to)} << 32 | std::max(from, to)] += from < to ? 1 : -1;
        }
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

namespace {
    /// The texel at a place in a texture. The space between texels is not interpolated.
    dvec3 texel_at(const texture_use& t, const glm::dvec2& coordinates)
    {
        const auto place = t.scale * coordinates + t.offset;
        const auto cell = [&](double v, std::uint32_t size) {
            const double inside = t.wrap == texture_wrap::clamp ? std::clamp(v, 0.0, 1.0) : v - std::floor(v);
            return std::min(static_cast<std::uint32_t>(inside * size), size - 1);
        };
        const auto x = cell(place.x, t.map->width), y = cell(1 - place.y, t.map->height);
        return dvec3(t.map->texels[std::size_t{y} * t.map->width + x]) / 65535.0;
    }

    /// The mean of the texels on a triangle, at places in each.
    dvec3 mean_on(const texture_use& t, const std::array<glm::dvec2, 3>& corners)
    {
        const glm::dvec2 texels(t.map->width, t.map->height);
        double longest = 0;
        for (std::size_t c = 0; c < 3; ++c)
            longest = std::max(longest, glm::length((corners[(c + 1) % 3] - corners[c]) * t.scale * texels));
        const int steps = static_cast<int>(std::clamp(std::ceil(longest), 1.0, 64.0)); // along an edge
        dvec3 sum(0);
        int places = 0;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; i + j < steps; ++j, ++places) {
                const double u = (i + 1.0 / 3) / steps, v = (j + 1.0 / 3) / steps;
                sum += texel_at(t, corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v);
            }
        return sum / static_cast<double>(places);
    }

    /// The vertices of some triangles.
    std::shared_ptr<const mesh> some_of(const mesh& m, const std::vector<glm::uvec3>& triangles)
    {
        if (triangles.empty())
            return nullptr;
        if (triangles.size() == m.triangles.size())
            return std::make_shared<const mesh>(m);
        mesh made;
        std::unordered_map<std::uint32_t, std::uint32_t> numbers;
        for (auto t : triangles) {
            for (int c = 0; c < 3; ++c) {
                const auto [known, is_new]
                    = numbers.try_emplace(t[c], static_cast<std::uint32_t>(made.positions.size()));
                if (is_new) {
                    const auto add = [&](auto& to, const auto& from) {
                        if (!from.empty())
                            to.push_back(from[t[c]]);
                    };
                    add(made.positions, m.positions);
                    add(made.normals, m.normals);
                    add(made.texture_coordinates, m.texture_coordinates);
                    add(made.colors, m.colors);
                }
                t[c] = known->second;
            }
            made.triangles.push_back(t);
        }
        return std::make_shared<const mesh>(std::move(made));
    }
} // namespace

emitting_parts divided(const mesh& m, const texture_use& emission)
{
    std::vector<glm::uvec3> lit, dark;
    dvec3 sum(0);
    double area = 0;
    for (std::size_t n = 0; n < m.triangles.size(); ++n) {
        const auto& t = m.triangles[n];
        const auto at = [&](int c) { return glm::dvec2(m.texture_coordinates[t[c]]); };
        const auto colour = mean_on(emission, {at(0), at(1), at(2)});
        if (colour == dvec3(0)) {
            dark.push_back(t);
            continue;
        }
        lit.push_back(t);
        const auto corners = corners_of(m, n);
        const double size
            = glm::length(glm::cross(dvec3(corners[1]) - dvec3(corners[0]), dvec3(corners[2]) - dvec3(corners[0])));
        sum += colour * size;
        area += size;
    }
    emitting_parts made{some_of(m, lit), some_of(m, dark)};
    if (area > 0)
        made.colour = sum / area;
    return made;
}

} // namespace photongrid::gltf
