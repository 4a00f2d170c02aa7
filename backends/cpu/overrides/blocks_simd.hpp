// SIMD code that finds the blocks of a block map near a point. Included once per instruction set, so it has no include
// guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/rows_simd.hpp>
#include <photongrid/map/block_tree.kernel.hpp>

#include <bit>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A box around points, or a single point.
struct box_of_points {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};

    void add(const glm::vec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

/// The squared distances of a box of points from a register of boxes. `lows`, `highs`: where their corners' x, y and z
/// are. A box of nothing is infinitely far. No point of the box of points is nearer to such a box, rounding included:
/// each step here rounds a number that is not larger in the same way (block_tree.glsl).
HWY_INLINE vector box_distances2(
    const box_of_points& p, const soa_vectors<const float>& lows, const soa_vectors<const float>& highs)
{
    const floats d;
    const auto apart = [&](const float* low, const float* high, float p_low, float p_high) HWY_ATTR {
        const auto below = hn::Sub(hn::Load(d, low), hn::Set(d, p_high)),
                   above = hn::Sub(hn::Set(d, p_low), hn::Load(d, high));
        return hn::Max(hn::Max(below, above), hn::Zero(d));
    };
    const auto x = apart(lows.x, highs.x, p.low.x, p.high.x), y = apart(lows.y, highs.y, p.low.y, p.high.y),
               z = apart(lows.z, highs.z, p.low.z, p.high.z);
    const auto d2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    return hn::IfThenElseZero(hn::Ge(d2, hn::Set(d, std::numeric_limits<float>::min())), d2);
}

/// The squared distances of a box of points from the boxes of 16 siblings, the first of which is `node`: calls
/// f(squared distances, first lane) for each register of them.
template <class F>
HWY_INLINE void for_each_box(const search_job& j, uint node, const box_of_points& p, const F& f)
{
    const std::size_t low = kernels::low_corner(node), high = kernels::high_corner(node);
    for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(floats()))
        f(box_distances2(p, {j.boxes.x + low + lane, j.boxes.y + low + lane, j.boxes.z + low + lane},
              {j.boxes.x + high + lane, j.boxes.y + high + lane, j.boxes.z + high + lane}),
            lane);
}

/// Those of 16 siblings, the first of which is `node`, whose boxes are within radius2 of a box of points, as bits.
HWY_INLINE uint siblings_near(const search_job& j, uint node, const box_of_points& p, float radius2)
{
    const floats d;
    uint bits = 0;
    for_each_box(j, node, p,
        [&](vector d2, std::size_t lane) HWY_ATTR { bits |= bits_of(d, hn::Le(d2, hn::Set(d, radius2))) << lane; });
    return bits;
}

/// Calls f(node) for all 16 sibling blocks, the first of which is `node`, that can be within radius2 of a box of
/// points, in the order of the map, until f returns false.
template <class F>
HWY_INLINE void for_each_sixteen_blocks(const search_job& j, const box_of_points& p, float radius2, const F& f)
{
    if (j.levels == 1) {
        f(0u);
        return;
    }
    struct {
        uint node, left; ///< the first of 16 siblings, and those that are still to visit, as bits
    } path[8];
    path[0] = {0, siblings_near(j, 0, p, radius2)};
    for (uint depth = 0;;) {
        auto& here = path[depth];
        if (here.left == 0) {
            if (depth-- == 0)
                return;
            continue;
        }
        const uint child = kernels::first_child(here.node + static_cast<uint>(std::countr_zero(here.left)));
        here.left &= here.left - 1;
        if (depth + 2 < j.levels)
            path[++depth] = {child, siblings_near(j, child, p, radius2)};
        else if (!f(child))
            return;
    }
}

/// Finds the photons of all blocks that can lie within radius2, in the order of the map, or stops when they are more
/// than `most`. Neighbouring blocks give one range.
inline void find_blocks(const search_job& j, const glm::vec3& at, float radius2, std::size_t most, rows_found& s)
{
    const uint first_block = kernels::first_of_level(j.levels - 1);
    std::size_t n = 0, held = 0;
    for_each_sixteen_blocks(j, {at, at}, radius2, [&](uint node) HWY_ATTR {
        if (s.first.size() < n + lanes) {
            s.first.resize(2 * n + lanes);
            s.past.resize(2 * n + lanes);
        }
        for (uint left = siblings_near(j, node, {at, at}, radius2); left != 0; left &= left - 1) {
            const uint block = node - first_block + static_cast<uint>(std::countr_zero(left)),
                       first = block * kernels::BLOCK, past = std::min(first + kernels::BLOCK, j.in_blocks);
            held += past - first;
            if (n > 0 && s.past[n - 1] == first) {
                s.past[n - 1] = past;
            } else {
                s.first[n] = first;
                s.past[n++] = past;
            }
        }
        return held <= most;
    });
    s.rows = n;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
