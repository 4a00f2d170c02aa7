// The type cpu_backend and the declarations of its overrides. They are in one header, so that all files of a program
// use the same overrides. Include cpu.hpp, which defines them.
#pragma once

#include <photongrid/backends/cpu/cpu_by_kernels.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/trace/ray_search.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

// The type is in another namespace in programs that link photongrid::cpu_compiled, so that a program cannot mix the
// library's code with code that it compiles itself: that does not link.
#if defined(PHOTONGRID_CPU_COMPILED)
inline namespace compiled {
#else
inline namespace header_only {
#endif
    /// Threads and SIMD. It sorts, builds maps and searches by its own algorithms (overrides/), with the same results
    /// as the kernels, and runs kernels for everything else. One thread at a time may use a cpu_backend and its
    /// buffers. Results do not depend on the number of threads. It keeps up to 512 MiB of freed memory for new buffers,
    /// which bytes() does not count.
    /// \headerfile backends/cpu/cpu.hpp <photongrid/backends/cpu/cpu.hpp>
    /// \snippet snippets_cpu.cpp cpu_backend
    class cpu_backend : public cpu_by_kernels {
    public:
        using cpu_by_kernels::cpu_by_kernels;
    };
}

static_assert(backend<cpu_backend>);

/// \name Algorithms by code for this backend
/// @{

/// The algorithm of that name, with the same results.
sort_report bitonic_sort(cpu_backend& device, cpu_backend::buffer<glm::uvec2>& pairs);
cpu_backend::buffer<glm::uvec2> grid_index(
    cpu_backend& device, const cpu_backend::buffer<glm::uvec2>& pairs, uint cells);
map_buffers<cpu_backend> sorted_map(
    cpu_backend& device, photons<cpu_backend> p, const grid& g, uint parts = every_part);
map_buffers<cpu_backend> block_map(cpu_backend& device, photons<cpu_backend> p, uint parts = every_part);
/// @}

/// The search on the cpu backend. It finds the same photons as the kernels. Sums differ by at most 10^-6, because the
/// order of summation differs. A pass completes the searches of some of the points.
/// \headerfile backends/cpu/cpu.hpp <photongrid/backends/cpu/cpu.hpp>
template <>
class knn_search<cpu_backend> {
public:
    using vectors = cpu_backend::buffer<glm::vec4>;

    knn_search(cpu_backend& device, const map_buffers<cpu_backend>& map, const vectors& points, const knn_settings& s)
        : knn_search(device, map, points, nullptr, s)
    {
    }
    knn_search(cpu_backend& device, const map_buffers<cpu_backend>& map, const vectors& points, const vectors& normals,
        const knn_settings& s)
        : knn_search(device, map, points, &normals, s)
    {
    }

    // Temporaries would dangle.
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&&, const vectors&, const knn_settings&) = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&&, const knn_settings&) = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&&, const vectors&, const vectors&, const knn_settings&)
        = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&&, const vectors&, const knn_settings&)
        = delete;
    knn_search(cpu_backend&, const map_buffers<cpu_backend>&, const vectors&, const vectors&&, const knn_settings&)
        = delete;

    /// False: a point's search is completed in one pass.
    static constexpr bool shows_running_estimate(const knn_settings&) { return false; }

    progress advance(uint passes = all_passes);

    [[nodiscard]] knn_estimates<cpu_backend> estimates() &;
    /// The same without a copy.
    [[nodiscard]] knn_estimates<cpu_backend> estimates() &&;

private:
    knn_search(cpu_backend& device, const map_buffers<cpu_backend>& map, const vectors& points, const vectors* normals,
        const knn_settings& s);

    detail::search_inputs<cpu_backend> in_;
    knn_estimates<cpu_backend> e_;
    cpu_backend::buffer<uint> order_;
    std::size_t done_ = 0; // points done, in that order
};

/// \name Lists of neighbours by code for this backend
/// @{

/// The algorithm of that name, with the same results.
neighbour_lists<cpu_backend> knn_neighbours(cpu_backend& device, const map_buffers<cpu_backend>& map,
    const cpu::buffer<glm::vec4>& points, const knn_settings& settings);
neighbour_lists<cpu_backend> knn_neighbours(cpu_backend& device, const map_buffers<cpu_backend>& map,
    const cpu::buffer<glm::vec4>& points, const cpu::buffer<glm::vec4>& normals, const knn_settings& settings);
/// @}

/// \name Rays by code for this backend
/// @{

namespace cpu {
    /// Where the tree of an instance's surface begins.
    struct wide_root {
        uint node;
        glm::vec3 low, high; ///< box of the surface, in its own space, m
    };
} // namespace cpu

/// The triangles of a mesh in a tree of nodes with up to eight children (overrides/wide_tree.hpp).
template <>
struct device_triangles<cpu_backend> {
    cpu::buffer<float> nodes, blocks;
    cpu::buffer<glm::vec4> planes;     ///< of the triangles in blocks
    glm::vec3 low{0}, high{0};         ///< box of all triangles, m
    cpu::buffer<glm::uvec4> instances; ///< see trace/instance.glsl; one element if there are none
    std::vector<cpu::wide_root> roots; ///< of the instances' surfaces

    uint instance_count() const { return static_cast<uint>(roots.size()); }
    /// Of the buffers of nodes and triangles.
    std::size_t bytes() const
    {
        return (nodes.size() + blocks.size()) * sizeof(float) + planes.size() * sizeof(glm::vec4);
    }
};
/// The algorithm of that name.
triangle_tree build_triangle_tree(cpu_backend& device, const mesh& m);
triangle_tree build_instance_tree(
    cpu_backend& device, std::span<const mesh> surfaces, std::span<const placement> placements);
device_triangles<cpu_backend> upload_triangles(cpu_backend& device, const triangle_tree& tree);

/// The hit of one ray, on the calling thread, for hosts that follow rays one by one: as trace_rays() finds it, which
/// finds more hits a second. Several threads may call it at once.
/// \param origin, direction see ray_search
ray_hit trace_ray(cpu_backend& device, const device_triangles<cpu_backend>& triangles, const glm::vec4& origin,
    const glm::vec4& direction, hit_kind kind = hit_kind::closest);

/// The same hits; where any hit will do, perhaps another one. A pass completes the searches of some of the rays.
template <>
progress ray_search<cpu_backend>::advance(uint passes);
/// @}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
