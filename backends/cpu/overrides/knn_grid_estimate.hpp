// The cpu backend's search in vectors, points in an order in which neighbours follow each other.
#pragma once

#include <photongrid/backends/cpu/overrides/search.hpp>
#include <photongrid/knn_grid_estimate.hpp>

namespace photongrid {

/// Finds the same photons as the kernels do; sums differ from theirs by 10^-6 at most, since they are added up in
/// another order. A pass searches for some points whole, and advance() counts those.
template <>
class knn_search<cpu_backend> {
public:
    using vectors = cpu_backend::buffer<glm::vec4>;

    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const knn_settings& s)
        : knn_search(b, map, points, nullptr, s)
    {
    }
    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const vectors& normals,
        const knn_settings& s)
        : knn_search(b, map, points, &normals, s)
    {
    }

    /// A point's estimate is made at once: there is none of it before.
    static constexpr bool shows_running_estimate(const knn_settings&) { return false; }

    progress advance(uint passes = nowhere)
    {
        auto& b = *in_.b;
        const cpu_backend::stopwatch watch;
        const std::size_t n = in_.points->size(), begin = done_;
        const std::size_t a_pass = cpu::search_block_size * std::max(1u, in_.s.visits_per_pass / 128u);
        const std::size_t left = (n - begin + a_pass - 1) / a_pass;
        const auto now = static_cast<uint>(std::min<std::size_t>(passes, left));
        done_ = std::min(n, begin + now * a_pass);
        if (done_ > begin) {
            auto job = cpu::make_search_job(in_, order_);
            job.irradiance = b.rows_to_write(e_.irradiance).data();
            job.used = b.rows_to_write(e_.used).data();
            if (job.errors)
                job.standard_error = b.rows_to_write(e_.standard_error).data();
            b.threads().for_blocks(done_ - begin, cpu::search_block_size,
                [&](std::size_t first, std::size_t past) { cpu::search_block(job, begin + first, begin + past); });
        }
        b.count_passes("knn_search", now, watch);
        progress p;
        p.passes = now;
        for (uint i = 0; i < now; ++i)
            p.active.push_back(n - begin - i * a_pass);
        p.finished = done_ == n;
        return p;
    }

    knn_estimates<cpu_backend> estimates() & { return {copy(e_.irradiance), copy(e_.used), copy(e_.standard_error)}; }
    /// Of a search that goes away: nothing is copied.
    knn_estimates<cpu_backend> estimates() && { return std::move(e_); }

private:
    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const vectors* normals,
        const knn_settings& s)
        : in_(b, map, points, normals, s)
    {
        const std::size_t n = points.size();
        e_ = {b.make<glm::vec4>(n), b.make<glm::uvec2>(n), b.make<glm::vec4>(s.errors ? n : 0)};
        const auto unfinished = [&](auto& buffer, const auto& value) {
            const auto rows = b.rows_to_write(buffer);
            std::fill(rows.begin(), rows.end(), value);
        };
        unfinished(e_.irradiance, glm::vec4(0, 0, 0, in_.max_radius2()));
        unfinished(e_.used, glm::uvec2(0));
        unfinished(e_.standard_error, glm::vec4(0));
        const cpu_backend::stopwatch watch;
        order_ = cpu::order_along_curve(b, map.cells_of, points);
        b.count_passes("knn_search", 0, watch);
    }

    template <element T>
    cpu_backend::buffer<T> copy(const cpu_backend::buffer<T>& from)
    {
        auto& b = *in_.b;
        return b.upload(b.rows(from));
    }

    detail::search_inputs<cpu_backend> in_;
    knn_estimates<cpu_backend> e_;
    cpu_backend::buffer<uint> order_;
    std::size_t done_ = 0; // in that order
};

} // namespace photongrid
