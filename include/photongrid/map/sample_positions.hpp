// A sample of the photons' positions on the host, from which maps are fitted to all of them.
#pragma once

#include <photongrid/map/gather_vector.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::detail {

/// The finite positions among up to `most` photons at equal intervals of ids.
template <backend B>
std::vector<glm::vec3> sample_positions(B& device, const photons<B>& p, uint most)
{
    const uint n = p.size();
    std::vector<uint> ids;
    for (uint i = 0; i < std::min(n, most); ++i)
        ids.push_back(static_cast<uint>(std::uint64_t{i} * n / std::min(n, most)));
    auto taken = device.template make<glm::vec4>(ids.size());
    device.template run<kernels::gather_vector>(
        ids.size(), {.photons = n}, reads(device.upload(std::span<const uint>(ids)), p.positions), writes(taken));
    std::vector<glm::vec3> positions;
    for (const auto& v : device.download(taken))
        if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))
            positions.emplace_back(v);
    return positions;
}

} // namespace photongrid::detail

#include <photongrid/backend/exact_end.hpp>
