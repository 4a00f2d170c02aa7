// The search in vectors. Read once for every instruction set that the compiler knows (Highway), so no include guard; other
// files include simd.hpp.
//
// Queries that lie close together go in packets. The photons near a packet, in all rows of cells that can hold any, are copied
// once, one after the other, so that each query reads full vectors of just those. It does so twice: the first scan finds the
// k-th squared distance, the second weighs and adds up.
//
// Moving a query point by s changes the distance to its k-th nearest photon by s at most, so that distance lies in a narrow
// band about the last query's: photons nearer than the band are counted, those in it are kept, and the k-th is selected among
// these few. The counts prove the result; where they say that it lies elsewhere, the scan is repeated without the band, and
// where the packet does not reach far enough, a new one is made.
//
// Sums have 16 lanes whatever a register's width, so that results are the same to the bit on every machine.
#include <hwy/highway.h>

#include <photongrid/backends/cpu/overrides/compress_table.hpp>
#include <photongrid/backends/cpu/overrides/search_job.hpp>

#include <algorithm>
#include <bit>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using floats = hn::CappedTag<float, lanes>;
using uints = hn::RebindToUnsigned<floats>;
using ints = hn::RebindToSigned<floats>;
using vector = hn::VFromD<floats>;

/// Stores the lanes that the mask has, one after the other, and anything in the rest of a register's width. Returns how many
/// they are. Not by Highway's own where registers are short: g++ copies its tables to the stack at every call, which made the
/// whole search five times slower with AVX2.
template <class D, class Mask>
HWY_INLINE std::size_t store_some(D d, hn::VFromD<D> v, Mask mask, hn::TFromD<D>* to)
{
    constexpr std::size_t width = hn::MaxLanes(d);
    if constexpr (width > 1 && width <= 8) {
        std::uint8_t bits[8]; // that many are written
        const std::size_t some = hn::CountTrue(d, mask);
        hn::StoreMaskBits(d, mask, bits);
        const std::int32_t* const order = compress_table<width>[bits[0]].data();
        hn::StoreU(hn::TableLookupLanes(v, hn::SetTableIndices(d, order)), d, to);
        return some;
    } else {
        return hn::CompressStore(v, mask, d, to);
    }
}

/// A point that looks for photons.
struct query {
    glm::vec3 at{0}, normal{0};
};

/// The photons of some rows of cells.
struct rows_found {
    std::vector<uint> first, past;
    std::size_t rows = 0;
};

/// As kernels::clamped_cell: truncation is rounding down once the number is not negative.
inline uint cell_at(float u, uint resolution)
{
    const float last = static_cast<float>(resolution - 1u);
    u = u > 0.0f ? u : 0.0f;
    u = u < last ? u : last;
    return std::min(static_cast<uint>(u), resolution - 1u);
}
inline glm::uvec2 cells_within(float x, float radius, float origin, float inverse_cell, uint resolution)
{
    return {cell_at(kernels::in_cells(x - radius, origin, inverse_cell), resolution), cell_at(kernels::in_cells(x + radius, origin, inverse_cell), resolution)};
}

/// The photons of every row of cells that can lie within radius2, as search_rows.glsl has it, 16 rows at a time.
HWY_INLINE void find_rows(const search_job& j, const glm::vec3& at, float radius2, rows_found& s)
{
    const grid& g = j.cells_of;
    const float radius = std::sqrt(radius2) * 1.00000095f + 1.1e-19f;
    const auto rows_y = cells_within(at.y, radius, g.origin.y, g.inverse_cell.y, g.resolution.y);
    const auto rows_z = cells_within(at.z, radius, g.origin.z, g.inverse_cell.z, g.resolution.z);
    const float u_y = kernels::in_cells(at.y, g.origin.y, g.inverse_cell.y), u_z = kernels::in_cells(at.z, g.origin.z, g.inverse_cell.z);
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
        // Indices within a slab of cells; of two words each, so a slab of 2^29 cells is the largest that a gather reaches.
        const auto* const slab = reinterpret_cast<const int*>(j.cells.data() + std::size_t{z} * g.resolution.y * g.resolution.x);
        for (uint y = rows_y.x; y <= rows_y.y; y += static_cast<uint>(width)) {
            const auto cell = hn::Add(hn::Set(di, static_cast<int>(y)), hn::Iota(di, 0));
            const auto v = hn::ConvertTo(d, cell), u = hn::Set(d, u_y);
            const auto margin = hn::Mul(hn::Add(hn::Add(v, hn::Abs(u)), hn::Set(d, 2.0f)), wide);
            const auto beyond = hn::Sub(hn::Sub(v, u), margin), before = hn::Sub(hn::Sub(u, hn::Add(v, hn::Set(d, 1.0f))), margin);
            const auto here = hn::Set(d, static_cast<float>(c_y));
            auto gap_y = hn::IfThenElseZero(hn::Gt(v, here), beyond);
            gap_y = hn::IfThenElse(hn::Lt(v, here), before, gap_y);
            gap_y = hn::Mul(hn::Max(gap_y, hn::Zero(d)), hn::Set(d, g.cell.y));
            const auto r2 = hn::Set(d, radius2);
            const auto left2 = hn::Add(hn::Sub(r2, hn::Add(hn::Mul(gap_y, gap_y), hn::Set(d, gap_z * gap_z))), hn::Mul(r2, wide));
            const auto reach = hn::Add(hn::Mul(hn::Sqrt(hn::Max(left2, hn::Zero(d))), hn::Set(d, 1.00000095f)), hn::Set(d, 1.1e-19f));
            const auto x = hn::Set(d, at.x);
            const auto row = hn::Mul(hn::Min(cell, hn::Set(di, static_cast<int>(g.resolution.y - 1u))), hn::Set(di, static_cast<int>(g.resolution.x)));
            const auto low = hn::Add(row, x_cell(hn::Sub(x, reach))), high = hn::Add(row, x_cell(hn::Add(x, reach)));
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

/// The photons near some queries, one after the other.
class packet {
public:
    enum plane { x, y, z, red, green, blue, travel_x, travel_y, travel_z, normal_x, normal_y, normal_z, squared_distance, kept, planes };

    std::size_t size() const { return size_; }
    float* of(plane p) const { return memory_ + p * stride_; }
    /// Places of photon i in the map.
    uint place(std::size_t i) const { return places_[i]; }

    /// Copies the photons within `reach` of `center`, and perhaps some that are a little farther. Returns how many it looked at.
    HWY_INLINE std::size_t fill(const search_job& j, const glm::vec3& center, float reach)
    {
        const floats d;
        const uints du;
        const std::size_t width = hn::Lanes(d);
        const float reach2 = reach * reach * 1.000004f + 1e-36f;
        find_rows(j, center, reach2, rows_);
        std::size_t n = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r)
            n += rows_.past[r] - rows_.first[r];
        make_room(n);
        const auto cx = hn::Set(d, center.x), cy = hn::Set(d, center.y), cz = hn::Set(d, center.z), within2 = hn::Set(d, reach2);
        std::size_t k = 0;
        for (std::size_t r = 0; r < rows_.rows; ++r) {
            const std::size_t past = rows_.past[r];
            for (std::size_t i = rows_.first[r]; i < past; i += width) {
                const auto px = hn::LoadU(d, j.positions.x + i), py = hn::LoadU(d, j.positions.y + i), pz = hn::LoadU(d, j.positions.z + i);
                const auto dx = hn::Sub(px, cx), dy = hn::Sub(py, cy), dz = hn::Sub(pz, cz);
                const auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
                const auto near = hn::And(hn::Le(d2, within2), hn::FirstN(d, past - i));
                const std::size_t some = store_some(d, px, near, of(x) + k);
                store_some(d, py, near, of(y) + k);
                store_some(d, pz, near, of(z) + k);
                const auto take = [&](plane p, const float* from) HWY_ATTR { store_some(d, hn::LoadU(d, from + i), near, of(p) + k); };
                take(red, j.powers.x); // for lists too: asking here costs estimates more than it saves them
                take(green, j.powers.y);
                take(blue, j.powers.z);
                if (j.side) {
                    take(travel_x, j.directions.x);
                    take(travel_y, j.directions.y);
                    take(travel_z, j.directions.z);
                }
                if (j.agreement) {
                    take(normal_x, j.normals.x);
                    take(normal_y, j.normals.y);
                    take(normal_z, j.normals.z);
                }
                store_some(du, hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)), hn::RebindMask(du, near), places_ + k);
                k += some;
            }
        }
        // What is read beyond the last is not near anything and weighs nothing.
        for (std::size_t i = k; i < k + lanes; ++i) {
            of(x)[i] = of(y)[i] = of(z)[i] = std::numeric_limits<float>::infinity();
            of(red)[i] = of(green)[i] = of(blue)[i] = 0;
        }
        size_ = k;
        return n;
    }

private:
    void make_room(std::size_t n)
    {
        constexpr std::size_t slack = 5 * lanes; // for what nth_smallest() writes past the end
        if (n + slack <= stride_)
            return;
        stride_ = plane_stride(2 * n + slack);
        block_ = storage((planes + 1) * stride_ * sizeof(float));
        memory_ = reinterpret_cast<float*>(block_.begin());
        places_ = reinterpret_cast<uint*>(memory_ + planes * stride_);
    }
    rows_found rows_;
    storage block_;
    float* memory_ = nullptr;
    uint* places_ = nullptr;
    std::size_t size_ = 0, stride_ = 0;
};

/// Writes the squared distance of every photon, as photon_distance.glsl has it: those that a policy rejects are farther than
/// any radius. Counts those within low2, and keeps the distances of those beyond it, high2 at most. Returns {counted, kept}.
/// POLICIES: 0 none, 1 the side of the surface, 2 any.
template <int POLICIES>
HWY_INLINE glm::uvec2 scan(const search_job& j, const query& q, float low2, float high2, const packet& near)
{
    const floats d;
    const std::size_t width = hn::Lanes(d), n = (near.size() + lanes - 1) / lanes * lanes; // with what is added up later
    const float *const px = near.of(packet::x), *const py = near.of(packet::y), *const pz = near.of(packet::z);
    float *const distances = near.of(packet::squared_distance), *const kept = near.of(packet::kept);
    const auto x = hn::Set(d, q.at.x), y = hn::Set(d, q.at.y), z = hn::Set(d, q.at.z);
    const auto nx = hn::Set(d, q.normal.x), ny = hn::Set(d, q.normal.y), nz = hn::Set(d, q.normal.z);
    const auto low = hn::Set(d, low2), high = hn::Set(d, high2);
    const auto smallest = hn::Set(d, std::numeric_limits<float>::min()), rejected = hn::Set(d, std::numeric_limits<float>::max());
    std::size_t counted = 0, k = 0;
    for (std::size_t i = 0; i < n; i += width) {
        const auto dx = hn::Sub(hn::Load(d, px + i), x), dy = hn::Sub(hn::Load(d, py + i), y), dz = hn::Sub(hn::Load(d, pz + i), z);
        auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
        const auto along_normal = [&](packet::plane v) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Load(d, near.of(v) + i), nx), hn::Mul(hn::Load(d, near.of(packet::plane(v + 1)) + i), ny)), hn::Mul(hn::Load(d, near.of(packet::plane(v + 2)) + i), nz));
        };
        if (POLICIES == 2 && j.flattening > 0) {
            const auto h = hn::Add(hn::Add(hn::Mul(dx, nx), hn::Mul(dy, ny)), hn::Mul(dz, nz));
            d2 = hn::Add(d2, hn::Mul(hn::Set(d, j.flattening), hn::Mul(h, h)));
        }
        d2 = hn::IfThenZeroElse(hn::Lt(d2, smallest), d2);
        if (POLICIES == 1 || (POLICIES == 2 && j.side))
            d2 = hn::IfThenElse(hn::Lt(along_normal(packet::travel_x), hn::Zero(d)), d2, rejected);
        if (POLICIES == 2 && j.agreement)
            d2 = hn::IfThenElse(hn::Ge(along_normal(packet::normal_x), hn::Set(d, j.min_cosine)), d2, rejected);
        hn::Store(d2, d, distances + i);
        const auto nearer = hn::Le(d2, low);
        counted += hn::CountTrue(d, nearer);
        k += store_some(d, d2, hn::AndNot(nearer, hn::Le(d2, high)), kept + k);
    }
    return {static_cast<uint>(counted), static_cast<uint>(k)};
}

/// The n-th smallest (from 1) of `count` numbers above low (or 0), high at most. They are expected to be spread evenly, so that
/// a few rounds of interpolation and counting find a number that n or n - 1 of them do not exceed. `values` is overwritten, also
/// four registers' width past its end.
HWY_INLINE float nth_smallest(float* values, std::size_t count, std::size_t n, float low, float high)
{
    const floats d;
    const std::size_t width = hn::Lanes(d), whole = (count + 4 * width - 1) / (4 * width) * (4 * width);
    for (std::size_t more = 0; more < 4; ++more)
        hn::StoreU(hn::Set(d, std::numeric_limits<float>::infinity()), d, values + count + more * width);
    std::size_t below = 0, up_to = count; // how many are low at most, high at most
    auto beyond = hn::Set(d, -1.0f);      // low, once some are below: squared distances are not negative
    for (int rounds = 0; below + 1 < n && n < up_to; ++rounds) {
        const float pivot = low + (high - low) * (static_cast<float>(n - below) / static_cast<float>(up_to - below + 1));
        if (rounds == 12 || !(pivot > low && pivot < high)) { // not spread evenly, or equal
            std::nth_element(values, values + (n - 1), values + count);
            return values[n - 1];
        }
        const auto p = hn::Set(d, pivot);
        std::size_t within = 0;
        for (std::size_t i = 0; i < whole; i += 4 * width) // four at a time: nearly always one or two rounds, easy to predict
            for (std::size_t v = 0; v < 4; ++v)
                within += hn::CountTrue(d, hn::Le(hn::LoadU(d, values + i + v * width), p));
        if (n <= within) {
            up_to = within;
            high = pivot;
        } else {
            below = within;
            low = pivot;
            beyond = p;
        }
    }
    if (n == up_to) { // the largest of these
        const auto h = hn::Set(d, high);
        auto largest = hn::Set(d, -1.0f);
        for (std::size_t i = 0; i < count; i += width) {
            const auto v = hn::LoadU(d, values + i);
            largest = hn::Max(largest, hn::IfThenElse(hn::Le(v, h), v, largest));
        }
        return hn::GetLane(hn::MaxOfLanes(d, largest));
    }
    auto smallest = hn::Set(d, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < count; i += width) {
        const auto v = hn::LoadU(d, values + i);
        smallest = hn::Min(smallest, hn::IfThenElse(hn::Gt(v, beyond), v, smallest));
    }
    return hn::GetLane(hn::MinOfLanes(d, smallest));
}

/// One sum in 16 lanes, whatever a register's width: a few terms in single precision, their sums in double.
class lane_sums {
    static constexpr std::size_t width = hn::MaxLanes(floats()), halves = width > 1 ? 2 : 1;
    using doubles = hn::CappedTag<double, std::max<std::size_t>(1, width / 2)>;
    vector few_[lanes / width];
    hn::VFromD<doubles> all_[halves * lanes / width];

public:
    HWY_INLINE lane_sums()
    {
        for (auto& l : few_)
            l = hn::Zero(floats());
        for (auto& l : all_)
            l = hn::Zero(doubles());
    }
    /// Adds to the lanes from group * width on.
    HWY_INLINE void add(std::size_t group, vector term) { few_[group] = hn::Add(few_[group], term); }
    /// After few terms.
    HWY_INLINE void flush()
    {
        const doubles d;
        for (std::size_t group = 0; group < lanes / width; ++group) {
#if HWY_TARGET == HWY_SCALAR // has no halves
            all_[group] = hn::Add(all_[group], hn::PromoteTo(d, few_[group]));
#else
            const hn::Half<floats> h;
            all_[2 * group] = hn::Add(all_[2 * group], hn::PromoteTo(d, hn::LowerHalf(h, few_[group])));
            all_[2 * group + 1] = hn::Add(all_[2 * group + 1], hn::PromoteTo(d, hn::UpperHalf(h, few_[group])));
#endif
            few_[group] = hn::Zero(floats());
        }
    }
    /// The sum and `more`. Lane l and lane l + 8, then these eight the same way, and so on: the same tree for every width.
    HWY_INLINE float total(double more) const
    {
        hn::VFromD<doubles> t[halves * lanes / width];
        std::copy(std::begin(all_), std::end(all_), t);
        for (std::size_t half = halves * lanes / width / 2; half > 0; half /= 2)
            for (std::size_t v = 0; v < half; ++v)
                t[v] = hn::Add(t[v], t[v + half]);
        return static_cast<float>(folded(doubles(), t[0]) + more);
    }

private:
    template <class D>
    static HWY_INLINE double folded([[maybe_unused]] D d, hn::VFromD<D> v)
    {
#if HWY_TARGET != HWY_SCALAR // has no halves
        if constexpr (hn::MaxLanes(d) > 1) {
            const hn::Half<D> h;
            return folded(h, hn::Add(hn::LowerHalf(h, v), hn::UpperHalf(h, v)));
        }
#endif
        return hn::GetLane(v);
    }

};

HWY_INLINE vector weight_of(filter_kernel kernel, vector t)
{
    const floats d;
    const auto one = hn::Set(d, 1.0f);
    switch (kernel) {
    case filter_kernel::cone: return hn::Sub(one, hn::Sqrt(t));
    case filter_kernel::epanechnikov: return hn::Sub(one, t);
    case filter_kernel::silverman: return hn::Mul(hn::Sub(one, t), hn::Sub(one, t));
    case filter_kernel::constant: break;
    }
    return one;
}
inline float weight_of(filter_kernel kernel, float t)
{
    switch (kernel) {
    case filter_kernel::cone: return 1.0f - std::sqrt(t);
    case filter_kernel::epanechnikov: return 1.0f - t;
    case filter_kernel::silverman: return (1.0f - t) * (1.0f - t);
    case filter_kernel::constant: break;
    }
    return 1.0f;
}

/// The radius that a search chose.
struct chosen_radius {
    float radius2 = 0;
    bool by_photon = false; ///< a photon set it; else it was given
};

/// What was added up.
struct gathered {
    glm::vec4 sum{0}, squares{0};
    uint held = 0;
};

/// Adds up the photons within the radius, as gather_photons.glsl, by the distances that scan() wrote.
template <bool ERRORS>
HWY_INLINE gathered gather(const search_job& j, chosen_radius r, const packet& near, std::vector<uint>& at_radius)
{
    const floats d;
    constexpr std::size_t width = hn::MaxLanes(d);
    constexpr std::size_t few = 8; // terms in single precision: an error of 2^-21 at most
    const std::size_t n = near.size();
    const float* const distances = near.of(packet::squared_distance);
    const float *const p_red = near.of(packet::red), *const p_green = near.of(packet::green), *const p_blue = near.of(packet::blue);
    const float inverse_disc2 = 1.0f / std::max(r.radius2, j.min_radius2);
    const auto radius2 = hn::Set(d, r.radius2), inverse = hn::Set(d, inverse_disc2), one = hn::Set(d, 1.0f);
    const filter_kernel kernel = j.kernel;
    lane_sums red, green, blue, red2, green2, blue2, all2;
    std::size_t within = 0, at_most = 0;
    for (std::size_t i = 0; i < n;) {
        for (const std::size_t stop = std::min(n, i + few * lanes); i < stop;)
            for (std::size_t group = 0; group < lanes / width; ++group, i += width) { // unrolled, so that sums stay in registers
                const auto d2 = hn::Load(d, distances + i);
                const auto nearer = hn::Lt(d2, radius2);
                within += hn::CountTrue(d, nearer);
                at_most += hn::CountTrue(d, hn::Le(d2, radius2));
                const auto weight = hn::IfThenElseZero(nearer, weight_of(kernel, hn::Min(hn::Mul(d2, inverse), one)));
                const auto r1 = hn::Mul(hn::Load(d, p_red + i), weight), g1 = hn::Mul(hn::Load(d, p_green + i), weight), b1 = hn::Mul(hn::Load(d, p_blue + i), weight);
                red.add(group, r1);
                green.add(group, g1);
                blue.add(group, b1);
                if (ERRORS) {
                    const auto all = hn::Add(hn::Add(r1, g1), b1);
                    red2.add(group, hn::Mul(r1, r1));
                    green2.add(group, hn::Mul(g1, g1));
                    blue2.add(group, hn::Mul(b1, b1));
                    all2.add(group, hn::Mul(all, all));
                }
            }
        red.flush();
        green.flush();
        blue.flush();
        if (ERRORS) {
            red2.flush();
            green2.flush();
            blue2.flush();
            all2.flush();
        }
    }

    // At the radius itself: as many as are still wanted, the smallest ids first; of these, the one that set the radius may be
    // left out.
    std::size_t counted = at_most - within;
    if (r.by_photon && at_most > j.wanted)
        counted = j.wanted - within;
    const bool apart = j.leave_out && r.by_photon && r.radius2 >= j.min_radius2;
    double extra[3] = {}, extra2[4] = {};
    if (counted > (apart ? 1u : 0u)) {
        const auto by_id = [&](uint a, uint b) { return j.list[near.place(a)] < j.list[near.place(b)]; };
        at_radius.clear();
        for (std::size_t i = 0; i < near.size(); ++i)
            if (distances[i] == r.radius2)
                at_radius.push_back(static_cast<uint>(i));
        std::partial_sort(at_radius.begin(), at_radius.begin() + static_cast<std::ptrdiff_t>(counted), at_radius.end(), by_id);
        const float at_rim = weight_of(kernel, std::min(r.radius2 * inverse_disc2, 1.0f));
        for (std::size_t i = 0; i + (apart ? 1 : 0) < counted; ++i) {
            const float f[3] = {p_red[at_radius[i]] * at_rim, p_green[at_radius[i]] * at_rim, p_blue[at_radius[i]] * at_rim};
            const float all = f[0] + f[1] + f[2];
            for (int c = 0; c < 3; ++c) {
                extra[c] += static_cast<double>(f[c]);
                extra2[c] += static_cast<double>(f[c] * f[c]);
            }
            extra2[3] += static_cast<double>(all * all);
        }
    }
    gathered g;
    g.sum = {red.total(extra[0]), green.total(extra[1]), blue.total(extra[2]), 0.0f};
    if (ERRORS)
        g.squares = {red2.total(extra2[0]), green2.total(extra2[1]), blue2.total(extra2[2]), all2.total(extra2[3])};
    g.held = static_cast<uint>(within + counted);
    return g;
}

/// Says that the list of a point has no more than its first `held` entries.
inline void end_list(const search_job& j, uint point, std::size_t held)
{
    const std::size_t first = std::size_t{point} * j.wanted;
    std::fill(j.ids + first + held, j.ids + first + j.wanted, nowhere);
    std::fill(j.distances2 + first + held, j.distances2 + first + j.wanted, std::numeric_limits<float>::infinity());
}

/// Lists the photons within the radius, nearest first, by the distances that scan() wrote. `keys` is scratch. Not inlined: sorting
/// would take registers from the search for estimates.
HWY_NOINLINE void list(const search_job& j, uint point, chosen_radius r, const packet& near, std::vector<std::uint64_t>& keys)
{
    const floats d;
    const uints du;
    const std::size_t width = hn::Lanes(d), n = near.size();
    const float* const distances = near.of(packet::squared_distance);
    // Where they stand in the packet.
    auto* const within = reinterpret_cast<uint*>(near.of(packet::kept));
    const auto radius2 = hn::Set(d, r.radius2);
    std::size_t held = 0;
    for (std::size_t i = 0; i < n; i += width) {
        const auto is_within = hn::And(hn::Le(hn::Load(d, distances + i), radius2), hn::FirstN(d, n - i));
        held += store_some(du, hn::Add(hn::Set(du, static_cast<uint>(i)), hn::Iota(du, 0)), hn::RebindMask(du, is_within), within + held);
    }
    // The bits of squared distances are in their order; the smallest ids come first.
    keys.resize(held);
    for (std::size_t i = 0; i < held; ++i)
        keys[i] = std::uint64_t{std::bit_cast<uint>(distances[within[i]])} << 32 | j.list[near.place(within[i])];
    std::sort(keys.begin(), keys.end());
    held = std::min<std::size_t>(held, j.wanted); // more lie at the radius itself
    uint* const ids = j.ids + std::size_t{point} * j.wanted;
    float* const distances2 = j.distances2 + std::size_t{point} * j.wanted;
    for (std::size_t i = 0; i < held; ++i) {
        ids[i] = static_cast<uint>(keys[i]);
        distances2[i] = std::bit_cast<float>(static_cast<uint>(keys[i] >> 32));
    }
    end_list(j, point, held);
}

/// A first guess at the k-th squared distance, from cell counts.
inline float guess(const search_job& j, uint point)
{
    kernels::kth_guess k;
    k.args = {.grid = j.cells_of, .wanted = j.wanted, .max_radius2 = j.max_radius2, .rows = 1023u, .searching = 1u};
    k.bind(slot<0>{}, std::span<const glm::vec4>(j.points + point, 1));
    k.bind(slot<1>{}, j.cells);
    k.kernel(0);
    return k.pivots.y;
}

/// Makes the estimate of what was gathered.
inline void finish(const search_job& j, uint point, chosen_radius r, const gathered& g, uint visited)
{
    const glm::vec4 reach(r.radius2, r.by_photon ? 1.0f : 0.0f, 0, 0);
    const glm::uvec4 tally(g.held, visited, 0, 0);
    kernels::irradiance_estimate e;
    e.args = {.norm = j.norm, .min_radius2 = j.min_radius2, .left_out = j.leave_out ? 1u : 0u};
    e.bind(slot<0>{}, std::span(&reach, 1));
    e.bind(slot<1>{}, std::span(&g.sum, 1));
    e.bind(slot<2>{}, std::span(&g.squares, 1));
    e.bind(slot<3>{}, std::span(&tally, 1));
    e.kernel(0);
    j.irradiance[point] = e.irradiance;
    j.used[point] = e.used;
    if (j.errors)
        j.standard_error[point] = e.standard_error;
}

inline float distance_between(const glm::vec3& a, const glm::vec3& b)
{
    const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

template <int POLICIES>
HWY_INLINE void search_points(const search_job& j, std::size_t begin, std::size_t end)
{
    constexpr float surplus = 0.06f; // that a packet reaches farther than the last query's k-th photon
    packet near;
    std::vector<uint> at_radius;
    std::vector<std::uint64_t> keys;
    query last;
    float last_radius = -1;     // distance of the last query's k-th photon; none: -1
    float expected = -1;        // this query's, where something better than the last is known
    const float max_radius = std::sqrt(j.max_radius2);
    float step = 0; // from one point to the next, on average
    for (std::size_t o = begin + 1; o < end; ++o)
        step += distance_between(glm::vec3(j.points[j.order[o - 1]]), glm::vec3(j.points[j.order[o]]));
    step /= static_cast<float>(std::max<std::size_t>(end - begin, 2) - 1);
    const auto is_wanted = [&](uint point) { return j.searching && j.points[point].w > 0.0f && kernels::is_finite(j.points[point]); };
    for (std::size_t o = begin; o < end;) {
        const uint first = j.order[o];
        if (!is_wanted(first)) {
            if (j.ids != nullptr)
                end_list(j, first, 0);
            else
                finish(j, first, {j.max_radius2, false}, {}, 0);
            ++o;
            continue;
        }
        bool guessed = false;
        if (!j.exact)
            expected = max_radius;
        else if (expected < 0 && last_radius > 0)
            expected = last_radius + std::min(surplus * last_radius, distance_between(glm::vec3(j.points[first]), last.at));
        else if (expected < 0) {
            expected = std::sqrt(1.3f * guess(j, first));
            guessed = true;
        }
        expected = std::min(expected, max_radius);

        // The packet: the next points, as long as they are close together. Copying has its cost, and so has every photon that is
        // too far for most of them: the least of both together lies where their spread goes with the power 2/3 of their step.
        const float relative_step = std::min(step / expected, 1.0f);
        const float widest = 2 * 1.4f * std::cbrt(relative_step * relative_step) * expected;
        glm::vec3 low(j.points[first]), high = low;
        std::size_t past = o + 1;
        for (; past < end; ++past) {
            const uint point = j.order[past];
            if (!is_wanted(point))
                break;
            const glm::vec3 l = glm::min(low, glm::vec3(j.points[point])), h = glm::max(high, glm::vec3(j.points[point]));
            if (!(distance_between(l, h) <= widest))
                break;
            low = l;
            high = h;
        }
        const glm::vec3 center = 0.5f * low + 0.5f * high;
        float reach = expected;
        for (std::size_t i = o; i < past; ++i)
            reach = std::max(reach, expected + distance_between(glm::vec3(j.points[j.order[i]]), center));
        uint visited = static_cast<uint>(near.fill(j, center, reach));

        const float begun_with = expected;
        expected = -1;
        for (; o < past; ++o) {
            const uint point = j.order[o];
            query q{glm::vec3(j.points[point]), glm::vec3(0)};
            if (POLICIES != 0)
                q.normal = glm::vec3(j.point_normals[point]);
            // All photons as near as this are in the packet.
            const float sure = std::max((reach - distance_between(q.at, center) * 1.000001f) * 0.999998f, 0.0f);
            const float sure2 = std::min(begun_with >= max_radius ? j.max_radius2 : sure * sure, j.max_radius2);
            chosen_radius r{j.max_radius2, false};
            float low2 = -1, high2 = sure2;
            if (j.exact && last_radius > 0 && (POLICIES == 0 || q.normal == last.normal)) {
                // The band, trusted only so far as to save time.
                float moved = distance_between(q.at, last.at);
                if (POLICIES == 2) {
                    const glm::vec3 move(q.at.x - last.at.x, q.at.y - last.at.y, q.at.z - last.at.z);
                    const float h = move.x * q.normal.x + move.y * q.normal.y + move.z * q.normal.z;
                    moved = std::sqrt(moved * moved + j.flattening * (h * h));
                }
                moved += 1e-6f * last_radius;
                if (moved < 0.5f * last_radius) {
                    low2 = (last_radius - moved) * (last_radius - moved);
                    high2 = std::min(sure2, (last_radius + moved) * (last_radius + moved));
                }
            }
            glm::uvec2 found = scan<POLICIES>(j, q, low2, high2, near);
            visited += static_cast<uint>(near.size());
            if (j.exact) {
                if (found.x >= j.wanted || (found.x + found.y < j.wanted && (low2 >= 0 || high2 < sure2))) {
                    low2 = -1;
                    high2 = sure2;
                    found = scan<POLICIES>(j, q, low2, high2, near);
                    visited += static_cast<uint>(near.size());
                }
                if (found.x + found.y >= j.wanted)
                    r = {nth_smallest(near.of(packet::kept), found.y, j.wanted - found.x, std::max(low2, 0.0f), high2), true};
                else if (sure2 < j.max_radius2) {
                    // The packet does not reach far enough: another from here on.
                    const float growth = 1.2f * static_cast<float>(j.wanted) / static_cast<float>(std::max(found.x + found.y, 1u));
                    expected = std::max(begun_with * std::sqrt(std::clamp(growth, 1.3f, 8.0f)), 1e-15f);
                    if (growth > 4 && !guessed)
                        expected = std::max(expected, std::sqrt(1.3f * guess(j, point)));
                    break;
                }
            }
            if (j.ids != nullptr)
                list(j, point, r, near, keys);
            else
                finish(j, point, r, j.errors ? gather<true>(j, r, near, at_radius) : gather<false>(j, r, near, at_radius), visited);
            visited = 0;
            last_radius = r.by_photon ? std::sqrt(r.radius2) : -1;
            last = q;
            if (j.exact && r.by_photon && last_radius < 0.6f * begun_with) {
                ++o;
                break; // this packet has far too many photons
            }
        }
    }
}

/// Searches for the points order[begin] to order[end - 1].
inline void search_block(const search_job& j, std::size_t begin, std::size_t end)
{
    if (j.flattening > 0 || j.agreement)
        search_points<2>(j, begin, end);
    else if (j.side)
        search_points<1>(j, begin, end);
    else
        search_points<0>(j, begin, end);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
