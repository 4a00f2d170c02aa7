// The hits of rays on a scene's meshes, between the passes of the kernels that follow paths.
//
//     write rays -> search -> mesh_surface (-> mesh_color) -> a kernel that includes trace/mesh_hit.glsl
#pragma once

#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/mesh_color.kernel.hpp>
#include <photongrid/trace/mesh_surface.kernel.hpp>
#include <photongrid/trace/ray_search.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// See trace/mixture.glsl.
inline std::size_t colors_per_hit(const scene_layout& layout)
{
    return (layout.features & (has_mixtures | has_clear)) != 0 ? 3 : 1;
}

/// The hits of rays on the meshes of a scene. Without meshes its buffers have one element, which stands where kernels
/// have an INPUT that they do not read.
template <backend B>
struct mesh_hits {
    buffer_of<B, glm::vec4> places, normals, shadings; ///< see trace/mesh_surface.glsl
    buffer_of<B, glm::vec4> colors;                    ///< see trace/mesh_color.glsl

    mesh_hits(B& device, const device_scene<B>& s, std::size_t rays)
        : places(device.template make<glm::vec4>(s.has_meshes() ? rays : 1)),
          normals(device.template make<glm::vec4>(places.size())),
          shadings(device.template make<glm::vec4>(places.size())),
          colors(device.template make<glm::vec4>(s.has_textures() ? colors_per_hit(s.layout) * rays : 1))
    {
    }
};

/// Rays against the meshes of a scene.
template <backend B>
struct mesh_rays {
    buffer_of<B, glm::vec4> origins;    ///< see ray_search
    buffer_of<B, glm::vec4> directions; ///< see ray_search; w is free for kernels

    mesh_rays(B& device, std::size_t rays)
        : origins(device.template make<glm::vec4>(rays)), directions(device.template make<glm::vec4>(rays))
    {
    }

    /// The hits of all rays for kernels, as trace/ray_state.glsl describes them.
    buffer_of<B, glm::uvec4> search(B& device, const device_scene<B>& s, hit_kind kind) const
    {
        ray_search<B> search(device, s.meshes->triangles, origins, directions, {.kind = kind});
        search.advance();
        return search.take_states();
    }
    /// The surfaces at the closest hits, with their colours.
    void find(B& device, const device_scene<B>& s, mesh_hits<B>& hits) const;
    /// The surfaces alone. Returns what search() does.
    buffer_of<B, glm::uvec4> find_surfaces(B& device, const device_scene<B>& s, mesh_hits<B>& hits) const;
};

template <backend B>
void mesh_rays<B>::find(B& device, const device_scene<B>& s, mesh_hits<B>& hits) const
{
    const auto found = find_surfaces(device, s, hits);
    const auto& m = *s.meshes;
    if (s.has_textures())
        device.template run<kernels::mesh_color>({colors_per_hit(s.layout) * origins.size(), 0u, s.layout.features},
            {.count = m.triangles.instance_count()},
            reads(s.records, found, hits.places, hits.normals, m.faces, m.vertices, m.attributes, *s.texels,
                m.triangles.instances),
            writes(hits.colors));
}

template <backend B>
buffer_of<B, glm::uvec4> mesh_rays<B>::find_surfaces(B& device, const device_scene<B>& s, mesh_hits<B>& hits) const
{
    auto found = search(device, s, hit_kind::closest);
    const auto& m = *s.meshes;
    device.template run<kernels::mesh_surface>({origins.size(), 0u, s.layout.features},
        {.count = m.triangles.instance_count()},
        reads(s.records, origins, directions, found, m.faces, m.planes, m.vertices, m.normals, m.triangles.instances),
        writes(hits.places, hits.normals, hits.shadings));
    return found;
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
