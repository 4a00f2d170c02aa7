// SIMD code that finds the nearest photon of each point in a block map: exact_k with k = 1, without leak policies.
// Included once per instruction set, so it has no include guard; other files include simd.hpp.
//
// Consecutive points lie close together, so a group of them shares a walk through the tree. First each point of the
// group examines the two blocks at which the point before the group found its photon. The distances found there bound
// the walk, which finds the other blocks that any point of the group may need. Then each point examines those of them
// that are within its own distance.
#include <photongrid/backends/cpu/overrides/group_simd.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The nearest photon that the search of a point has found so far; of several at the same distance, that of the least
/// id.
class nearest_found {
    const search_job* j_ = nullptr;
    query at_;
    float distance2_ = 0;
    uint id_ = no_id, index_ = 0, visited_ = 0;

public:
    nearest_found() = default;
    HWY_INLINE nearest_found(const search_job& j, const query& at) : j_(&j), at_(at), distance2_(j.max_radius2) {}
    const glm::vec3& at() const { return at_.at; }
    bool any() const { return id_ != no_id; }
    uint id() const { return id_; }
    uint index() const { return index_; } ///< in the map
    uint visited() const { return visited_; }
    /// The squared distance of the photon, or the largest one allowed. No photon beyond it is needed.
    float bound2() const { return distance2_; }

    /// Examines a block.
    HWY_INLINE void visit(uint block) { visit<1>(block); }
    /// Examines a block and the one after it.
    HWY_INLINE void visit_two(uint block) { visit<2>(block); }

private:
    template <uint COUNT>
    HWY_INLINE void visit(uint block)
    {
        const floats d;
        constexpr std::size_t width = hn::MaxLanes(d);
        const uint first = block * kernels::BLOCK, past = std::min(first + COUNT * kernels::BLOCK, j_->in_blocks);
        const auto far = hn::Set(d, std::numeric_limits<float>::infinity());
        const query_lanes q(at_);
        visited_ += past - first;
        HWY_ALIGN float distances2[COUNT * kernels::BLOCK];
        auto least = far;
        for (std::size_t i = first, n = 0; i < past; i += width, n += width) {
            const auto d2 = hn::IfThenElse(hn::FirstN(d, past - i), squared_distances<0>(*j_, q, *j_, i), far);
            hn::Store(d2, d, distances2 + n);
            least = hn::Min(least, d2);
        }
        const float least2 = hn::GetLane(hn::MinOfLanes(d, least));
        if (!(least2 <= distance2_))
            return;
        if (least2 < distance2_)
            id_ = no_id;
        distance2_ = least2;
        for (std::size_t i = first, n = 0; i < past; i += width, n += width) {
            uint same = bits_of(d, hn::Eq(hn::Load(d, distances2 + n), hn::Set(d, least2)));
            for (; same != 0; same &= same - 1)
                take(static_cast<uint>(i) + static_cast<uint>(std::countr_zero(same)));
        }
    }
    void take(uint index)
    {
        const uint id = j_->list[index];
        if (id < id_) {
            id_ = id;
            index_ = index;
        }
    }
};

/// Stores what the search of a point has found.
HWY_INLINE void store_nearest(const search_job& j, uint point, const nearest_found& found)
{
    if (j.ids != nullptr) {
        j.ids[point] = found.id();
        j.distances2[point] = found.any() ? found.bound2() : std::numeric_limits<float>::infinity();
        return;
    }
    const chosen_radius r{found.bound2(), found.any()};
    finish(j, point, r, found.any() ? gather_one(j, point, r, found.index()) : gathered{}, found.visited());
}

/// Finds the nearest photons of the points order[begin] to order[end - 1].
HWY_NOINLINE inline void find_nearest(const search_job& j, std::size_t begin, std::size_t end)
{
    constexpr std::size_t most = 16;    // points of a group
    constexpr std::size_t many = 24;    // blocks that are too many for a group
    constexpr std::size_t ahead = most; // points to fetch ahead: in order, they are far apart in memory
    nearest_found group[most];
    uint points[most];
    near_blocks shared;
    std::size_t size = most; // of the next group
    bool is_known = false;
    uint known = 0; // a block near the next point, if is_known
    const auto fetch = [&](std::size_t first) HWY_ATTR {
        for (std::size_t i = first; i < std::min(first + ahead, end); ++i)
            hwy::Prefetch(j.points + j.order[i]);
    };
    fetch(begin);
    for (std::size_t o = begin; o < end;) {
        fetch(o + ahead);
        box_of_points box;
        float bound2 = 0;
        std::size_t n = 0;
        for (; n < size && o < end; ++o) {
            const uint point = j.order[o];
            if (!needs_estimate(j, point)) {
                store_nearest(j, point, nearest_found(j, {}));
                continue;
            }
            auto& found = group[n];
            found = {j, query_at<0>(j, point)};
            points[n++] = point;
            if (!is_known)
                known = block_near(j, found.at());
            is_known = true;
            found.visit_two(known);
            bound2 = std::max(bound2, found.bound2());
            box.add(found.at());
        }
        if (n == 0)
            return;
        const bool sharing = size > 1 && shared.find(j, box, bound2, known);
        for (std::size_t i = 0; i < n; ++i) {
            if (sharing)
                shared.visit(group[i].at(), group[i]);
            else
                visit_blocks(j, group[i].at(), group[i]);
            store_nearest(j, points[i], group[i]);
        }
        size = sharing && shared.size() <= many ? std::min(2 * size, most) : std::max<std::size_t>(size / 2, 1);
        is_known = group[n - 1].any();
        known = group[n - 1].index() / kernels::BLOCK;
    }
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
