// A scene on a device: its records, its meshes with their tree, and its environment.
#pragma once

#include <photongrid/trace/ray_search.hpp>
#include <photongrid/trace/scene_records.hpp>

#include <algorithm>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A scene on a device.
template <backend B>
struct device_scene {
    scene_layout layout;             ///< with the records on the host, but without meshes and environment
    buffer_of<B, glm::vec4> records; ///< as trace/scene_layout.glsl describes them
    /// \name Of meshes, as trace/mesh_surface.glsl describes them; an element each if there is nothing
    /// @{
    device_triangles<B> triangles; ///< the tree
    buffer_of<B, glm::uvec4> faces;
    buffer_of<B, glm::vec4> planes;
    buffer_of<B, glm::vec4> vertices;
    buffer_of<B, glm::vec4> normals;
    buffer_of<B, uint> shares;
    buffer_of<B, glm::vec4> attributes;
    buffer_of<B, glm::uvec2> texels;
    /// @}
    /// \name Of the environment, as trace/environment.glsl describes it; an element each if there is none
    /// @{
    buffer_of<B, glm::vec4> environment;
    buffer_of<B, uint> environment_shares;
    /// @}

    bool has_meshes() const { return (layout.features & photongrid::has_meshes) != 0; }
    bool has_textures() const { return (layout.features & photongrid::has_textures) != 0; }
};

namespace detail {
    template <backend B>
    void upload_meshes(B& device, mesh_layout m, device_scene<B>& to)
    {
        std::vector<glm::vec4> vertices;
        for (const auto& p : m.triangles.positions)
            vertices.emplace_back(p, 0.0f);
        for (const auto& surface : m.surfaces)
            for (const auto& p : surface.positions)
                vertices.emplace_back(p, 0.0f);
        if (m.placements.empty()) {
            to.triangles = upload_triangles(device, build_triangle_tree(device, m.triangles));
        } else {
            auto surfaces = std::move(m.surfaces);
            if (m.placements.front().is_in_place)
                surfaces.insert(surfaces.begin(), std::move(m.triangles));
            else
                for (auto& p : m.placements) // there are no others
                    --p.surface;
            to.triangles = upload_triangles(device, build_instance_tree(device, surfaces, m.placements));
        }
        to.faces = upload_some(device, m.faces);
        to.planes = upload_some(device, m.planes);
        to.vertices = upload_some(device, vertices);
        to.normals = upload_some(device, m.normals);
        to.shares = upload_some(device, m.shares);
        to.attributes = upload_some(device, m.attributes);
        to.texels = upload_some(device, m.texels);
    }

    template <backend B>
    void upload_environment(B& device, environment_layout e, device_scene<B>& to)
    {
        to.environment = upload_some(device, e.texels);
        to.environment_shares = upload_some(device, e.shares);
    }

    /// The INPUTs of emit_photon. `guide`: the boxes of an emission guide, if there is one.
    template <backend B>
    auto inputs_of_emission(const device_scene<B>& s, const buffer_of<B, glm::vec4>* guide = nullptr)
    {
        return reads(s.records, s.faces, s.planes, s.vertices, s.shares, s.environment, s.environment_shares,
            guide != nullptr ? *guide : s.records);
    }

    /// A bound on the loop iterations of the least that a pass takes: a shadow ray to each light, or of many lights to
    /// one, which is chosen by a walk down their tree and by looking twice at each light that is not in it
    /// (trace/chosen_light.glsl).
    inline std::uint64_t steps_of_shadow_rays(const scene_layout& layout)
    {
        const std::uint64_t lights = layout.table(kernels::LIGHT_TABLE).count;
        if (lights <= most_lights_sampled_each)
            return layout.steps_per_ray * lights;
        constexpr std::uint64_t of_searches = 128; // down the tree, and for a part of a mesh light or of an environment
        return layout.steps_per_ray + 2 * (lights - static_cast<uint>(layout.records[kernels::LIGHT_TREE].w))
            + of_searches;
    }

    /// \throws std::invalid_argument if the device would end loops over all shapes too early, and lose hits.
    inline void check_loops(const scene_layout& layout, const capabilities& caps)
    {
        const std::uint64_t steps = steps_of_shadow_rays(layout);
        if (caps.loop_limit > 0 && steps > caps.loop_limit)
            throw std::invalid_argument("scene: " + caps.backend + ": tracing takes up to " + std::to_string(steps)
                + " steps (shapes and their edges, times lights if these are few), and this driver silently ends loops "
                  "after "
                + std::to_string(caps.loop_limit) + "; use a backend without a limit, or fewer shapes or lights");
    }
} // namespace detail

/// Lays a scene out and uploads it.
/// \throws std::invalid_argument as lay_out does, or for more shapes than the device can loop over
///         (capabilities::loop_limit); backend_error if the device has no room.
/// \snippet snippets.cpp upload_scene
template <backend B>
device_scene<B> upload_scene(B& device, const scene& s)
{
    device_scene<B> d;
    d.layout = lay_out(s);
    detail::check_loops(d.layout, device.caps());
    d.records = device.upload(std::span<const glm::vec4>(d.layout.records));
    detail::upload_meshes(device, std::exchange(d.layout.meshes, {}), d);
    detail::upload_environment(device, std::exchange(d.layout.environment, {}), d);
    return d;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
