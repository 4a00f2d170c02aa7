// Where traced photons land, for comparison with closed forms.
#pragma once

#include "../backends/serial_pictures.hpp"
#include "../map/photon_sets.hpp"
#include "../scene/test_scenes.hpp"

#include <photongrid/reference/reference.hpp>
#include <photongrid/render/render.hpp>

#include <photongrid/io/scene_file.hpp>

#include <flann/flann.hpp>
#include <gtest/gtest.h>
#include <nanoflann.hpp>

#include <cstdio>
#include <functional>
#include <numeric>

namespace photongrid::testing {
namespace {

    using glm::dvec2;
    using glm::vec4;

    /// A photon on the host, in the scene's own coordinates.
    struct landed_photon {
        dvec3 at, direction;
    };

    /// Of equal power, so that they lie as dense as the light.
    std::vector<landed_photon> traced(const scene& s)
    {
        serial_backend b;
        const auto device = upload_scene(b, s);
        auto settings = s.render;
        settings.map.emission = photon_emission::power;
        settings.map.caustic_photons = 0;
        const auto t = trace_photons(b, device, settings);
        const auto positions = b.download(t.photons.positions), directions = b.download(t.photons.directions);
        std::vector<landed_photon> out;
        for (std::size_t i = 0; i < positions.size(); ++i)
            out.push_back({dvec3(positions[i]) + device.layout.center, dvec3(directions[i])});
        return out;
    }

    std::vector<vec4> recentred(const std::vector<dvec3>& points, const dvec3& center)
    {
        std::vector<vec4> out;
        for (const auto& p : points)
            out.emplace_back(glm::vec3(p - center), 1.0f);
        return out;
    }

} // namespace
} // namespace photongrid::testing
