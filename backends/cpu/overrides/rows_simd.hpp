// SIMD code that finds the rows of cells near a point. Included once per instruction set, so it has no include guard;
// other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/distances_simd.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The photons of several rows of cells, as ranges.
struct rows_found {
    std::vector<uint> first, past;
    std::size_t rows = 0;
};

/// The same as kernels::clamped_cell: for numbers that are not negative, truncation rounds down.
inline uint cell_at(float u, uint resolution)
{
    const float last = static_cast<float>(resolution - 1u);
    u = u > 0.0f ? u : 0.0f;
    u = u < last ? u : last;
    return std::min(static_cast<uint>(u), resolution - 1u);
}
inline glm::uvec2 cells_within(float x, float radius, float origin, float inverse_cell, uint resolution)
{
    return {cell_at(kernels::in_cells(x - radius, origin, inverse_cell), resolution),
        cell_at(kernels::in_cells(x + radius, origin, inverse_cell), resolution)};
}

/// kernels::gap for a register of cells: distances, m, along one axis from a point at u in cell c.
HWY_INLINE vector gaps(hn::VFromD<ints> cell, float u, uint c, float size)
{
    const floats d;
    const auto v = hn::ConvertTo(d, cell), at = hn::Set(d, u);
    const auto margin = hn::Mul(hn::Add(hn::Add(v, hn::Abs(at)), hn::Set(d, 2.0f)), hn::Set(d, 9.5367431640625e-7f));
    const auto beyond = hn::Sub(hn::Sub(v, at), margin),
               before = hn::Sub(hn::Sub(at, hn::Add(v, hn::Set(d, 1.0f))), margin);
    const auto here = hn::Set(d, static_cast<float>(c));
    auto gap = hn::IfThenElseZero(hn::Gt(v, here), beyond);
    gap = hn::IfThenElse(hn::Lt(v, here), before, gap);
    return hn::Mul(hn::Max(gap, hn::Zero(d)), hn::Set(d, size));
}

/// Finds the photons of every row of cells that can lie within radius2, as search_rows.glsl does, a register of rows at
/// a time.
HWY_INLINE void find_rows(const search_job& j, const glm::vec3& at, float radius2, rows_found& s)
{
    const grid& g = j.cells_of;
    const float radius = std::sqrt(radius2) * 1.00000095f + 1.1e-19f;
    const auto rows_y = cells_within(at.y, radius, g.origin.y, g.inverse_cell.y, g.resolution.y);
    const auto rows_z = cells_within(at.z, radius, g.origin.z, g.inverse_cell.z, g.resolution.z);
    const float u_y = kernels::in_cells(at.y, g.origin.y, g.inverse_cell.y),
                u_z = kernels::in_cells(at.z, g.origin.z, g.inverse_cell.z);
    const uint c_y = cell_at(u_y, g.resolution.y), c_z = cell_at(u_z, g.resolution.z);

    const floats d;
    const ints di;
    const std::size_t width = hn::Lanes(d);
    const std::size_t rows = std::size_t{rows_y.y - rows_y.x + 1} * (rows_z.y - rows_z.x + 1) + width;
    if (s.first.size() < rows) {
        s.first.resize(rows);
        s.past.resize(rows);
    }
    const auto wide = hn::Set(d, 9.5367431640625e-7f);
    const auto last = hn::Set(d, static_cast<float>(g.resolution.x - 1u));
    const auto last_cell = hn::Set(di, static_cast<int>(g.resolution.x - 1u));
    const auto x_cell = [&](vector x) HWY_ATTR {
        auto u = hn::Mul(hn::Sub(x, hn::Set(d, g.origin.x)), hn::Set(d, g.inverse_cell.x));
        u = hn::IfThenElseZero(hn::Gt(u, hn::Zero(d)), u);
        return hn::Min(hn::ConvertTo(di, hn::Min(u, last)), last_cell);
    };
    std::size_t n = 0;
    for (uint z = rows_z.x; z <= rows_z.y; ++z) {
        const float gap_z = kernels::gap(u_z, c_z, z, g.cell.z);
        // Gather indices are relative to a slab of cells. A cell has two words, so a slab has at most 2^29 cells.
        const auto* const slab
            = reinterpret_cast<const int*>(j.cells.data() + std::size_t{z} * g.resolution.y * g.resolution.x);
        for (uint y = rows_y.x; y <= rows_y.y; y += static_cast<uint>(width)) {
            const auto cell = hn::Add(hn::Set(di, static_cast<int>(y)), hn::Iota(di, 0));
            const auto gap_y = gaps(cell, u_y, c_y, g.cell.y);
            const auto r2 = hn::Set(d, radius2);
            const auto left2
                = hn::Add(hn::Sub(r2, hn::Add(hn::Mul(gap_y, gap_y), hn::Set(d, gap_z * gap_z))), hn::Mul(r2, wide));
            const auto half_width = hn::Add(
                hn::Mul(hn::Sqrt(hn::Max(left2, hn::Zero(d))), hn::Set(d, 1.00000095f)), hn::Set(d, 1.1e-19f));
            const auto x = hn::Set(d, at.x);
            const auto row = hn::Mul(hn::Min(cell, hn::Set(di, static_cast<int>(g.resolution.y - 1u))),
                hn::Set(di, static_cast<int>(g.resolution.x)));
            const auto low = hn::Add(row, x_cell(hn::Sub(x, half_width))),
                       high = hn::Add(row, x_cell(hn::Add(x, half_width)));
            const auto two_low = hn::Add(low, low), two_high = hn::Add(high, high);
            const auto first = hn::GatherIndex(di, slab, two_low);
            const auto past = hn::Add(hn::GatherIndex(di, slab, two_high), hn::GatherIndex(di, slab + 1, two_high));
            auto some = hn::RebindMask(d, hn::Lt(first, past));
            some = hn::And(some, hn::And(hn::Ge(left2, hn::Zero(d)), hn::FirstN(d, rows_y.y - y + 1)));
            const auto some_int = hn::RebindMask(di, some);
            store_some(di, first, some_int, reinterpret_cast<int*>(s.first.data() + n));
            n += store_some(di, past, some_int, reinterpret_cast<int*>(s.past.data() + n));
        }
    }
    s.rows = n;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
