// The cpu backend's search, in SIMD code, with the points in an order that keeps neighbours together.
#pragma once

#include <photongrid/backends/cpu/overrides/in_order.hpp>
#include <photongrid/backends/cpu/overrides/search.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace cpu {
    template <element T>
    buffer<T> copy(cpu_backend& device, const buffer<T>& from)
    {
        return device.upload(device.elements(from));
    }
} // namespace cpu

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    knn_search<cpu_backend>::knn_search(cpu_backend& device, const map_buffers<cpu_backend>& map, const vectors& points,
        const vectors* normals, const knn_settings& s)
    : in_(device, map, points, normals, s)
{
    const std::size_t n = points.size();
    e_ = {device.make<glm::vec4>(n), device.make<glm::uvec2>(n), device.make<glm::vec4>(s.errors ? n : 0)};
    const auto unfinished = [&](auto& buffer, const auto& value) {
        const auto elements = device.elements_to_write(buffer);
        std::fill(elements.begin(), elements.end(), value);
    };
    unfinished(e_.irradiance, glm::vec4(0, 0, 0, in_.max_radius2()));
    unfinished(e_.used, glm::uvec2(0));
    unfinished(e_.standard_error, glm::vec4(0));
    for (auto* buffer : e_.biases.all()) {
        *buffer = device.make<glm::vec4>(s.biases ? n : 0);
        unfinished(*buffer, glm::vec4(0));
    }
    const cpu_backend::stopwatch watch;
    order_ = cpu::order_for_search(device, map, points);
    device.count_passes("knn_search", 0, watch);
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    progress
    knn_search<cpu_backend>::advance(uint passes)
{
    auto& device = *in_.device;
    const cpu_backend::stopwatch watch;
    const std::size_t n = in_.points->size(), begin = done_;
    const std::size_t per_pass = cpu::search_block_size * std::max(1u, in_.s.visits_per_pass / 128u);
    auto part = cpu::next_passes(n, begin, per_pass, passes);
    done_ = part.end;
    if (done_ > begin) {
        auto job = cpu::make_search_job(in_, order_);
        job.irradiance = device.elements_to_write(e_.irradiance).data();
        job.used = device.elements_to_write(e_.used).data();
        if (job.errors)
            job.standard_error = device.elements_to_write(e_.standard_error).data();
        if (in_.s.biases) {
            auto& b = e_.biases;
            job.biases = {device.elements_to_write(b.bias).data(), device.elements_to_write(b.tilt).data(),
                device.elements_to_write(b.jump).data(), device.elements_to_write(b.constant).data()};
        }
        device.threads().for_blocks(done_ - begin, cpu::search_block_size,
            [&](std::size_t first, std::size_t past) { cpu::search_block(job, begin + first, begin + past); });
    }
    device.count_passes("knn_search", part.made.passes, watch);
    return part.made;
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    knn_estimates<cpu_backend>
    knn_search<cpu_backend>::estimates() &
{
    auto& device = *in_.device;
    const auto& b = e_.biases;
    return {cpu::copy(device, e_.irradiance), cpu::copy(device, e_.used), cpu::copy(device, e_.standard_error),
        {cpu::copy(device, b.bias), cpu::copy(device, b.tilt), cpu::copy(device, b.jump),
            cpu::copy(device, b.constant)}};
}

#if !defined(PHOTONGRID_CPU_COMPILED)
inline
#endif
    knn_estimates<cpu_backend>
    knn_search<cpu_backend>::estimates() &&
{
    return std::move(e_);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
