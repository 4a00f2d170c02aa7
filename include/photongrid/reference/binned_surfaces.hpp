// The surfaces of a scene, divided into bins in which light paths are counted.
#pragma once

#include <photongrid/reference/intersect.hpp>
#include <photongrid/reference/settings.hpp>
#include <photongrid/reference/shapes.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// Whether a predicate holds for a part of the material of any surface.
template <class Predicate>
bool any_surface(const scene& s, const Predicate& holds)
{
    bool any = false;
    const auto look = [&](const auto& list, auto) {
        for (const auto& x : list)
            for (const auto* part : parts_of(s.materials, s.materials[x.material]))
                any = any || holds(*part);
    };
    for_each_shape(s, look);
    look(s.meshes, nullptr);
    return any;
}

/// The bins of those surfaces that a predicate of their materials chooses. Each has a number for either side.
class binned_surfaces {
public:
    /// No bins.
    binned_surfaces() = default;
    /// \throws std::invalid_argument for too many bins.
    template <class Wanted>
    binned_surfaces(const scene& s, const geometry& shapes, const reference_settings& settings, const Wanted& is_wanted)
    {
        double area = 0;
        each_shape(s, shapes,
            [&](const auto& x, std::uint32_t, const material& m) { area += is_wanted(m) ? surface_area(x) : 0; });
        if (!(area > 0))
            return;
        // Larger bins have less noise and more blur. The best edge is proportional to the number of paths to the power
        // -1/4.
        edge_ = settings.bin > 0 ? settings.bin
                                 : std::sqrt(area) / (8 * std::pow(static_cast<double>(settings.paths), 0.25));
        each_shape(s, shapes, [&](const auto& x, std::uint32_t number, const material& m) {
            surfaces_.resize(std::max<std::size_t>(surfaces_.size(), number + std::size_t{1}));
            if (!is_wanted(m) || !(surface_area(x) > 0))
                return;
            auto& surface = surfaces_[number];
            surface.bins.emplace(bins_of(x, edge_));
            surface.first = size_;
            size_ += 2 * std::visit([](const auto& b) { return b.size(); }, *surface.bins);
            require_few_bins(size_, edge_);
        });
    }

    /// The number of bins, on both sides.
    std::uint32_t size() const { return size_; }
    double edge() const { return edge_; } ///< m

    /// Whether the surface hit has bins.
    bool has(const hit& h) const { return h.shape < surfaces_.size() && surfaces_[h.shape].bins; }
    /// The bin at `h` on the side that a ray of direction d hits.
    std::uint32_t at(const hit& h, const dvec3& d) const
    {
        const auto& surface = surfaces_[h.shape];
        const std::uint32_t in_shape = std::visit([&](const auto& b) { return b.at(h.position); }, *surface.bins);
        return surface.first + 2 * in_shape + (glm::dot(h.normal, d) > 0 ? 1 : 0);
    }
    /// The areas of all bins, m^2.
    std::vector<double> areas() const
    {
        std::vector<double> all(size_);
        for (const auto& surface : surfaces_)
            if (surface.bins)
                std::visit(
                    [&](const auto& b) {
                        for (std::uint32_t i = 0; i < 2 * b.size(); ++i)
                            all[surface.first + i] = b.area(i / 2);
                    },
                    *surface.bins);
        return all;
    }

private:
    /// Calls visit(shape, its number in `shapes`, its material).
    template <class Visit>
    static void each_shape(const scene& s, const geometry& shapes, Visit visit)
    {
        std::uint32_t number = 0;
        for_each_shape(s, [&](const auto& list, auto) {
            for (const auto& x : list)
                visit(x, number++, s.materials[x.material]);
        });
        number = shapes.first_triangle();
        for (const auto& l : s.mesh_lights)
            number += static_cast<std::uint32_t>(l.surface.surface->triangles.size());
        for (const auto& m : s.meshes)
            for (std::size_t t = 0; t < m.surface->triangles.size(); ++t) {
                const auto c = corners_of(m, t);
                visit(polygon{{c[0], c[1], c[2]}, m.material}, number++, s.materials[m.material]);
            }
    }

    struct binned_surface {
        std::optional<surface_bins> bins;
        std::uint32_t first = 0; ///< of its bins; each has two, for the two sides
    };
    std::vector<binned_surface> surfaces_; ///< by shape
    std::uint32_t size_ = 0;
    double edge_ = 0;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
