// The hits of rays on a scene's meshes, between the passes of the kernels that follow paths.
//
//     write rays -> search -> a kernel that includes trace/mesh_hit.glsl
#pragma once

#include <photongrid/trace/device_scene.hpp>
#include <photongrid/trace/ray_search.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::detail {

/// Searches for the hits of up to `rays` rays on the meshes of a scene. Without meshes its buffers have one element,
/// which stands where kernels have an INPUT that they do not read.
template <backend B>
class mesh_search {
public:
    /// `s` must outlive it.
    mesh_search(B& device, const device_scene<B>& s, std::size_t rays)
        : device_(&device), scene_(&s), rays_(s.has_meshes() ? rays : 1),
          origins(device.template make<glm::vec4>(rays_)), directions(device.template make<glm::vec4>(rays_)),
          found_(device.template make<glm::uvec4>(s.has_meshes() ? 0 : 1))
    {
    }
    mesh_search(B&, const device_scene<B>&&, std::size_t) = delete; // it keeps a reference

    /// Searches for the hits of the rays that are in `origins` and `directions`.
    void search(hit_kind kind)
    {
        ray_search<B> search(*device_, scene_->triangles, origins, directions, {.kind = kind});
        search.advance();
        found_ = search.take_states();
    }

    /// Of each ray, as trace/ray_state.glsl describes it.
    const buffer_of<B, glm::uvec4>& found() const { return found_; }

private:
    B* device_;
    const device_scene<B>* scene_;
    std::size_t rays_;

public:
    buffer_of<B, glm::vec4> origins;    ///< see ray_search
    buffer_of<B, glm::vec4> directions; ///< see ray_search; w is free for kernels

private:
    buffer_of<B, glm::uvec4> found_;
};

} // namespace photongrid::detail

#include <photongrid/backend/exact_end.hpp>
