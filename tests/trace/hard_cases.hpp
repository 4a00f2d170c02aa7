// Hard cases of ray tracing (docs/reference/hard_cases.md), on any backend: the fixture.
#pragma once

#include "../render/pictures.hpp"
#include "probe_rays.hpp"
#include <photongrid/io/scene_file.hpp>

namespace photongrid::testing {

template <class Tag>
class hard_cases : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    /// Rays against a scene, on the device; where arithmetic is exact, every bit must be serial's.
    ray_hits trace(const scene& s, const rays& r)
    {
        auto mine = trace_rays(this->b(), s, r);
        if (exact()) {
            serial_backend serial;
            const auto theirs = trace_rays(serial, s, r);
            EXPECT_EQ(count_different_bits(mine.places, theirs.places), 0u) << "of " << r.size();
            EXPECT_EQ(count_different_bits(mine.facings, theirs.facings), 0u) << "of " << r.size();
            EXPECT_EQ(count_different_bits(mine.starts, theirs.starts), 0u) << "of " << r.size();
        }
        return mine;
    }

    bool exact() { return this->b().caps().exact_division && this->b().caps().exact_sqrt; }

    /// Irradiance of the scene's lights at points (recentred) with normals.
    std::vector<glm::vec4> direct_light_at(
        const scene& s, const std::vector<dvec3>& points, const std::vector<dvec3>& normals, uint samples)
    {
        auto& b = this->b();
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
        detail::direct_light(b, device, hits, settings, 0, p.size(), irradiance);
        return b.download(irradiance);
    }
};
TYPED_TEST_SUITE_P(hard_cases);

} // namespace photongrid::testing
