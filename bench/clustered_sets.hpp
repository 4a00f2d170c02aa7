// Photons that lie many times as densely in some places as in others, and other sets that are hard for a uniform grid,
// for the verbs `clusters` and `maps`. Lengths in metres. Every run makes the same sets.
#pragma once

#include "data_sets.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

namespace photongrid::bench {

/// A set by name. `positions_of` makes about `photons` positions.
struct clustered_set {
    const char* name;
    const char* what;
    std::vector<vec4> (*positions_of)(uint photons, random_source& u);
    uint times = 1;              ///< how many times as many photons as the other sets
    bool has_equal_gaps = false; ///< equal or evenly spaced: a grid of its own suits it
};

namespace sets {
    using glm::dvec3;

    inline vec4 position(const dvec3& p) { return vec4(vec3(p), 0.0f); }

    inline double even(random_source& u) { return static_cast<double>(u()); } ///< from 0 to 1
    inline double normal(random_source& u) { return static_cast<double>(u.normal()); }

    /// A point of the unit cube around 0.
    inline dvec3 in_cube(random_source& u)
    {
        const double x = even(u), y = even(u), z = even(u);
        return dvec3(x, y, z) - 0.5;
    }

    inline dvec3 direction(random_source& u)
    {
        for (;;) {
            const double x = normal(u), y = normal(u), z = normal(u);
            const double length = std::sqrt(x * x + y * y + z * z);
            if (length > 0)
                return dvec3(x, y, z) / length;
        }
    }

    /// n positions, the i-th of them one(i).
    template <class One>
    std::vector<vec4> positions(uint n, One one)
    {
        std::vector<vec4> all;
        all.reserve(n);
        for (uint i = 0; i < n; ++i)
            all.push_back(position(one(i)));
        return all;
    }

    inline std::vector<vec4> uniform(uint n, random_source& u)
    {
        return positions(n, [&](uint) { return in_cube(u) + 0.5; });
    }

    inline std::vector<vec4> sphere(uint n, random_source& u)
    {
        return positions(n, [&](uint) { return direction(u); });
    }

    /// The density in the focus falls with 1/r, as in caustics.
    inline std::vector<vec4> focus(uint n, random_source& u)
    {
        return positions(n, [&](uint i) {
            const double a = even(u), b = even(u);
            if (i % 2 == 0)
                return dvec3(10 * a, 0, 10 * b);
            const double r = 0.005 * a, angle = 6.283185307179586 * b;
            return dvec3(6.3 + r * std::cos(angle), 0, 4.1 + r * std::sin(angle));
        });
    }

    inline std::vector<vec4> two_scales(uint n, random_source& u)
    {
        return positions(n, [&](uint i) { return (i % 2 == 0 ? 1e6 : 1e-6) * in_cube(u); });
    }

    inline std::vector<vec4> helix(uint n, random_source& u)
    {
        return positions(n, [&](uint) {
            const double turns = 10 * even(u), angle = 6.283185307179586 * turns;
            const double x = normal(u), y = normal(u), z = normal(u);
            return dvec3(std::cos(angle), std::sin(angle), 0.2 * turns) + 1e-7 * dvec3(x, y, z);
        });
    }

    /// The radius' logarithm has a standard deviation of two decades: three of them are the six decades to either side.
    inline std::vector<vec4> log_normal(uint n, random_source& u)
    {
        return positions(n, [&](uint) {
            const double decades = std::clamp(2 * normal(u), -6.0, 6.0);
            return std::pow(10.0, decades) * direction(u);
        });
    }

    /// Positions are relative to the centre of the innermost cube, near which single precision is finest.
    inline std::vector<vec4> nested(uint n, random_source& u)
    {
        constexpr int levels = 8;
        std::vector<std::pair<dvec3, double>> cubes{{dvec3(0), 1.0}}; // centres and edges
        for (int level = 0; level < levels; ++level) {
            const auto [centre, edge] = cubes.back();
            cubes.emplace_back(centre + edge * in_cube(u), edge / (level % 2 == 0 ? 10 : 100));
        }
        // From the inside out, so that the small offsets between small cubes are not lost in those between large ones.
        std::vector<dvec3> centres(cubes.size(), dvec3(0));
        for (std::size_t i = cubes.size() - 1; i > 0; --i)
            centres[i - 1] = centres[i] + (cubes[i - 1].first - cubes[i].first);
        return positions(n, [&](uint) {
            std::size_t level = 0;
            while (level < levels && u() < 0.5f)
                ++level;
            return centres[level] + cubes[level].second * in_cube(u);
        });
    }

    /// Every tenth part of the photons has one outlier, in its middle.
    inline std::vector<vec4> outliers(uint n, random_source& u)
    {
        return positions(n, [&](uint i) { return i % (n / 10) == n / 20 ? 1e6 * direction(u) : in_cube(u); });
    }

    /// How far a ray goes to the first wall of a hall from the inside, or to the first of the boxes in it.
    inline double distance_in_hall(const dvec3& from, const dvec3& ray)
    {
        /// Where the ray enters and leaves a box.
        const auto span = [&](const dvec3& low, const dvec3& high) {
            double enters = -1e9, leaves = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                if (ray[axis] == 0)
                    continue;
                const double a = (low[axis] - from[axis]) / ray[axis], b = (high[axis] - from[axis]) / ray[axis];
                enters = std::max(enters, std::min(a, b));
                leaves = std::min(leaves, std::max(a, b));
            }
            return std::pair(enters, leaves);
        };
        double nearest = span(dvec3(0), dvec3(60, 8, 40)).second;
        for (const auto& [low, high] :
            {std::pair(dvec3(18, 0, 22), dvec3(19.5, 1, 24)), std::pair(dvec3(26, 0, 10), dvec3(28, 3, 13)),
                std::pair(dvec3(40, 0, 25), dvec3(43, 2.5, 31)), std::pair(dvec3(6, 0, 5), dvec3(9, 4, 8))}) {
            const auto [enters, leaves] = span(low, high);
            if (enters > 0 && enters < leaves)
                nearest = std::min(nearest, enters);
        }
        return nearest;
    }

    /// Column by column, as scanners measure; each distance with a noise of 1 mm. The scanner does not see its own
    /// foot.
    inline std::vector<vec4> laser(uint n, random_source& u)
    {
        constexpr double to_radians = 3.141592653589793 / 180, lowest = -60, highest = 90;
        const dvec3 scanner(20, 1.5, 20);
        const auto columns = static_cast<uint>(std::sqrt(n * 360.0 / (highest - lowest)));
        const uint rows = n / columns;
        return positions(rows * columns, [&](uint i) {
            const double azimuth = 360 * to_radians * (i / rows) / columns;
            const double elevation = to_radians * (lowest + (highest - lowest) * (i % rows + 0.5) / rows);
            const dvec3 ray(
                std::cos(elevation) * std::cos(azimuth), std::sin(elevation), std::cos(elevation) * std::sin(azimuth));
            return scanner + (distance_in_hall(scanner, ray) + 0.001 * normal(u)) * ray;
        });
    }

    /// n photons in cells, of which the i-th gets a share in proportion to i^-exponent, rounded.
    inline std::vector<uint> zipf_counts(uint n, std::size_t cells, double exponent)
    {
        std::vector<double> weights(cells);
        for (std::size_t i = 0; i < cells; ++i)
            weights[i] = std::pow(static_cast<double>(i + 1), -exponent);
        const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
        std::vector<uint> counts;
        double sum = 0;
        uint given = 0;
        for (const double w : weights) {
            sum += w;
            const auto until = std::min(n, static_cast<uint>(std::lround(n * sum / all)));
            counts.push_back(until - given);
            given = until;
        }
        return counts;
    }

    /// Bits of entropy of a photon's cell.
    inline double entropy_of(const std::vector<uint>& counts)
    {
        const double n = std::accumulate(counts.begin(), counts.end(), 0.0);
        double bits = 0;
        for (const uint c : counts)
            if (c > 0)
                bits -= c / n * std::log2(c / n);
        return bits;
    }

    inline std::vector<vec4> entropy(uint n, random_source& u)
    {
        constexpr uint edge = 64;
        constexpr double bits = 5.1;
        double flat = 0, steep = 10; // exponents; the entropy falls with them
        std::vector<uint> counts;
        for (int step = 0; step < 40; ++step) {
            const double exponent = (flat + steep) / 2;
            counts = zipf_counts(n, edge * edge * edge, exponent);
            (entropy_of(counts) > bits ? flat : steep) = exponent;
        }
        if (std::abs(entropy_of(counts) - bits) > 0.01)
            throw std::logic_error("entropy: " + std::to_string(entropy_of(counts)) + " bits");
        std::mt19937 engine(3);
        std::vector<uint> cells(counts.size());
        std::iota(cells.begin(), cells.end(), 0u);
        std::shuffle(cells.begin(), cells.end(), engine);
        std::vector<uint> cell_of_photon;
        for (std::size_t i = 0; i < counts.size(); ++i)
            cell_of_photon.insert(cell_of_photon.end(), counts[i], cells[i]);
        std::shuffle(cell_of_photon.begin(), cell_of_photon.end(), engine);
        return positions(n, [&](uint i) {
            const uint cell = cell_of_photon[i];
            return (dvec3(cell % edge, cell / edge % edge, cell / edge / edge) + in_cube(u) + 0.5) / double{edge};
        });
    }

    inline std::vector<vec4> equal(uint n, random_source&)
    {
        return positions(n, [](uint) { return dvec3(1, 2, 3); });
    }

    inline std::vector<vec4> lattice(uint n, random_source&)
    {
        const auto edge = static_cast<uint>(std::lround(std::cbrt(n)));
        return positions(edge * edge * edge, [&](uint i) { return dvec3(i % edge, i / edge % edge, i / edge / edge); });
    }

    inline std::vector<vec4> two_clumps(uint n, random_source& u)
    {
        return positions(n, [&](uint i) { return in_cube(u) + dvec3(i % 2 == 0 ? 0 : 1e9, 0, 0); });
    }
} // namespace sets

inline constexpr const char* only_by_name = "uniform10m"; ///< the set that is made only when it is asked for

inline std::span<const clustered_set> clustered_sets()
{
    static constexpr clustered_set all[] = {
        {"uniform", "evenly in the unit cube", sets::uniform},
        {"sphere", "evenly on the unit sphere", sets::sphere},
        {"focus", "evenly on a floor of 10 m x 10 m, half of them in a focus of 1 cm", sets::focus},
        {"two_scales", "half of them in a cube of 10^-6 m, the others in one of 10^6 m", sets::two_scales},
        {"helix", "along a helix, with noise of 10^-7 of its radius", sets::helix},
        {"log_normal", "in all directions, the distance log-normal from 10^-6 m to 10^6 m", sets::log_normal},
        {"nested", "eight cubes, each in the one before, 10 or 100 times as small, with half of its photons",
            sets::nested},
        {"outliers", "evenly in the unit cube, ten of them 10^6 m away", sets::outliers},
        {"laser", "a laser scan of a hall with boxes, at equal angles: the floor's density varies by 10^4",
            sets::laser},
        {"entropy", "in cells of a grid of 64^3, whose numbers have 5.1 bits of entropy", sets::entropy},
        {"equal", "all at one point", sets::equal, 1, true},
        {"lattice", "a lattice of whole numbers, full of equal distances", sets::lattice, 1, true},
        {"two_clumps", "two unit cubes 10^9 m apart; in single precision the far one is a square", sets::two_clumps, 1,
            true},
        {only_by_name, "evenly in the unit cube, ten times as many", sets::uniform, 10},
    };
    return all;
}

/// The set with its photons and without points.
inline data_set make_clustered_set(const clustered_set& which, uint photons)
{
    random_source u(1);
    data_set s{which.name, which.what, 0, which.positions_of(which.times * photons, u), {}, {}};
    add_powers(s, u);
    return s;
}

/// Searches are made at every photon, in the set's order.
inline void search_at_photons(data_set& s)
{
    for (const auto& p : s.positions)
        s.points.emplace_back(vec3(p), 1.0f);
}

/// Whether a set is among `names`, or, without names, among those that need none.
inline bool is_asked_for(const std::vector<std::string>& names, const clustered_set& which)
{
    const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return names.empty() ? std::strcmp(which.name, only_by_name) != 0 : has("all") || has(which.name);
}

/// The options of a verb that measures these sets.
inline void add_set_options(CLI::App& verb, std::vector<std::string>& sets, std::vector<uint>& k, uint& photons,
    double& seconds, bool& few_points)
{
    std::set<std::string> names{"all"};
    for (const auto& which : clustered_sets())
        names.insert(which.name);
    verb.add_option("--sets", sets, "with commas; all: uniform10m too, which needs 4 GB")
        ->delimiter(',')
        ->check(CLI::IsMember(names));
    verb.add_option("--k", k, "with commas")->delimiter(',')->check(CLI::Range(1, 999));
    verb.add_option("--photons", photons, "of each set")->check(CLI::Range(1000, 10000000));
    verb.add_option("--seconds", seconds, "that a search takes, about")->check(CLI::PositiveNumber);
    verb.add_flag(
        "--few-points", few_points, "searches at 65,536 points, half of them photons; without: at each photon");
}

/// Searches are made at 65,536 points: by turns at any photon and anywhere in the photons' box.
inline void search_at_few_points(data_set& s)
{
    vec3 low(s.positions.front()), high = low;
    for (const auto& p : s.positions) {
        low = glm::min(low, vec3(p));
        high = glm::max(high, vec3(p));
    }
    random_source u(4);
    const auto photons = static_cast<double>(s.positions.size());
    for (int i = 0; i < 65536; ++i) {
        const float x = u(), y = u(), z = u();
        const vec3 at = i % 2 == 0 ? vec3(s.positions[static_cast<std::size_t>(static_cast<double>(x) * photons)])
                                   : low + (high - low) * vec3(x, y, z);
        s.points.emplace_back(at, 1.0f);
    }
}

} // namespace photongrid::bench
