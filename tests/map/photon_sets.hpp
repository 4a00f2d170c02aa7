// Photons and query points to test with: the distributions on which neighbour searches break.
#pragma once

#include <photongrid/map/map_builders.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace photongrid::testing {

enum class distribution { uniform, clustered, planar, coincident, far_from_origin, cell_faces, box_faces };
inline constexpr distribution all_distributions[]
    = {distribution::uniform, distribution::clustered, distribution::planar, distribution::coincident,
        distribution::far_from_origin, distribution::cell_faces, distribution::box_faces};

inline const char* name_of(distribution d)
{
    constexpr const char* names[]
        = {"uniform", "clustered", "planar", "coincident", "far_from_origin", "cell_faces", "box_faces"};
    return names[static_cast<int>(d)];
}

/// Photons on the host, with the grid that covers them.
struct photon_set {
    std::vector<glm::vec4> positions, powers;
    grid g{};
};

/// Random numbers in [0, 1), the same on every machine (std::uniform_real_distribution is not).
class random_source {
public:
    explicit random_source(std::uint64_t seed) : engine_(seed) {}
    float operator()() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }

private:
    std::mt19937_64 engine_;
};

/// The grid that covers the photons of a distribution.
inline grid grid_of(distribution d, glm::uvec3 resolution)
{
    const glm::vec3 low(d == distribution::far_from_origin ? 1000.0f : 0.0f);
    return make_grid(low, low + glm::vec3(1, d == distribution::planar ? 0 : 1, 1), resolution);
}

/// Adds a photon to a set with the grid of distribution `d`.
inline void add_photon(photon_set& s, distribution d, random_source& u)
{
    const glm::vec3 centers[3] = {{0.2f, 0.3f, 0.5f}, {0.8f, 0.1f, 0.9f}, {0.5f, 0.5f, 0.5f}};
    glm::vec3 p(u(), u(), u());
    switch (d) {
    case distribution::clustered: { // density like 1/r^2 about three points
        const glm::vec3 c = centers[u.below(3)];
        const float r = 0.2f * u() * u() * u();
        p = c + r * (2.0f * p - 1.0f);
        break;
    }
    case distribution::planar: p.y = 0; break;
    case distribution::coincident: p = centers[u.below(2)]; break;
    case distribution::far_from_origin: p = glm::vec3(s.g.origin) + p; break;
    case distribution::cell_faces:
        for (int a = 0; a < 3; ++a) {
            const uint cells = glm::uvec4(s.g.resolution)[a];
            p[a] = static_cast<float>(u.below(cells + 1)) / static_cast<float>(cells);
        }
        break;
    case distribution::box_faces: p[static_cast<int>(u.below(3))] = u() < 0.5f ? 0.0f : 1.0f; break;
    case distribution::uniform: break;
    }
    s.positions.emplace_back(p, 0.0f);
    s.powers.emplace_back(u(), u(), u(), 0.0f);
}

inline photon_set make_photons(distribution d, std::size_t n, glm::uvec3 resolution, std::uint64_t seed)
{
    random_source u(seed);
    photon_set s;
    s.g = grid_of(d, resolution);
    while (s.positions.size() < n)
        add_photon(s, d, u);
    return s;
}

/// A photon for each number, which decides on nothing but its own: a property that fails shrinks to few photons.
inline photon_set make_photons(distribution d, const std::vector<std::uint64_t>& numbers, glm::uvec3 resolution)
{
    photon_set s;
    s.g = grid_of(d, resolution);
    for (const auto number : numbers) {
        random_source u(number);
        add_photon(s, d, u);
    }
    return s;
}

/// Query points in and around the photons' box, some of them photons themselves.
inline std::vector<glm::vec4> make_points(const photon_set& s, std::size_t n, std::uint64_t seed)
{
    random_source u(seed ^ 0xABCDEF);
    std::vector<glm::vec4> points;
    const glm::vec3 low(s.g.origin), extent = glm::vec3(s.g.cell) * glm::vec3(s.g.resolution);
    for (std::size_t i = 0; i < n; ++i) {
        glm::vec3 p = low + extent * (1.4f * glm::vec3(u(), u(), u()) - 0.2f);
        if (!s.positions.empty() && i % 4 == 0)
            p = glm::vec3(s.positions[u.below(static_cast<std::uint32_t>(s.positions.size()))]);
        points.emplace_back(p, 1.0f);
    }
    return points;
}

/// The kinds of maps that searches read.
enum class map_kind { sorted, routed, blocks };
inline constexpr map_kind all_maps[] = {map_kind::sorted, map_kind::routed, map_kind::blocks};
inline constexpr map_kind exact_maps[] = {map_kind::sorted, map_kind::blocks}; ///< of every photon, as it was given

inline const char* name_of(map_kind kind)
{
    constexpr const char* names[] = {"sorted map", "routed map", "block map"};
    return names[static_cast<int>(kind)];
}

/// A map of a kind; `g`, `m` and `seed` where it has a grid, slots, or draws.
template <backend B>
map_buffers<B> make_map(
    B& b, map_kind kind, photons<B> p, const grid& g, uint m = 16, uint seed = 3, uint parts = every_part)
{
    return kind == map_kind::routed ? routed_map(b, std::move(p), g, {m, seed, parts})
        : kind == map_kind::sorted  ? sorted_map(b, std::move(p), g, parts)
                                    : block_map(b, std::move(p), parts);
}

/// The ids of a map's photons, by the cells or blocks that hold them.
template <backend B>
std::vector<std::vector<uint>> ids_in(B& b, const map_buffers<B>& map)
{
    const auto list = b.download(map.list);
    std::vector<std::vector<uint>> ids;
    if (map.has_blocks())
        ids.emplace_back(list.begin(), list.begin() + map.in_blocks);
    for (const auto& c : b.download(map.cells))
        ids.emplace_back(list.begin() + c.x, list.begin() + c.x + c.y);
    return ids;
}

template <backend B>
photons<B> upload_photons(B& b, const photon_set& s)
{
    return {b.upload(std::span<const glm::vec4>(s.positions)), b.upload(std::span<const glm::vec4>(s.powers)), {}};
}

/// The squared distance as kernels compute it: float, summed x, y, z.
inline float distance2(const glm::vec4& a, const glm::vec4& b)
{
    const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    const float d2 = dx * dx + dy * dy + dz * dz;
    return d2 < std::numeric_limits<float>::min() ? 0.0f : d2;
}

/// How many elements differ in any bit.
template <class T>
std::size_t count_different_bits(const std::vector<T>& a, const std::vector<T>& b)
{
    if (a.size() != b.size())
        return std::max(a.size(), b.size());
    std::size_t n = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        n += std::memcmp(&a[i], &b[i], sizeof(T)) != 0 ? 1u : 0u;
    return n;
}

/// The first element that differs in any bit, of both, in hexadecimal; for messages.
inline std::string first_difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (std::memcmp(&a[i], &b[i], sizeof(glm::vec4)) != 0) {
            char text[200];
            const auto d = [](float v) { return static_cast<double>(v); };
            std::snprintf(text, sizeof text, "element %zu: %a %a %a %a, not %a %a %a %a", i, d(a[i].x), d(a[i].y),
                d(a[i].z), d(a[i].w), d(b[i].x), d(b[i].y), d(b[i].z), d(b[i].w));
            return text;
        }
    return "none of those that both have";
}

} // namespace photongrid::testing
