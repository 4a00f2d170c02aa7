// A scene on a device: its records, its meshes with their tree, and its environment.
#pragma once

#include <photongrid/trace/ray_search.hpp>
#include <photongrid/trace/scene_records.hpp>

#include <algorithm>
#include <memory>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The triangles of a scene's meshes on a device, as trace/mesh_surface.glsl describes them; an element each if there
/// are none.
template <backend B>
struct device_meshes {
    device_triangles<B> triangles; ///< the tree
    buffer_of<B, glm::uvec4> faces;
    buffer_of<B, glm::vec4> planes;
    buffer_of<B, glm::vec4> vertices;
    buffer_of<B, glm::vec4> normals;
    buffer_of<B, uint> shares;
    buffer_of<B, glm::vec4> attributes;
};

/// The environment of a scene on a device, as trace/environment.glsl describes it; an element each if there is none.
template <backend B>
struct device_environment {
    buffer_of<B, glm::vec4> texels;
    buffer_of<B, uint> shares;
};

/// A scene on a device. Scenes that differ in little share their large parts.
template <backend B>
struct device_scene {
    scene_layout layout;             ///< with the records on the host, but without meshes and environment
    buffer_of<B, glm::vec4> records; ///< as trace/scene_layout.glsl describes them
    std::shared_ptr<const device_meshes<B>> meshes;
    std::shared_ptr<const buffer_of<B, glm::uvec2>> texels; ///< of textures; one element if there are none
    std::shared_ptr<const device_environment<B>> environment;

    bool has_meshes() const { return (layout.features & photongrid::has_meshes) != 0; }
    bool has_textures() const { return (layout.features & photongrid::has_textures) != 0; }
};

namespace detail {
    inline std::vector<glm::vec4> vertices_of(const mesh_layout& m)
    {
        std::vector<glm::vec4> vertices;
        for (const auto& p : m.triangles.positions)
            vertices.emplace_back(p, 0.0f);
        for (const auto& surface : m.surfaces)
            for (const auto& p : surface.positions)
                vertices.emplace_back(p, 0.0f);
        return vertices;
    }

    /// The tree of a layout's triangles, which it takes.
    template <backend B>
    triangle_tree build_tree(B& device, mesh_layout& m)
    {
        auto triangles = std::exchange(m.triangles, {});
        if (m.placements.empty())
            return build_triangle_tree(device, triangles);
        auto surfaces = std::exchange(m.surfaces, {});
        if (m.placements.front().is_in_place)
            surfaces.insert(surfaces.begin(), std::move(triangles));
        else
            for (auto& p : m.placements) // there are no others
                --p.surface;
        return build_instance_tree(device, surfaces, m.placements);
    }

    /// The INPUTs of emit_photon. `guide`: the boxes of an emission guide, if there is one.
    template <backend B>
    auto inputs_of_emission(const device_scene<B>& s, const buffer_of<B, glm::vec4>* guide = nullptr)
    {
        const auto& m = *s.meshes;
        return reads(s.records, m.faces, m.planes, m.vertices, m.shares, s.environment->texels, s.environment->shares,
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

/// Lays a scene out and uploads it, in steps between which it can be interrupted.
template <backend B>
class scene_upload {
public:
    /// It does nothing yet. `before`: another scene on the device, with which this one shares the parts that are the
    /// same; null: none. `s` must outlive the first step, `device` and `before` the last.
    scene_upload(B& device, const scene& s, const device_scene<B>* before = nullptr)
        : device_(device), scene_(s), before_(before)
    {
    }
    scene_upload(B&, const scene&&, const device_scene<B>* = nullptr) = delete; // it keeps a reference

    /// Takes the next step; returns whether it was the last: the layout, the tree of the triangles, the upload.
    /// \throws what upload_scene throws.
    bool advance()
    {
        switch (taken_++) {
        case 0: lay_out(); break;
        case 1: build_tree(); break;
        case 2: upload(); break;
        default: break;
        }
        return finished();
    }
    bool finished() const { return taken_ >= steps; }
    double fraction() const { return static_cast<double>(taken_) / steps; }

    /// The scene, once it has finished.
    device_scene<B> take() { return std::move(made_); }

private:
    static constexpr uint steps = 3;

    void lay_out()
    {
        made_.layout = photongrid::lay_out(scene_, before_ != nullptr ? &before_->layout.sources : nullptr);
        detail::check_loops(made_.layout, device_.caps());
    }
    void build_tree()
    {
        if (made_.layout.shares_meshes)
            return;
        vertices_ = detail::vertices_of(made_.layout.meshes);
        tree_ = detail::build_tree(device_, made_.layout.meshes);
    }
    void upload()
    {
        const auto meshes = std::exchange(made_.layout.meshes, {});
        const auto environment = std::exchange(made_.layout.environment, {});
        const auto& is = made_.layout;
        made_.records = device_.upload(std::span<const glm::vec4>(is.records));
        made_.meshes = is.shares_meshes
            ? before_->meshes
            : std::make_shared<const device_meshes<B>>(device_meshes<B>{upload_triangles(device_, tree_),
                detail::upload_some(device_, meshes.faces), detail::upload_some(device_, meshes.planes),
                detail::upload_some(device_, vertices_), detail::upload_some(device_, meshes.normals),
                detail::upload_some(device_, meshes.shares), detail::upload_some(device_, meshes.attributes)});
        made_.texels = is.shares_texels
            ? before_->texels
            : std::make_shared<const buffer_of<B, glm::uvec2>>(detail::upload_some(device_, meshes.texels));
        made_.environment = is.shares_environment
            ? before_->environment
            : std::make_shared<const device_environment<B>>(device_environment<B>{
                detail::upload_some(device_, environment.texels), detail::upload_some(device_, environment.shares)});
        tree_ = {};
        vertices_ = {};
    }

    B& device_;
    const scene& scene_;
    const device_scene<B>* before_;
    device_scene<B> made_;
    triangle_tree tree_;
    std::vector<glm::vec4> vertices_;
    uint taken_ = 0;
};

/// Lays a scene out and uploads it.
/// \throws std::invalid_argument as lay_out does, or for more shapes than the device can loop over
///         (capabilities::loop_limit); backend_error if the device has no room.
/// \snippet snippets.cpp upload_scene
template <backend B>
device_scene<B> upload_scene(B& device, const scene& s)
{
    scene_upload<B> upload(device, s);
    while (!upload.advance())
        continue;
    return upload.take();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
