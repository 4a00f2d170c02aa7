// The records of materials and of their textures, for kernels (trace/materials.glsl, mixture.glsl, mesh_color.glsl).
#pragma once

#include <photongrid/scene/record_writer.hpp>
#include <photongrid/trace/media.hpp>
#include <photongrid/trace/scene_layout.kernel.hpp>

#include <cstddef>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// Appends the records of materials. Returns their textures, which the records number from 1 on.
inline std::vector<const texture_use*> put_materials(
    record_writer& w, const std::vector<material>& materials, const std::vector<medium>& media)
{
    std::vector<const texture_use*> textures;
    const auto number_of = [&](const texture_use& t) {
        if (t.map)
            textures.push_back(&t);
        return static_cast<double>(t.map ? textures.size() : 0);
    };
    std::vector<double> media_of_materials(materials.size(), 0); // see crossing() of trace/media.glsl
    for (std::size_t n = 0; n < media.size(); ++n)
        media_of_materials[media[n].material] = (media[n].is_interface ? -1.0 : 1.0) * static_cast<double>(n + 1);
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const auto& m = materials[i];
        w.put(m.reflectance, static_cast<uint>(entry_of(m.kind).surface));
        w.put(dvec3(m.index_of_refraction, number_of(m.texture), alpha_of(m)), 0); // w: see write_coats, write_rebounds
        w.put(dvec3(m.opacity, m.share, m.parts[0]), m.parts[1]);
        const double of_opacity = number_of(m.opacity_texture), of_roughness = number_of(m.roughness_texture),
                     of_share = number_of(m.share_texture);
        w.put(dvec3(of_opacity, of_roughness, of_share), media_of_materials[i]);
    }
    return textures;
}

/// Appends the records of textures. Textures may share the texels of a map. Returns the maps in the order of their
/// texels.
/// \throws std::invalid_argument for more texels than max_texels.
inline std::vector<std::shared_ptr<const texture>> put_textures(
    record_writer& w, const std::vector<const texture_use*>& textures)
{
    std::vector<std::shared_ptr<const texture>> maps;
    std::map<const texture*, std::size_t> firsts;
    std::size_t texels = 0;
    for (const auto* use : textures) {
        const auto [found, is_new] = firsts.emplace(use->map.get(), texels);
        if (is_new) {
            maps.push_back(use->map);
            texels += use->map->texels.size();
        }
        require(texels <= max_texels, "materials: their textures have more than 2^28 texels together");
        w.put(dvec3(halves_of(found->second), use->map->width), use->map->height);
        w.put(dvec3(use->scale, use->offset.x), use->offset.y);
        w.put(dvec3(use->wrap == texture_wrap::repeat ? 1 : 0, static_cast<double>(use->channel), 0), 0);
    }
    return maps;
}

/// The texels of maps, one map after the other.
inline std::vector<glm::uvec2> texels_of(const std::vector<std::shared_ptr<const texture>>& maps)
{
    std::vector<glm::uvec2> texels;
    for (const auto& map : maps)
        for (const auto& t : map->texels)
            texels.emplace_back(uint{t.x} | uint{t.y} << 16, uint{t.z} | uint{t.w} << 16);
    return texels;
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
