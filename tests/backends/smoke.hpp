// A small picture on a backend: what clang builds and runs.
#pragma once

#include "../scene/test_scenes.hpp"

#include <photongrid/render/render.hpp>

#include <cstdio>

namespace photongrid::testing {

/// Draws a 16 x 16 picture with both maps; 0 when every photon is accounted for and there is light.
template <backend B>
int smoke(B& b)
{
    auto s = small_cornell();
    s.render.output.width = s.render.output.height = 16;
    s.render.map.photons = 2000;
    for (const auto builder : {map_builder::sort, map_builder::route}) {
        s.render.map.builder = builder;
        const auto [picture, stats] = render(b, s);
        double sum = 0;
        for (const auto& p : picture.pixels)
            sum += static_cast<double>(p.x + p.y + p.z);
        const auto& p = stats.photons;
        std::printf("%s: mean radiance %.4f, %llu paths\n", b.caps().device.c_str(), sum / 768,
            static_cast<unsigned long long>(p.emitted));
        if (p.emitted != p.absorbed + p.escaped + p.cut_off + p.invalid
            || p.diffuse_hits != p.stored + p.direct + p.left_to_caustics + p.dropped || !(sum > 0))
            return 1;
    }
    return 0;
}

} // namespace photongrid::testing
