// Direct light at points, without a picture.
#pragma once

#include <photongrid/trace/sky_guide.hpp>

#include <span>
#include <vector>

namespace photongrid::testing {

/// Irradiance of the scene's lights at points with normals. `guided`: with the guide to the sky of its camera, if it
/// has one.
template <class B>
std::vector<glm::vec4> direct_light_at(B& b, const scene& s, const std::vector<dvec3>& points,
    const std::vector<dvec3>& normals, uint samples, bool guided = false)
{
    const auto device = upload_scene(b, s);
    std::vector<glm::vec4> p, n;
    for (std::size_t i = 0; i < points.size(); ++i) {
        p.emplace_back(glm::vec3(points[i] - device.layout.center), 1.0f);
        n.emplace_back(glm::vec3(normals[i]), 0.0f);
    }
    detail::eye_hits<B> hits(b, p.size());
    hits.points = b.upload(std::span<const glm::vec4>(p));
    hits.surfaces = b.upload(std::span<const glm::vec4>(n));
    auto settings = s.render;
    settings.view.light_samples = samples;
    auto irradiance = b.template make<glm::vec4>(p.size());
    const auto table = guided ? learn_sky(b, device, s.camera, 1) : std::vector<glm::vec4>{};
    const auto guide = b.upload(std::span<const glm::vec4>(table));
    detail::direct_light(
        b, device, {settings, 0, launch(p.size())}, hits, irradiance, table.empty() ? nullptr : &guide);
    return b.download(irradiance);
}

} // namespace photongrid::testing
