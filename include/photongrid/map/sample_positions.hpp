// A sample of the photons' positions on the host, from which maps are fitted to all of them.
#pragma once

#include <photongrid/core/random.kernel.hpp>
#include <photongrid/map/gather_vector.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The finite positions among up to `most` photons: one of each of as many equal ranges of ids, at random. Photons at
/// equal intervals would miss every other one where two kinds of photons alternate.
template <backend B>
std::vector<glm::vec3> sample_positions(B& device, const photons<B>& p, uint most)
{
    const uint n = p.size();
    const uint size = std::min(n, most);
    const auto begin_of = [&](uint i) { return static_cast<uint>(std::uint64_t{i} * n / size); };
    std::vector<uint> ids;
    for (uint i = 0; i < size; ++i)
        ids.push_back(begin_of(i) + kernels::scrambled(i) % (begin_of(i + 1) - begin_of(i)));
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

#include <photongrid/core/exact_end.hpp>
