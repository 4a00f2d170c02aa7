// Fits a grid to photons, so that the caller need not choose one.
#pragma once

#include <photongrid/map/sample_positions.hpp>

#include <algorithm>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// The number of cubes with this edge, m, that contain at least one of the points.
    inline std::size_t occupied_cubes(const std::vector<glm::vec3>& points, glm::vec3 low, double edge)
    {
        std::vector<std::uint64_t> cubes;
        cubes.reserve(points.size());
        for (const auto& p : points) {
            std::uint64_t cube = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double u = static_cast<double>(p[axis] - low[axis]) / edge;
                cube = cube << 21 | static_cast<std::uint64_t>(std::clamp(u, 0.0, 2097151.0));
            }
            cubes.push_back(cube);
        }
        std::sort(cubes.begin(), cubes.end());
        return static_cast<std::size_t>(std::unique(cubes.begin(), cubes.end()) - cubes.begin());
    }

    /// fitting_grid() of `photons` photons, of which `sample` is a part.
    inline grid grid_fitting(std::vector<glm::vec3> sample, uint photons, uint k, float cells_per_radius)
    {
        if (sample.empty())
            return make_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(1));
        glm::vec3 low, high;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t stray = sample.size() / 500;
            const auto nth = [&](std::size_t n) {
                const auto at = sample.begin() + static_cast<std::ptrdiff_t>(n);
                std::nth_element(
                    sample.begin(), at, sample.end(), [&](const auto& a, const auto& c) { return a[axis] < c[axis]; });
                return (*at)[axis];
            };
            // Searches end at 10^19 m (max_radius2); 10^18 leaves room for the square of the extent.
            low[axis] = std::clamp(nth(stray), -1e18f, 1e18f);
            high[axis] = std::clamp(nth(sample.size() - 1 - stray), -1e18f, 1e18f);
        }
        const double extent = static_cast<double>(std::max({high.x - low.x, high.y - low.y, high.z - low.z}));
        if (!(extent > 0))
            return make_grid(low, high, glm::uvec3(1));

        // The smallest cubes that still hold four sample photons on average, and the dimension at that scale.
        const auto size = static_cast<double>(sample.size());
        double edge = extent, cubes = 1, dimension = 2;
        for (int level = 1; level < 20; ++level) {
            const auto finer = static_cast<double>(occupied_cubes(sample, low, edge / 2));
            if (finer * 4 > size && level > 1)
                break;
            dimension = std::clamp(std::log2(finer / cubes), 1.0, 3.0);
            cubes = finer;
            edge /= 2;
        }
        // A cube of edge h holds N / cubes (h / edge)^D photons; a ball of radius r holds 0.785 of what a cube of edge
        // 2 r holds (exact for D = 2). Solve for the radius that holds k photons.
        const double in_ball = 0.785 * static_cast<double>(photons) / cubes;
        double radius = 0.5 * edge * std::pow(static_cast<double>(std::max(k, 1u)) / in_ball, 1 / dimension);
        radius /= static_cast<double>(cells_per_radius);
        const double most = std::max(1.25 * static_cast<double>(photons), 64.0);
        for (;; radius *= 1.05) {
            glm::dvec3 cells;
            for (int axis = 0; axis < 3; ++axis)
                cells[axis] = std::max(1.0,
                    std::ceil(
                        static_cast<double>(high[axis] - low[axis]) / (axis == 0 ? 0.5 * radius : radius) - 1e-6));
            if (cells.x * cells.y * cells.z <= most)
                return make_grid(low, high, glm::uvec3(cells));
        }
    }

    inline constexpr uint grid_sample = 16384; // positions to which a grid is fitted
} // namespace detail

/// A grid for estimates from k of these photons. A typical distance of the k-th nearest is `cells_per_radius` cells
/// (see capabilities), and twice as many along x, where searches end rows at the radius; there are at most 5/4 cells
/// per photon. The grid's box leaves out one photon in 500 at either end of each axis, so that a few stray photons do
/// not enlarge all cells; photons outside belong to the border cells.
///
/// The photons' dimension D is measured on a sample of 16,384 by box counting: the number of occupied cubes with edge h
/// is proportional to h^-D, with D = 2 for photons on surfaces (Mandelbrot 1982). The grid depends on the photons
/// alone, not on the backend. Reads the sample back.
/// \throws backend_error if the device fails.
/// \snippet snippets.cpp fitting_grid
template <backend B>
grid fitting_grid(B& device, const photons<B>& p, uint k, float cells_per_radius = 1)
{
    return detail::grid_fitting(
        detail::sample_positions(device, p, detail::grid_sample), p.size(), k, cells_per_radius);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
