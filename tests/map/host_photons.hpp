// Photons and query points as hosts have them, and their neighbours by brute force.
#pragma once

#include <photongrid/photon_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace photongrid::testing {

struct host_photon {
    glm::vec3 position;
    glm::vec3 power;
    glm::vec3 direction;
    glm::vec3 normal;
};

/// Photons in a slab; on a coarse lattice if `ties` is set.
inline std::vector<host_photon> some_photons(uint seed, std::size_t n, bool ties)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto number = [&] { return ties ? std::floor(8 * unit(random)) / 8 : unit(random); };
    std::vector<host_photon> photons(n);
    for (auto& p : photons) {
        p.position = {2 * number(), number(), 0.25f * number()};
        p.power = {unit(random), unit(random), unit(random)};
        p.direction = glm::normalize(glm::vec3(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.7f));
        p.normal = glm::normalize(glm::vec3(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) + 0.2f));
    }
    return photons;
}
inline std::vector<glm::vec3> some_query_points(uint seed, std::size_t n, bool ties)
{
    std::vector<glm::vec3> query_points;
    for (const auto& p : some_photons(seed + 1000, n, ties))
        query_points.push_back(p.position * 1.2f - 0.1f * (ties ? 0.0f : 1.0f));
    return query_points;
}

using neighbours_of_point = std::vector<std::pair<float, photon_id>>;
/// No photon at a larger squared distance, m^2, is found.
inline constexpr float largest_distance2 = 1e38f;

/// Every photon that a map holds and that is not too far away, by distance and id, the specification's distances.
inline neighbours_of_point by_brute_force(const std::vector<host_photon>& photons, glm::vec3 p)
{
    const auto finite = [](glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    neighbours_of_point all;
    for (uint i = 0; finite(p) && i < photons.size(); ++i) {
        const float dx = photons[i].position.x - p.x, dy = photons[i].position.y - p.y,
                    dz = photons[i].position.z - p.z;
        const float xx = dx * dx, yy = dy * dy, zz = dz * dz, xy = xx + yy;
        const float d2 = xy + zz < std::numeric_limits<float>::min() ? 0.0f : xy + zz; // denormal: 0
        if (finite(photons[i].position) && finite(photons[i].power) && d2 <= largest_distance2)
            all.emplace_back(d2, i);
    }
    std::sort(all.begin(), all.end());
    return all;
}

inline constexpr glm::vec3 up{0, 0, 1};

} // namespace photongrid::testing
