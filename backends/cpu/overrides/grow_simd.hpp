// SIMD code of the growing search (2.3, figure 6), at_least_k. Included once per instruction set, so it has no include
// guard; other files include simd.hpp.
//
// It visits the same photons in the same order as knn_visit.glsl, a register at a time. Before the k-th photon it takes
// all within the maximum radius; with the k-th the radius is set, and after that it takes all within the radius. So
// only the register with the k-th photon must be examined photon by photon.
#include <photongrid/backends/cpu/overrides/select_simd.hpp>
#include <photongrid/map/grid.kernel.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The photons found by one point's search. STORE: keep their distances, for weights that depend on the final radius;
/// else sum their powers at once.
template <int POLICIES, bool STORE>
class growth {
public:
    /// No photons yet. `store` is overwritten.
    HWY_INLINE growth(const search_job& j, const query& q, packet& store)
        : job_(j), query_(q), store_(store), limit2_(j.max_radius2)
    {
        store_.clear();
        farthest_ = hn::Zero(floats());
    }

    /// Squared distance beyond which photons are rejected.
    float limit2() const { return limit2_; }
    uint visited() const { return visited_; }
    /// The radius, after all photons that can lie within limit2() have been visited.
    chosen_radius chosen() const { return {limit2_, enough()}; }
    /// The sums, without STORE.
    HWY_INLINE gathered sum()
    {
        for (auto& s : sums_)
            s.flush();
        gathered g;
        g.sum = {sums_[0].total(0), sums_[1].total(0), sums_[2].total(0), 0.0f};
        g.held = static_cast<uint>(held_);
        return g;
    }

    /// Visits photons first to past - 1 of the map.
    HWY_INLINE void visit(std::size_t first, std::size_t past)
    {
        const floats d;
        constexpr std::size_t width = hn::MaxLanes(d);
        const photon_vectors photons{job_.positions, job_.directions, job_.normals};
        visited_ += static_cast<uint>(past - first);
        if (STORE)
            store_.reserve(past - first + lanes);
        auto stored = store_.end();
        for (std::size_t i = first; i < past;) {
            for (std::size_t group = 0; group < lanes / width;
                 ++group, i += width) { // unrolled, so that sums stay in registers
                const auto d2 = squared_distances<POLICIES>(job_, query_, photons, i);
                auto within = hn::And(hn::Le(d2, hn::Set(d, limit2_)), hn::FirstN(d, i < past ? past - i : 0));
                if (!enough())
                    within = grow(d2, within);
                if (STORE)
                    stored.add(d2, within, i);
                else
                    add(group, within, i);
                held_ += hn::CountTrue(d, within);
            }
            if (!STORE && ++terms_ == lane_sums::few) {
                terms_ = 0;
                for (auto& s : sums_)
                    s.flush();
            }
        }
        store_.take(stored);
    }

private:
    bool enough() const { return held_ >= job_.k; }

    /// The photons of a register that count, of those within the limit.
    HWY_INLINE hn::Mask<floats> grow(vector distances2, hn::Mask<floats> within)
    {
        const floats d;
        if (held_ + hn::CountTrue(d, within) >= job_.k)
            return end_growth(distances2, within);
        farthest_ = hn::Max(farthest_, hn::IfThenElseZero(within, distances2));
        return within;
    }
    /// The register with the k-th photon: the largest distance so far becomes the radius, which limits the photons
    /// after the k-th.
    HWY_NOINLINE hn::Mask<floats> end_growth(vector distances2, hn::Mask<floats> within)
    {
        const floats d;
        float distance2[lanes];
        hn::StoreU(
            hn::IfThenElse(within, distances2, hn::Set(d, std::numeric_limits<float>::infinity())), d, distance2);
        limit2_ = hn::GetLane(hn::MaxOfLanes(d, farthest_));
        std::size_t held = held_;
        for (std::size_t i = 0; held < job_.k; ++i) {
            if (distance2[i] > job_.max_radius2)
                continue;
            limit2_ = std::max(limit2_, distance2[i]);
            ++held;
        }
        return hn::Le(hn::LoadU(d, distance2), hn::Set(d, limit2_)); // photons before the k-th are within it too
    }
    /// Adds the powers of the photons of `within` in the register that begins at photon i.
    HWY_INLINE void add(std::size_t group, hn::Mask<floats> within, std::size_t i)
    {
        const floats d;
        sums_[0].add(group, hn::IfThenElseZero(within, hn::LoadU(d, job_.powers.x + i)));
        sums_[1].add(group, hn::IfThenElseZero(within, hn::LoadU(d, job_.powers.y + i)));
        sums_[2].add(group, hn::IfThenElseZero(within, hn::LoadU(d, job_.powers.z + i)));
    }

    const search_job& job_;
    query_lanes query_;
    packet& store_;
    lane_sums sums_[3]; ///< red, green, blue
    vector farthest_;   ///< largest squared distances per lane, before the k-th photon
    float limit2_;
    std::size_t held_ = 0;
    uint visited_ = 0, terms_ = 0;
};

/// The box of cells around a point's cell that extends by `ring` cells, clipped to the grid. Its surface is that ring.
struct ring_of_cells {
    glm::uvec4 c; ///< the point's own cell
    glm::vec3 u;  ///< the point, in cells
    uint ring = 0;
    glm::uvec3 low, high; ///< its lowest and highest cells
};

/// Rows of a ring, as many as a register has lanes.
struct ring_rows {
    struct ends { // one end cell of each row, or the whole row: its range of photons, and its squared distance
        int first[lanes], past[lanes];
        float away2[lanes];
        std::uint8_t some[8] = {};
        bool has(uint i) const { return (some[i / 8] >> i % 8 & 1) != 0; }
    };
    ends lower, upper;

    /// The rows that have photons within the limit, as bits.
    uint some() const
    {
        return static_cast<uint>(lower.some[0] | upper.some[0] | (lower.some[1] | upper.some[1]) << 8);
    }
};

/// Finds rows of a ring from row y of layer z on, y relative to the box, and moves y and z past them: the whole row on
/// a face of the box, else its two end cells, either of which may lie outside the grid.
HWY_NOINLINE inline ring_rows find_ring_rows(
    const search_job& j, const ring_of_cells& r, float within_limit2, uint& z, uint& y)
{
    const grid& g = j.cells_of;
    const floats d;
    const ints di;
    const auto every = [&](uint cells) HWY_ATTR { return hn::Set(di, static_cast<int>(cells)); };
    const auto gap2 = [](float u, uint c, uint cell, float size) {
        const float gap = kernels::gap(u, c, cell, size);
        return gap * gap;
    };
    const bool has_low = r.c.x >= r.ring, has_high = r.c.x + r.ring == r.high.x;
    const auto low_gap_x2 = hn::Set(d, gap2(r.u.x, r.c.x, r.low.x, g.cell.x)),
               high_gap_x2 = hn::Set(d, gap2(r.u.x, r.c.x, r.high.x, g.cell.x));
    // A register of rows spans up to 16 layers. Rows of several layers are processed together if gather indices, which
    // count 32-bit words and must be below 2^31, can address so many layers; a cell has two words.
    const std::size_t layer = std::size_t{g.resolution.y} * g.resolution.x;
    const bool together = layer < 1u << 26;
    const uint across = r.high.y - r.low.y + 1;
    const auto of_across = hn::Set(d, 1.0f / static_cast<float>(across));
    const uint left = together ? (r.high.z - z + 1) * across - y : across - y;
    const uint rows = std::min(left, static_cast<uint>(hn::Lanes(d)));
    // Lanes past the last row repeat it. Adding 1/2 makes the division safe against the reciprocal's rounding.
    const auto nth = hn::Min(hn::Add(every(y), hn::Iota(di, 0)), every(y + rows - 1));
    const auto layers = hn::ConvertTo(di, hn::Mul(hn::Add(hn::ConvertTo(d, nth), hn::Set(d, 0.5f)), of_across));
    const auto cell_y = hn::Add(hn::Sub(nth, hn::Mul(layers, every(across))), every(r.low.y)),
               cell_z = hn::Add(layers, every(z));
    const auto* const base = reinterpret_cast<const int*>(j.cells.data() + z * layer);
    for (y += rows; y >= across && z <= r.high.z; y -= across)
        ++z;

    ring_rows found;
    const auto gap_y = gaps(cell_y, r.u.y, r.c.y, g.cell.y), gap_z = gaps(cell_z, r.u.z, r.c.z, g.cell.z);
    const auto row2 = hn::Add(hn::Mul(gap_y, gap_y), hn::Mul(gap_z, gap_z)), limit2 = hn::Set(d, within_limit2);
    const auto within = hn::And(hn::FirstN(d, rows), hn::Le(row2, limit2));
    if (hn::AllFalse(d, within))
        return found;
    const auto at_distance = [&](hn::VFromD<ints> cell, uint c) HWY_ATTR {
        return hn::RebindMask(d, hn::Eq(hn::Abs(hn::Sub(cell, every(c))), every(r.ring)));
    };
    const auto whole = hn::Or(at_distance(cell_y, r.c.y), at_distance(cell_z, r.c.z));
    const auto row = hn::Mul(hn::Add(hn::Mul(layers, every(g.resolution.y)), cell_y), every(g.resolution.x));
    const auto low = hn::Add(row, every(r.low.x)), high = hn::Add(row, every(r.high.x));
    const auto find_ends = [&](ring_rows::ends& e, hn::VFromD<ints> from, hn::VFromD<ints> to, vector away2,
                               hn::Mask<floats> rows_within) HWY_ATTR {
        const auto twice_from = hn::Add(from, from), twice_to = hn::Add(to, to);
        const auto first = hn::GatherIndex(di, base, twice_from);
        const auto past = hn::Add(hn::GatherIndex(di, base, twice_to), hn::GatherIndex(di, base + 1, twice_to));
        hn::StoreU(first, di, e.first);
        hn::StoreU(past, di, e.past);
        hn::StoreU(away2, d, e.away2);
        hn::StoreMaskBits(
            d, hn::And(rows_within, hn::And(hn::Le(away2, limit2), hn::RebindMask(d, hn::Lt(first, past)))), e.some);
    };
    const auto whole_int = hn::RebindMask(di, whole);
    find_ends(found.lower, low, hn::IfThenElse(whole_int, high, low),
        hn::IfThenElse(whole, row2, hn::Add(row2, low_gap_x2)), has_low ? within : hn::And(within, whole));
    if (has_high)
        find_ends(found.upper, high, high, hn::Add(row2, high_gap_x2), hn::AndNot(whole, within));
    return found;
}

/// Visits a ring. A register's width of rows is tested at once, with the limit before the first of them. The limit only
/// shrinks, so rows that fail stay out; the others are tested again.
template <class Growth>
HWY_INLINE void visit_ring(const search_job& j, const ring_of_cells& r, Growth& found)
{
    for (uint z = r.low.z, y = 0; z <= r.high.z;) {
        const ring_rows rows = find_ring_rows(j, r, found.limit2(), z, y);
        for (uint some = rows.some(); some != 0; some &= some - 1) {
            const auto i = static_cast<uint>(std::countr_zero(some));
            for (const auto* const e : {&rows.lower, &rows.upper})
                if (e->has(i) && e->away2[i] <= found.limit2())
                    found.visit(static_cast<uint>(e->first[i]), static_cast<uint>(e->past[i]));
        }
    }
}

/// Visits rings of cells around a point, as knn_visit.glsl does, until no unexplored cell lies within the radius.
template <class Growth>
HWY_INLINE void visit_rings(const search_job& j, const glm::vec4& point, Growth& found)
{
    const grid& g = j.cells_of;
    const glm::uvec3 last = glm::uvec3(g.resolution) - 1u;
    ring_of_cells r;
    r.c = kernels::cell_coordinates(g, point);
    r.u = {kernels::in_cells(point.x, g.origin.x, g.inverse_cell.x),
        kernels::in_cells(point.y, g.origin.y, g.inverse_cell.y),
        kernels::in_cells(point.z, g.origin.z, g.inverse_cell.z)};
    for (;; ++r.ring) {
        const glm::uvec3 c(r.c);
        for (int axis = 0; axis < 3; ++axis) {
            r.low[axis] = c[axis] > r.ring ? c[axis] - r.ring : 0u;
            r.high[axis] = std::min(c[axis] + r.ring, last[axis]);
        }
        if (r.ring == 0) {
            const glm::uvec2 own = j.cells[kernels::cell_number(g, c.x, c.y, c.z)];
            found.visit(own.x, own.x + own.y);
        } else {
            visit_ring(j, r, found);
        }
        // Does any unexplored cell lie within the radius?
        float unexplored = std::numeric_limits<float>::max();
        for (int axis = 0; axis < 3; ++axis) {
            if (r.high[axis] < last[axis])
                unexplored = std::min(unexplored, kernels::gap(r.u[axis], c[axis], r.high[axis] + 1u, g.cell[axis]));
            if (r.low[axis] > 0u)
                unexplored = std::min(unexplored, kernels::gap(r.u[axis], c[axis], r.low[axis] - 1u, g.cell[axis]));
        }
        const bool everything = r.low == glm::uvec3(0u) && r.high == last;
        if (everything || unexplored * unexplored > found.limit2())
            return;
    }
}

/// Searches for the points order[begin] to order[end - 1].
template <int POLICIES>
HWY_NOINLINE void grow_points(const search_job& j, std::size_t begin, std::size_t end)
{
    const bool store = j.filter != filter_kind::constant || j.leave_out || j.errors || j.biases.bias != nullptr;
    packet held;
    result_scratch scratch;
    for (std::size_t o = begin; o < end; ++o) {
        const uint point = j.order[o];
        if (!needs_estimate(j, point)) {
            finish(j, point, {j.max_radius2, false}, {}, 0);
            continue;
        }
        const query q = query_at<POLICIES>(j, point);
        if (!store) {
            growth<POLICIES, false> found(j, q, held);
            visit_rings(j, j.points[point], found);
            finish(j, point, found.chosen(), found.sum(), found.visited());
            continue;
        }
        growth<POLICIES, true> found(j, q, held);
        visit_rings(j, j.points[point], found);
        held.fetch_powers(j);
        store_result(j, point, found.chosen(), held, found.visited(), scratch);
    }
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
