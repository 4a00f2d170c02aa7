// The cpu backend's search: exact_k and fixed_radius in vectors, points in an order in which neighbours follow each other.
// at_least_k, whose result depends on the order of visits, goes by the kernels.
#pragma once

#include <photongrid/backends/cpu/overrides/search.hpp>
#include <photongrid/knn_grid_estimate.hpp>

namespace photongrid {

/// Finds the same photons as the kernels do; sums differ from theirs by 10^-6 at most, since they are added up in another
/// order. A pass searches for some points whole, and advance() counts those.
template <>
class knn_search<cpu_backend> {
public:
    using vectors = cpu_backend::buffer<glm::vec4>;

    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const knn_settings& s)
        : knn_search(b, map, points, nullptr, s) {}
    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const vectors& normals, const knn_settings& s)
        : knn_search(b, map, points, &normals, s) {}

    progress advance(uint passes = nowhere)
    {
        if (by_kernels_)
            return by_kernels_->advance(passes);
        auto& b = *in_->b;
        const cpu_backend::stopwatch watch;
        const std::size_t n = in_->points->size(), begin = done_;
        const std::size_t a_pass = cpu::search_block_size * std::max(1u, in_->s.visits_per_pass / 128u);
        const std::size_t left = (n - begin + a_pass - 1) / a_pass;
        const auto now = static_cast<uint>(std::min<std::size_t>(passes, left));
        done_ = std::min(n, begin + now * a_pass);
        if (done_ > begin) {
            auto job = cpu::make_search_job(*in_, order_);
            job.irradiance = b.rows_to_write(e_.irradiance).data();
            job.used = b.rows_to_write(e_.used).data();
            if (job.errors)
                job.standard_error = b.rows_to_write(e_.standard_error).data();
            b.threads().for_blocks(done_ - begin, cpu::search_block_size, [&](std::size_t first, std::size_t past) { cpu::search_block(job, begin + first, begin + past); });
        }
        b.count_passes("knn_search", now, watch);
        progress p;
        p.passes = now;
        for (uint i = 0; i < now; ++i)
            p.active.push_back(n - begin - i * a_pass);
        p.finished = done_ == n;
        return p;
    }

    knn_estimates<cpu_backend> estimates() &
    {
        if (by_kernels_)
            return by_kernels_->estimates();
        return {copy(e_.irradiance), copy(e_.used), copy(e_.standard_error)};
    }
    /// Of a search that goes away: nothing is copied.
    knn_estimates<cpu_backend> estimates() &&
    {
        if (by_kernels_)
            return by_kernels_->estimates();
        return std::move(e_);
    }

private:
    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const vectors* normals, const knn_settings& s)
    {
        if (s.search == search_kind::at_least_k) {
            if (normals != nullptr)
                by_kernels_.emplace(b, map, points, *normals, s);
            else
                by_kernels_.emplace(b, map, points, s);
            return;
        }
        const std::size_t n = points.size();
        in_.emplace(b, map, points, normals, s);
        e_ = {b.make<glm::vec4>(n), b.make<glm::uvec2>(n), b.make<glm::vec4>(s.errors ? n : 0)};
        const auto unfinished = b.rows_to_write(e_.irradiance);
        std::fill(unfinished.begin(), unfinished.end(), glm::vec4(0, 0, 0, in_->max_radius2()));
        const cpu_backend::stopwatch watch;
        order_ = cpu::order_along_curve(b, map.cells_of, points);
        b.count_passes("knn_search", 0, watch);
    }

    template <element T>
    cpu_backend::buffer<T> copy(const cpu_backend::buffer<T>& from)
    {
        auto& b = *in_->b;
        return b.upload(b.rows(from));
    }

    std::optional<detail::search_inputs<cpu_backend>> in_;
    knn_estimates<cpu_backend> e_;
    cpu_backend::buffer<uint> order_;
    std::size_t done_ = 0; // in that order
    std::optional<knn_search_by_kernels<cpu_backend>> by_kernels_;
};

} // namespace photongrid
