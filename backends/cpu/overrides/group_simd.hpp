// SIMD code that finds the blocks of a block map which a group of points shares. Included once per instruction set, so
// it has no include guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/tree_simd.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A block near a point: the one that a descent to the nearest box of each level reaches. Seldom not the nearest.
inline uint block_near(const search_job& j, const glm::vec3& at)
{
    const floats d;
    uint node = 0;
    for (uint level = 0;; ++level) {
        HWY_ALIGN float near2[lanes];
        for_each_box(j, node, {at, at}, [&](vector d2, std::size_t lane) HWY_ATTR { hn::Store(d2, d, near2 + lane); });
        node += static_cast<uint>(std::min_element(near2, near2 + lanes) - near2);
        if (level + 1 == j.levels)
            return node - kernels::first_of_level(level);
        node = kernels::first_child(node);
    }
}

/// Blocks that points of a group may need, with their boxes.
class near_blocks {
    static constexpr std::size_t most = 64;
    HWY_ALIGN float low_[3][most + lanes];
    HWY_ALIGN float high_[3][most + lanes];
    HWY_ALIGN uint blocks_[most + lanes];
    std::size_t size_ = 0;

public:
    std::size_t size() const { return size_; }

    /// Finds the blocks within bound2 of the points' box, except for `known` and the block after it. Returns false if
    /// there are too many to share.
    HWY_INLINE bool find(const search_job& j, const box_of_points& points, float bound2, uint known)
    {
        const floats d;
        size_ = 0;
        for_each_sixteen_blocks(j, points, bound2, [&](uint node) HWY_ATTR {
            add(j, node, points, hn::Set(d, bound2), known);
            return size_ <= most - lanes;
        });
        if (size_ > most - lanes)
            return false;
        // Pad with boxes of nothing.
        const auto largest = hn::Set(d, std::numeric_limits<float>::max());
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = size_; i < size_ + lanes; i += hn::Lanes(d)) {
                hn::StoreU(largest, d, low_[axis] + i);
                hn::StoreU(hn::Neg(largest), d, high_[axis] + i);
            }
        return true;
    }

    /// Visits the blocks within a point's bound.
    template <class Found>
    HWY_INLINE void visit(const glm::vec3& at, Found& found) const
    {
        const floats d;
        for (std::size_t i = 0; i < size_; i += hn::Lanes(d)) {
            const auto d2 = box_distances2(
                {at, at}, {low_[0] + i, low_[1] + i, low_[2] + i}, {high_[0] + i, high_[1] + i, high_[2] + i});
            uint left = bits_of(d, hn::Le(d2, hn::Set(d, found.bound2())));
            if (left == 0)
                continue;
            HWY_ALIGN float near2[lanes];
            hn::Store(d2, d, near2);
            for (; left != 0; left &= left - 1) {
                const auto n = static_cast<std::size_t>(std::countr_zero(left));
                if (near2[n] <= found.bound2())
                    found.visit(blocks_[i + n]);
            }
        }
    }

private:
    /// Adds those of 16 sibling blocks, the first of which is `node`.
    HWY_INLINE void add(const search_job& j, uint node, const box_of_points& points, vector within, uint known)
    {
        const floats d;
        const uints du;
        const uint first = node - kernels::first_of_level(j.levels - 1);
        const float* const corners[] = {j.boxes.x, j.boxes.y, j.boxes.z};
        for_each_box(j, node, points, [&](vector d2, std::size_t lane) HWY_ATTR {
            const auto blocks = hn::Add(hn::Set(du, first + static_cast<uint>(lane)), hn::Iota(du, 0));
            const auto is_new = hn::Gt(hn::Sub(blocks, hn::Set(du, known)), hn::Set(du, 1));
            const auto near = hn::And(hn::Le(d2, within), hn::RebindMask(d, is_new));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                store_some(d, hn::Load(d, corners[axis] + kernels::low_corner(node) + lane), near, low_[axis] + size_);
                store_some(
                    d, hn::Load(d, corners[axis] + kernels::high_corner(node) + lane), near, high_[axis] + size_);
            }
            size_ += store_some(du, blocks, hn::RebindMask(du, near), blocks_ + size_);
        });
    }
};

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
