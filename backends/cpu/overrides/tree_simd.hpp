// SIMD code that searches a block map for one point at a time. Included once per instruction set, so it has no include
// guard; other files include simd.hpp.
//
// The search descends the tree of boxes, nearest box first, and scans the blocks that can hold one of the k nearest. It
// begins with a bound on the k-th distance: that of the point before, and the distance moved since. The photons within
// the bound are kept; when there are many more than k, the k-th of them becomes the bound.
#include <photongrid/backends/cpu/overrides/grow_simd.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The photons that a search of one point has found so far: `held`, with their squared distances.
template <int POLICIES>
class found_in_tree {
    const search_job& j_;
    packet& held_;
    const query_lanes q_;
    float bound2_;
    std::size_t limit_ = std::numeric_limits<std::size_t>::max(); ///< so many are held before the bound is reduced
    uint last_id_ = no_id; ///< photons at the bound are needed only with lesser ids
    uint visited_ = 0;

public:
    HWY_INLINE found_in_tree(const search_job& j, const query& at, float bound2, packet& held)
        : j_(j), held_(held), q_(at), bound2_(bound2)
    {
        if (j.search != search_kind::fixed_radius)
            limit_ = j.k + std::max<std::size_t>(lanes, j.k / 2);
        held_.clear();
        held_.reserve(lanes);
    }
    /// The squared distance beyond which no photon is needed.
    float bound2() const { return bound2_; }
    uint visited() const { return visited_; }

    /// Scans a block.
    HWY_INLINE void visit(uint block)
    {
        const floats d;
        const uints du;
        const uint first = block * kernels::BLOCK, n = std::min(j_.in_blocks - first, kernels::BLOCK);
        const auto within = hn::Set(d, bound2_);
        visited_ += n;
        auto found = held_.end();
        for (uint i = 0; i < n; i += static_cast<uint>(hn::Lanes(d))) {
            const auto d2 = squared_distances<POLICIES>(j_, q_, j_, first + i);
            auto some = hn::Le(d2, within);
            if (n < kernels::BLOCK)
                some = hn::And(some, hn::FirstN(d, n - i));
            if (last_id_ != no_id) {
                const auto lesser = hn::Lt(hn::LoadU(du, j_.list + first + i), hn::Set(du, last_id_));
                some = hn::And(some, hn::Or(hn::Lt(d2, within), hn::RebindMask(d, lesser)));
            }
            found.add(d2, some, first + i);
        }
        held_.take(found);
        held_.reserve(lanes);
        if (held_.size() >= limit_)
            reduce();
    }
    /// The k-th squared distance of at least k photons.
    HWY_INLINE float kth2() const
    {
        const float largest = held_.copy_distances();
        return nth_smallest(held_.of(packet::kept), held_.size(), j_.k, 0.0f, largest);
    }
    /// The squared radius of a search whose k-th squared distance is kth2.
    HWY_INLINE float radius2(float kth2) const
    {
        return j_.search == search_kind::at_least_k ? std::min(kernels::next_in_series(kth2), j_.max_radius2) : kth2;
    }

private:
    HWY_NOINLINE void reduce()
    {
        bound2_ = std::min(bound2_, radius2(kth2()));
        held_.keep(bound2_);
        last_id_ = no_id;
        if (j_.search == search_kind::exact_k && held_.size() > j_.k)
            last_id_ = held_.keep_least_ids(j_.list, bound2_, j_.k);
        limit_ = std::max(limit_, held_.size() + held_.size() / 2);
    }
};

/// Visits the blocks near the point.
template <class Found>
HWY_INLINE void visit_blocks(const search_job& j, const glm::vec3& at, Found& found)
{
    const floats d;
    struct siblings {
        HWY_ALIGN float near2[lanes]; ///< squared distances of the boxes that are still to visit
        uint node;                    ///< the first of them
    };
    siblings path[8];
    const uint last = j.levels - 1, first_block = kernels::first_of_level(last);
    const auto open = [&](uint node, uint level) HWY_ATTR {
        auto& s = path[level];
        s.node = node;
        for_each_box(
            j, node, {at, at}, [&](vector near2, std::size_t lane) HWY_ATTR { hn::Store(near2, d, s.near2 + lane); });
    };
    const auto far = hn::Set(d, std::numeric_limits<float>::infinity());
    // Takes the nearest of the boxes within the bound: its lane, or 16 if there is none.
    const auto take_nearest = [&](siblings& s) HWY_ATTR {
        auto nearest = hn::Load(d, s.near2);
        for (std::size_t lane = hn::Lanes(d); lane < lanes; lane += hn::Lanes(d))
            nearest = hn::Min(nearest, hn::Load(d, s.near2 + lane));
        const float near2 = hn::GetLane(hn::MinOfLanes(d, nearest));
        if (!(near2 <= found.bound2()))
            return static_cast<uint>(lanes);
        for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
            const auto v = hn::Load(d, s.near2 + lane);
            const auto n = hn::FindFirstTrue(d, hn::Eq(v, hn::Set(d, near2)));
            if (n >= 0) {
                hn::Store(hn::IfThenElse(hn::Eq(hn::Iota(d, 0), hn::Set(d, static_cast<float>(n))), far, v), d,
                    s.near2 + lane);
                return static_cast<uint>(lane) + static_cast<uint>(n);
            }
        }
        return static_cast<uint>(lanes);
    };
    open(0, 0);
    for (uint level = 0;;) {
        auto& s = path[level];
        const uint lane = take_nearest(s);
        if (lane == lanes) {
            if (level-- == 0)
                return;
            continue;
        }
        if (level < last) {
            open(kernels::first_child(s.node + lane), level + 1);
            ++level;
            continue;
        }
        found.visit(s.node - first_block + lane);
        for (std::size_t l = 0; l < lanes; l += hn::Lanes(d)) {
            const auto v = hn::Load(d, s.near2 + l);
            for (uint left = bits_of(d, hn::Le(v, hn::Set(d, found.bound2()))); left != 0; left &= left - 1) {
                const uint n = static_cast<uint>(l) + static_cast<uint>(std::countr_zero(left));
                if (s.near2[n] <= found.bound2())
                    found.visit(s.node - first_block + n);
            }
        }
        if (level-- == 0)
            return;
    }
}

/// The result of a search of one point.
struct tree_result {
    chosen_radius radius;
    float kth2 = -1; ///< squared distance of the k-th photon; none: -1
    uint visited = 0;
};

/// Finds the photons that the search of this point needs, and perhaps more. At least k of them are expected within
/// bound2; a wrong bound costs time only.
template <int POLICIES>
HWY_INLINE tree_result search_tree(const search_job& j, const query& q, float bound2, packet& held)
{
    tree_result r{{j.max_radius2, false}};
    for (;;) {
        found_in_tree<POLICIES> found(j, q, bound2, held);
        visit_blocks(j, q.at, found);
        r.visited += found.visited();
        if (j.search != search_kind::fixed_radius && held.size() >= j.k) {
            r.kth2 = found.kth2();
            r.radius = {found.radius2(r.kth2), j.search == search_kind::exact_k};
            return r;
        }
        if (j.search == search_kind::fixed_radius || bound2 >= j.max_radius2)
            return r;
        bound2 = j.max_radius2;
    }
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
