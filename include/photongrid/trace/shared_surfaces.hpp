// Which meshes of a scene share one stored surface.
#pragma once

#include <photongrid/scene/scene.hpp>
#include <photongrid/trace/instance_tree.hpp>

#include <cstddef>
#include <map>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The surfaces of a scene that stand in several places and are stored once. Small ones are not, since a tree of one
/// level is searched faster; nor are meshes that their placement stretches, whose boxes would need large margins.
class shared_surfaces {
public:
    explicit shared_surfaces(const scene& s)
    {
        for (const auto& m : s.meshes)
            if (can_share(m))
                ++places_[m.surface.get()];
        std::erase_if(places_, [](const auto& surface) { return surface.second < 2; });
    }

    bool empty() const { return places_.empty(); }
    /// Whether this mesh of the scene is a place of one of them.
    bool holds(const placed_mesh& m) const { return places_.contains(m.surface.get()) && can_share(m); }

private:
    static bool can_share(const placed_mesh& m)
    {
        return m.surface->triangles.size() >= 1024 && stretch_of(m.linear) <= 4;
    }

    std::map<const mesh*, std::size_t> places_;
};

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
