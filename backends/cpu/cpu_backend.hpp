// The type cpu_backend, and what is declared for it: whoever sees the type sees these declarations, so that no two
// files of a program can take different ways. Include cpu.hpp, which defines them.
#pragma once

#include <photongrid/backends/cpu/cpu_by_kernels.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/build_map.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

// The type has another name in programs that link photongrid::cpu_compiled, so that what the library has compiled and
// what a file compiles for itself are never taken for one another: they do not link.
#if defined(PHOTONGRID_CPU_COMPILED)
inline namespace compiled {
#else
inline namespace header_only {
#endif
    /// Threads and SIMD. Sorting, building maps and searching have algorithms of their own here (overrides/), with the
    /// same results as the kernels'; all else runs by kernels. One thread at a time drives a cpu_backend and its
    /// buffers. Results do not depend on how many threads it uses. Up to 128 MiB of memory that buffers gave back are
    /// kept for the next ones, and are not counted in bytes().
    /// \headerfile backends/cpu/cpu.hpp <photongrid/backends/cpu/cpu.hpp>
    /// \snippet snippets_cpu.cpp cpu_backend
    class cpu_backend : public cpu_by_kernels {
    public:
        using cpu_by_kernels::cpu_by_kernels;
    };
}

static_assert(backend<cpu_backend>);

sort_report bitonic_sort(cpu_backend& b, cpu_backend::buffer<glm::uvec2>& pairs);
cpu_backend::buffer<glm::uvec2> grid_index(cpu_backend& b, const cpu_backend::buffer<glm::uvec2>& pairs, uint cells);
map_buffers<cpu_backend> sorted_map(cpu_backend& b, photons<cpu_backend> p, const grid& g, uint parts = every_part);
/// Finds the same photons as the kernels do; sums differ from theirs by 10^-6 at most, since they are added up in
/// another order. A pass searches for some points whole, and advance() counts those.
template <>
class knn_search<cpu_backend> {
public:
    using vectors = cpu_backend::buffer<glm::vec4>;

    knn_search(cpu_backend& b, const map_buffers<cpu_backend>& map, const vectors& points, const knn_settings& s)
        : knn_search(b, map, points, nullptr, s)
    {
    }
    knn_search(cpu_backend& b, const map_buffers<cpu_backend>& map, const vectors& points, const vectors& normals,
        const knn_settings& s)
        : knn_search(b, map, points, &normals, s)
    {
    }

    // A search refers to both until it is gone.
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&&, const vectors&, const knn_settings&) = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&&, const knn_settings&) = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&&, const vectors&, const vectors&, const knn_settings&)
        = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&&, const vectors&, const knn_settings&)
        = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&, const vectors&&, const knn_settings&)
        = delete;

    /// A point's estimate is made at once: there is none of it before.
    static constexpr bool shows_running_estimate(const knn_settings&) { return false; }

    progress advance(uint passes = nowhere);

    [[nodiscard]] knn_estimates<cpu_backend> estimates() &;
    /// Of a search that goes away: nothing is copied.
    [[nodiscard]] knn_estimates<cpu_backend> estimates() &&;

private:
    knn_search(cpu_backend& b, const map_buffers<cpu_backend>& map, const vectors& points, const vectors* normals,
        const knn_settings& s);

    detail::search_inputs<cpu_backend> in_;
    knn_estimates<cpu_backend> e_;
    cpu_backend::buffer<uint> order_;
    std::size_t done_ = 0; // in that order
};

neighbour_lists<cpu_backend> knn_neighbours(cpu_backend& b, const map_buffers<cpu_backend>& map,
    const cpu::buffer<glm::vec4>& points, const knn_settings& settings);
neighbour_lists<cpu_backend> knn_neighbours(cpu_backend& b, const map_buffers<cpu_backend>& map,
    const cpu::buffer<glm::vec4>& points, const cpu::buffer<glm::vec4>& normals, const knn_settings& settings);

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
