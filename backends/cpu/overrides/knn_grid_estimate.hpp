// The cpu backend's search: exact_k and fixed_radius in vectors, points in an order in which neighbours follow each other.
// at_least_k, whose result depends on the order of visits, goes by the kernels.
#pragma once

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/cpu/overrides/radix_sort.hpp>
#include <photongrid/backends/cpu/overrides/simd.hpp>
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
        const cpu_backend::stopwatch watch;
        const std::size_t n = points_->size(), begin = done_;
        // Blocks stay the same however many there are to a pass: a block's queries help each other.
        const std::size_t a_pass = block * std::max(1u, s_.visits_per_pass / 128u);
        const std::size_t left = (n - begin + a_pass - 1) / a_pass;
        const auto now = static_cast<uint>(std::min<std::size_t>(passes, left));
        done_ = std::min(n, begin + now * a_pass);
        if (done_ > begin) {
            const auto job = make_job();
            b_->threads().for_blocks(done_ - begin, block, [&](std::size_t first, std::size_t past) { cpu::search_block(job, begin + first, begin + past); });
        }
        b_->count_passes("knn_search", now, watch);
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
    static constexpr std::size_t block = 256; // points that follow each other on one thread

    knn_search(cpu_backend& b, const photon_map<cpu_backend>& map, const vectors& points, const vectors* normals, const knn_settings& s)
        : b_(&b), map_(&map), points_(&points), normals_(normals)
    {
        if (s.search == search_kind::at_least_k) {
            if (normals != nullptr)
                by_kernels_.emplace(b, map, points, *normals, s);
            else
                by_kernels_.emplace(b, map, points, s);
            return;
        }
        const std::size_t n = points.size();
        s_ = detail::checked(s, map, n, normals != nullptr ? normals->size() : 0);
        e_ = {b.make<glm::vec4>(n), b.make<glm::uvec2>(n), b.make<glm::vec4>(s_.errors ? n : 0)};
        const auto unfinished = b.rows_to_write(e_.irradiance);
        std::fill(unfinished.begin(), unfinished.end(), glm::vec4(0, 0, 0, detail::max_radius2(s_)));
        put_in_order();
    }

    /// Orders points along a curve that keeps neighbours together (Morton 1966), 1,024 steps along each axis of the grid.
    void put_in_order()
    {
        const cpu_backend::stopwatch watch;
        auto& b = *b_;
        const std::size_t n = points_->size();
        auto pairs = b.make<glm::uvec2>(n);
        auto scratch = b.make<glm::uvec2>(n);
        const auto points = b.rows(*points_);
        const auto to = b.rows_to_write(pairs);
        const auto& g = map_->cells_of;
        const glm::vec3 steps = 1024.0f / (glm::vec3(g.cell) * glm::vec3(g.resolution));
        const auto spread = [](float u) {
            u = u > 0.0f ? u : 0.0f;
            auto v = static_cast<uint>(u < 1023.0f ? u : 1023.0f);
            v = (v | v << 16) & 0x030000FFu;
            v = (v | v << 8) & 0x0300F00Fu;
            v = (v | v << 4) & 0x030C30C3u;
            return (v | v << 2) & 0x09249249u;
        };
        b.threads().for_blocks(n, 4096, [&](std::size_t first, std::size_t past) {
            for (std::size_t i = first; i < past; ++i) {
                const glm::vec3 u = (glm::vec3(points[i]) - glm::vec3(g.origin)) * steps;
                to[i] = {spread(u.x) | spread(u.y) << 1 | spread(u.z) << 2, static_cast<uint>(i)};
            }
        });
        const auto sorted = cpu::radix_sort(b.threads(), to.data(), b.rows_to_write(scratch).data(), n);
        const auto from = b.rows(sorted.in_scratch ? scratch : pairs);
        order_ = b.make<uint>(n);
        const auto order = b.rows_to_write(order_);
        b.threads().for_blocks(n, 16384, [&](std::size_t first, std::size_t past) {
            for (std::size_t i = first; i < past; ++i)
                order[i] = from[i].y;
        });
        b.count_passes("knn_search", 0, watch);
    }

    cpu::search_job make_job()
    {
        auto& b = *b_;
        const auto& photons = map_->photons;
        cpu::search_job j;
        j.cells_of = map_->cells_of;
        j.cells = b.rows(map_->cells);
        j.positions = b.planes(photons.positions);
        j.powers = b.planes(photons.powers);
        j.side = s_.leaks.side;
        j.agreement = s_.leaks.needs_normals();
        j.min_cosine = s_.leaks.min_cosine;
        j.flattening = s_.leaks.compression > 1 ? s_.leaks.compression * s_.leaks.compression - 1.0f : 0.0f;
        if (j.side)
            j.directions = b.planes(photons.directions);
        if (j.agreement)
            j.normals = b.planes(photons.normals);
        j.list = b.rows(map_->list).data();
        j.points = b.rows(*points_).data();
        if (s_.leaks.needs_any())
            j.point_normals = b.rows(*normals_).data();
        j.order = b.rows(order_).data();
        j.exact = s_.search == search_kind::exact_k;
        j.searching = detail::is_searching(s_, photons.size());
        j.wanted = s_.k;
        j.max_radius2 = detail::max_radius2(s_);
        j.min_radius2 = detail::min_radius2(s_);
        j.kernel = s_.kernel;
        j.norm = detail::norm_of(s_.kernel);
        j.leave_out = s_.bias == bias_kind::unbiased;
        j.errors = s_.errors;
        j.irradiance = b.rows_to_write(e_.irradiance).data();
        j.used = b.rows_to_write(e_.used).data();
        if (j.errors)
            j.standard_error = b.rows_to_write(e_.standard_error).data();
        return j;
    }

    template <element T>
    cpu_backend::buffer<T> copy(const cpu_backend::buffer<T>& from)
    {
        return b_->upload(b_->rows(from));
    }

    cpu_backend* b_;
    const photon_map<cpu_backend>* map_;
    const vectors* points_;
    const vectors* normals_;
    knn_settings s_{};
    knn_estimates<cpu_backend> e_;
    cpu_backend::buffer<uint> order_;
    std::size_t done_ = 0; // in that order
    std::optional<knn_search_by_kernels<cpu_backend>> by_kernels_;
};

} // namespace photongrid
