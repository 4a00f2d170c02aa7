// SIMD code for photons as structures of arrays, their distances from a point, and packets of photons. Included once
// per instruction set (Highway), so it has no include guard: search_simd.hpp includes grow_simd.hpp, which includes
// gather_simd.hpp, which includes this file; other files include simd.hpp.
#include <hwy/highway.h>

#include <photongrid/backends/cpu/overrides/compress_table.hpp>
#include <photongrid/backends/cpu/overrides/search_job.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using floats = hn::CappedTag<float, lanes>;
using uints = hn::RebindToUnsigned<floats>;
using ints = hn::RebindToSigned<floats>;
using vector = hn::VFromD<floats>;

/// Stores the lanes of the mask contiguously, and undefined values in the rest of a register's width. Returns the
/// number of lanes in the mask. It does not use Highway's CompressStore for short registers: g++ copies its tables to
/// the stack at every call, which made the whole search five times slower with AVX2.
template <class D, class Mask>
HWY_INLINE std::size_t store_some(D d, hn::VFromD<D> v, Mask mask, hn::TFromD<D>* to)
{
    constexpr std::size_t width = hn::MaxLanes(d);
    if constexpr (width > 1 && width <= 8) {
        std::uint8_t bits[8]; // StoreMaskBits writes up to 8 bytes
        const std::size_t some = hn::CountTrue(d, mask);
        hn::StoreMaskBits(d, mask, bits);
        const std::int32_t* const order = compress_table<width>[bits[0]].data();
        hn::StoreU(hn::TableLookupLanes(v, hn::SetTableIndices(d, order)), d, to);
        return some;
    } else {
        return hn::CompressStore(v, mask, d, to);
    }
}

/// A query point and its normal.
struct query {
    glm::vec3 at{0}, normal{0};
};

/// The attributes of photons in the map or in a packet.
struct photon_vectors {
    soa_vectors<const float> positions, directions, normals; ///< the last two only where a policy needs them
};

/// A query, broadcast to all lanes.
struct query_lanes {
    vector x, y, z, normal_x, normal_y, normal_z;
    HWY_INLINE explicit query_lanes(const query& q)
    {
        const floats d;
        x = hn::Set(d, q.at.x);
        y = hn::Set(d, q.at.y);
        z = hn::Set(d, q.at.z);
        normal_x = hn::Set(d, q.normal.x);
        normal_y = hn::Set(d, q.normal.y);
        normal_z = hn::Set(d, q.normal.z);
    }
};

/// Squared distances of a register of photons, from photon i on, as in photon_distance.glsl: photons that a policy
/// rejects are farther than any radius. POLICIES: 0: none, 1: only leak_policy::side, 2: any.
template <int POLICIES>
HWY_INLINE vector squared_distances(
    const search_job& j, const query_lanes& q, const photon_vectors& photons, std::size_t i)
{
    const floats d;
    const auto smallest = hn::Set(d, std::numeric_limits<float>::min()),
               rejected = hn::Set(d, std::numeric_limits<float>::max());
    const auto& at = photons.positions;
    const auto dx = hn::Sub(hn::LoadU(d, at.x + i), q.x), dy = hn::Sub(hn::LoadU(d, at.y + i), q.y),
               dz = hn::Sub(hn::LoadU(d, at.z + i), q.z);
    auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto along_normal = [&](const soa_vectors<const float>& v) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(hn::LoadU(d, v.x + i), q.normal_x), hn::Mul(hn::LoadU(d, v.y + i), q.normal_y)),
            hn::Mul(hn::LoadU(d, v.z + i), q.normal_z));
    };
    if (POLICIES == 2 && j.flattening > 0) {
        const auto h = hn::Add(hn::Add(hn::Mul(dx, q.normal_x), hn::Mul(dy, q.normal_y)), hn::Mul(dz, q.normal_z));
        d2 = hn::Add(d2, hn::Mul(hn::Set(d, j.flattening), hn::Mul(h, h)));
    }
    d2 = hn::IfThenZeroElse(hn::Lt(d2, smallest), d2);
    if (POLICIES == 1 || (POLICIES == 2 && j.side))
        d2 = hn::IfThenElse(hn::Lt(along_normal(photons.directions), hn::Zero(d)), d2, rejected);
    if (POLICIES == 2 && j.needs_normals)
        d2 = hn::IfThenElse(hn::Ge(along_normal(photons.normals), hn::Set(d, j.min_cosine)), d2, rejected);
    return d2;
}

/// The photons of several rows of cells, as ranges.
struct rows_found {
    std::vector<uint> first, past;
    std::size_t rows = 0;
};

/// kernels::clamped_cell; for numbers that are not negative, truncation rounds down.
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

/// The photons near several queries, or those found by a query, stored contiguously.
class packet {
public:
    enum component {
        x,
        y,
        z,
        red,
        green,
        blue,
        direction_x,
        direction_y,
        direction_z,
        normal_x,
        normal_y,
        normal_z,
        squared_distance,
        kept,
        count
    };

    std::size_t size() const { return size_; }
    float* of(component p) const { return memory_ + p * stride_; }
    /// The index of photon i in the map.
    uint index(std::size_t i) const { return indices_[i]; }
    photon_vectors photons() const
    {
        return {{of(x), of(y), of(z)}, {of(direction_x), of(direction_y), of(direction_z)},
            {of(normal_x), of(normal_y), of(normal_z)}};
    }

    /// Copies the photons within `radius` of `center`, and perhaps some that are a little farther. Returns how many it
    /// examined.
    HWY_INLINE std::size_t fill(const search_job& j, const glm::vec3& center, float radius)
    {
        const floats d;
        const uints du;
        const std::size_t width = hn::Lanes(d);
        const float radius2 = radius * radius * 1.000004f + 1e-36f;
        find_rows(j, center, radius2, rows_);
        std::size_t n = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r)
            n += rows_.past[r] - rows_.first[r];
        clear();
        reserve(n);
        const auto cx = hn::Set(d, center.x), cy = hn::Set(d, center.y), cz = hn::Set(d, center.z),
                   within2 = hn::Set(d, radius2);
        std::size_t k = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r) {
            const std::size_t past = rows_.past[r];
            for (std::size_t i = rows_.first[r]; i < past; i += width) {
                const auto px = hn::LoadU(d, j.positions.x + i), py = hn::LoadU(d, j.positions.y + i),
                           pz = hn::LoadU(d, j.positions.z + i);
                const auto dx = hn::Sub(px, cx), dy = hn::Sub(py, cy), dz = hn::Sub(pz, cz);
                const auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
                const auto near = hn::And(hn::Le(d2, within2), hn::FirstN(d, past - i));
                const std::size_t some = store_some(d, px, near, of(x) + k);
                store_some(d, py, near, of(y) + k);
                store_some(d, pz, near, of(z) + k);
                const auto take = [&](component p, const float* from)
                                      HWY_ATTR { store_some(d, hn::LoadU(d, from + i), near, of(p) + k); };
                take(red, j.powers.x); // for lists too: testing for that would cost estimates more than it saves
                take(green, j.powers.y);
                take(blue, j.powers.z);
                if (j.side) {
                    take(direction_x, j.directions.x);
                    take(direction_y, j.directions.y);
                    take(direction_z, j.directions.z);
                }
                if (j.needs_normals) {
                    take(normal_x, j.normals.x);
                    take(normal_y, j.normals.y);
                    take(normal_z, j.normals.z);
                }
                store_some(du, hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)), hn::RebindMask(du, near),
                    indices_ + k);
                k += some;
            }
        }
        // Pad with photons that are infinitely far and have no power.
        for (std::size_t i = k; i < k + lanes; ++i) {
            of(x)[i] = of(y)[i] = of(z)[i] = std::numeric_limits<float>::infinity();
            of(red)[i] = of(green)[i] = of(blue)[i] = 0;
        }
        size_ = k;
        return n;
    }

    /// Removes all photons.
    void clear() { size_ = 0; }
    /// Makes room for n more photons.
    void reserve(std::size_t n)
    {
        if (size_ + n + slack > stride_)
            grow(size_ + n);
    }
    /// Adds the photons of `some` in the register that begins at `index`.
    HWY_INLINE void add(vector distances2, hn::Mask<floats> some, std::size_t index)
    {
        const uints du;
        const std::size_t added = store_some(floats(), distances2, some, of(squared_distance) + size_);
        store_some(du, hn::Add(hn::Set(du, static_cast<uint>(index)), hn::Iota(du, 0)), hn::RebindMask(du, some),
            indices_ + size_);
        size_ += added;
    }
    /// Loads the powers of all photons that were added.
    HWY_INLINE void fetch_powers(const search_job& j)
    {
        const floats d;
        const ints di;
        reserve(0);
        for (std::size_t i = size_; i < size_ + lanes; ++i) { // padding without power
            of(squared_distance)[i] = std::numeric_limits<float>::infinity();
            indices_[i] = 0;
        }
        for (std::size_t i = 0; i < size_; i += lanes)
            for (std::size_t l = i; l < i + lanes; l += hn::Lanes(d)) {
                const auto at = hn::Load(di, reinterpret_cast<const int*>(indices_ + l));
                hn::Store(hn::GatherIndex(d, j.powers.x, at), d, of(red) + l);
                hn::Store(hn::GatherIndex(d, j.powers.y, at), d, of(green) + l);
                hn::Store(hn::GatherIndex(d, j.powers.z, at), d, of(blue) + l);
            }
    }

private:
    static constexpr std::size_t slack = 5 * lanes; ///< for stores past the end

    /// Makes room for n photons, and keeps the distances and indices of the present ones.
    void grow(std::size_t n)
    {
        const std::size_t stride = component_stride(2 * n + slack);
        storage block((count + 1) * stride * sizeof(float));
        auto* const memory = reinterpret_cast<float*>(block.begin());
        auto* const indices = reinterpret_cast<uint*>(memory + count * stride);
        std::copy_n(of(squared_distance), size_, memory + squared_distance * stride);
        std::copy_n(indices_, size_, indices);
        block_ = std::move(block);
        memory_ = memory;
        indices_ = indices;
        stride_ = stride;
    }
    rows_found rows_;
    storage block_;
    float* memory_ = nullptr;
    uint* indices_ = nullptr;
    std::size_t size_ = 0, stride_ = 0;
};

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/backend/exact_end.hpp>
