// Rays against triangles: closest hits, or whether anything is hit.
//
//     build_triangle_tree -> upload;  ray_start -> trace_ray
#pragma once

#include <photongrid/core/backend.hpp>
#include <photongrid/trace/instance_tree.hpp>
#include <photongrid/trace/ray_start.kernel.hpp>
#include <photongrid/trace/ray_state.kernel.hpp>
#include <photongrid/trace/trace_ray.kernel.hpp>

#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    /// Uploads elements, or one if there are none: kernels need a buffer for each INPUT, even if they do not read it.
    template <backend B, class Element>
    buffer_of<B, Element> upload_some(B& device, const std::vector<Element>& elements)
    {
        return upload(device, elements.empty() ? std::vector<Element>(1) : elements);
    }
} // namespace detail

/// The triangles of a mesh on a device, in a tree; or of surfaces that stand in a scene several times.
template <backend B>
struct device_triangles {
    buffer_of<B, glm::uvec4> pairs;     ///< see trace/tree_node.glsl
    buffer_of<B, glm::uvec4> corners;   ///< of the triangles, in the order of the leaves
    buffer_of<B, glm::vec4> planes;     ///< of the triangles, in the same order
    buffer_of<B, glm::uvec4> instances; ///< see trace/instance.glsl; one element if there are none

    uint instance_count() const { return static_cast<uint>(instances.size() / kernels::INSTANCE_RECORDS); }
};

/// Builds the tree of a mesh as build_triangle_tree(m) does, on the device's threads if it has any.
template <backend B>
triangle_tree build_triangle_tree(B&, const mesh& m)
{
    return build_triangle_tree(m);
}

/// Builds a tree of two levels, as build_instance_tree() without a device does, likewise.
template <backend B>
triangle_tree build_instance_tree(B&, std::span<const mesh> surfaces, std::span<const placement> placements)
{
    return build_instance_tree(surfaces, placements);
}

/// Uploads a tree.
/// \throws backend_error if the device has no room.
template <backend B>
device_triangles<B> upload_triangles(B& device, const triangle_tree& tree)
{
    return {upload(device, tree.pairs), upload(device, tree.corners), detail::upload_some(device, tree.planes),
        detail::upload_some(device, tree.instances)};
}

/// Which hit of a ray is sought.
enum class hit_kind {
    closest, ///< of several at one distance, that of the triangle with the least index
    any,     ///< whether there is one: the first that is found
};

static_assert(kernels::NO_TRIANGLE == no_id);

/// The hit of a ray.
struct ray_hit {
    float distance; ///< along the ray, in lengths of its direction; without a hit, its length
    uint triangle;  ///< its index in the mesh, or among the triangles of all instances; `no_id`: no hit

    bool operator==(const ray_hit&) const = default;
};

/// Settings of a ray_search.
struct ray_search_settings {
    hit_kind kind = hit_kind::closest; ///< which hit
    uint steps_per_pass = 1024;        ///< the most pairs of nodes and triangles that a ray visits in a pass
};

/// The search for the hits of rays, which advances step by step.
template <backend B>
class ray_search {
public:
    /// `origins`: xyz, m, up to 10^18; w: how far the ray goes, in lengths of its direction, inclusive; infinity if it
    /// has no end. `directions`: xyz, from 10^-18 to 10^18. Rays out of these ranges hit nothing. All must stay valid
    /// while it is used.
    /// \throws std::invalid_argument if there are not as many directions as origins, or for 0 steps per pass.
    ray_search(B& device, const device_triangles<B>& triangles, const buffer_of<B, glm::vec4>& origins,
        const buffer_of<B, glm::vec4>& directions, const ray_search_settings& settings = {});

    /// Runs at most `passes` more passes over the rays that are not done.
    progress advance(uint passes = all_passes);
    /// True when every ray's hit is known.
    bool finished() const { return finished_; }
    /// The hits, once finished.
    std::vector<ray_hit> hits() const;
    /// The hits for kernels, as trace/ray_state.glsl describes them, once finished. The search ends with that.
    buffer_of<B, glm::uvec4> take_states() { return std::move(states_); }

private:
    template <class K>
    uint switches() const
    {
        return (settings_.kind == hit_kind::any ? K::ANY_HIT_switch : 0u)
            | (triangles_->instance_count() > 0 ? K::INSTANCES_switch : 0u);
    }

    B* device_;
    const device_triangles<B>* triangles_;
    const buffer_of<B, glm::vec4>* origins_;
    const buffer_of<B, glm::vec4>* directions_;
    ray_search_settings settings_;
    buffer_of<B, glm::uvec4> states_; ///< see trace/ray_state.glsl
    std::size_t passes_ = 0;          ///< run so far; overrides go on from there
    bool finished_ = false;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
ray_search<B>::ray_search(B& device, const device_triangles<B>& triangles, const buffer_of<B, glm::vec4>& origins,
    const buffer_of<B, glm::vec4>& directions, const ray_search_settings& settings)
    : device_(&device), triangles_(&triangles), origins_(&origins), directions_(&directions), settings_(settings)
{
    if (origins.size() != directions.size())
        throw std::invalid_argument("ray_search: directions: " + std::to_string(directions.size()) + " of them, and "
            + std::to_string(origins.size()) + " origins; each ray needs both");
    if (settings.steps_per_pass < 1)
        throw std::invalid_argument("ray_search: steps_per_pass: 0; a pass must make progress, so set at least 1");
    states_ = device.template make<glm::uvec4>(origins.size());
    device.template run<kernels::ray_start>(origins.size(), {}, reads(origins, directions), writes(states_));
}

template <backend B>
progress ray_search<B>::advance(uint passes)
{
    progress p = device_->template run_until_done<kernels::trace_ray>(
        {states_.size(), 0u, this->template switches<kernels::trace_ray>()},
        {.steps = settings_.steps_per_pass, .count = triangles_->instance_count()},
        reads(
            *origins_, *directions_, triangles_->pairs, triangles_->corners, triangles_->instances, triangles_->planes),
        writes(states_), passes);
    passes_ += p.passes;
    finished_ = p.finished;
    return p;
}

template <backend B>
std::vector<ray_hit> ray_search<B>::hits() const
{
    std::vector<ray_hit> hits;
    for (const auto& s : device_->download(states_))
        hits.push_back({kernels::distance_of_hit(s), kernels::triangle_of(s)});
    return hits;
}

/// The hit of each ray. See ray_search for the arguments.
/// \throws std::invalid_argument as ray_search does; backend_error if the device has no room.
/// \snippet snippets.cpp trace_rays
template <backend B>
std::vector<ray_hit> trace_rays(B& device, const device_triangles<B>& triangles, const buffer_of<B, glm::vec4>& origins,
    const buffer_of<B, glm::vec4>& directions, const ray_search_settings& settings = {})
{
    ray_search<B> search(device, triangles, origins, directions, settings);
    search.advance();
    return search.hits();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
