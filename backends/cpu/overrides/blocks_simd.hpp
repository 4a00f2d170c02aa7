// SIMD code that finds the blocks of a block map near a point. Included once per instruction set, so it has no include
// guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/rows_simd.hpp>
#include <photongrid/map/block_tree.kernel.hpp>

#include <photongrid/backend/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The squared distances of `at` from the boxes of 16 siblings, the first of which is `node`, and from their farthest
/// corners: calls f(box_distance2, farthest_distance2, first lane) for each register of them.
template <class F>
HWY_INLINE void for_each_box(const search_job& j, uint node, const glm::vec3& at, const F& f)
{
    const floats d;
    const auto x = hn::Set(d, at.x), y = hn::Set(d, at.y), z = hn::Set(d, at.z), zero = hn::Zero(d);
    const std::size_t low = kernels::low_corner(node), high = kernels::high_corner(node);
    const auto sum = [&](vector dx, vector dy, vector dz)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)); };
    for (std::size_t lane = 0; lane < lanes; lane += hn::Lanes(d)) {
        const auto below = [&](const float* p, vector v) HWY_ATTR { return hn::Sub(hn::Load(d, p + low + lane), v); };
        const auto above = [&](const float* p, vector v) HWY_ATTR { return hn::Sub(v, hn::Load(d, p + high + lane)); };
        const auto bx = below(j.boxes.x, x), ax = above(j.boxes.x, x), by = below(j.boxes.y, y),
                   ay = above(j.boxes.y, y), bz = below(j.boxes.z, z), az = above(j.boxes.z, z);
        const auto near2
            = sum(hn::Max(hn::Max(bx, ax), zero), hn::Max(hn::Max(by, ay), zero), hn::Max(hn::Max(bz, az), zero));
        // A box of nothing has a square of infinity.
        const auto far2 = sum(hn::Min(bx, ax), hn::Min(by, ay), hn::Min(bz, az));
        f(hn::IfThenElseZero(hn::Ge(near2, hn::Set(d, std::numeric_limits<float>::min())), near2), far2, lane);
    }
}

/// Finds the photons of all blocks that can lie within radius2, in the order of the map. Neighbouring blocks give one
/// range.
inline void find_blocks(const search_job& j, const glm::vec3& at, float radius2, rows_found& s)
{
    const auto near = [&](uint node) HWY_ATTR {
        uint bits = 0;
        for_each_box(j, node, at, [&](vector d2, vector, std::size_t lane) HWY_ATTR {
            std::uint8_t of_register[8] = {};
            const floats d;
            hn::StoreMaskBits(d, hn::Le(d2, hn::Set(d, radius2)), of_register);
            bits |= (of_register[0] | static_cast<uint>(of_register[1]) << 8) << lane;
        });
        return bits;
    };
    struct {
        uint node, left; ///< the first of 16 siblings, and those that are still to visit, as bits
    } path[8];
    const uint first_block = kernels::first_of_level(j.levels - 1);
    std::size_t n = 0;
    uint depth = 0;
    path[0] = {0, near(0)};
    for (;;) {
        auto& here = path[depth];
        if (here.left == 0) {
            if (depth == 0)
                break;
            --depth;
            continue;
        }
        if (depth + 1 < j.levels) {
            const uint child = here.node + static_cast<uint>(std::countr_zero(here.left));
            here.left &= here.left - 1;
            ++depth;
            path[depth].node = kernels::first_child(child);
            path[depth].left = near(path[depth].node);
            continue;
        }
        if (s.first.size() < n + lanes) {
            s.first.resize(2 * n + lanes);
            s.past.resize(2 * n + lanes);
        }
        for (; here.left != 0; here.left &= here.left - 1) {
            const uint block = here.node - first_block + static_cast<uint>(std::countr_zero(here.left)),
                       first = block * kernels::BLOCK, past = std::min(first + kernels::BLOCK, j.in_blocks);
            if (n > 0 && s.past[n - 1] == first) {
                s.past[n - 1] = past;
            } else {
                s.first[n] = first;
                s.past[n++] = past;
            }
        }
    }
    s.rows = n;
}

/// Finds the photons that can lie within radius2, as ranges.
inline void find_photons(const search_job& j, const glm::vec3& at, float radius2, rows_found& s)
{
    if (j.levels > 0)
        find_blocks(j, at, radius2, s);
    else
        find_rows(j, at, radius2, s);
}

/// A guess at the k-th squared distance, as in guess_by_boxes.glsl; nearer boxes are visited first.
inline float guessed_by_boxes(const search_job& j, const glm::vec3& at)
{
    uint lowest = j.levels - 1;
    float share = static_cast<float>(j.k) / 16;
    for (; lowest > 0 && share > 4; --lowest)
        share /= 16;
    struct siblings {
        HWY_ALIGN float near2[lanes]; ///< squared distances of the boxes that are still to visit
        uint node;                    ///< the first of them
    };
    siblings path[8];
    float guess = std::numeric_limits<float>::max();
    const auto open = [&](uint node, uint level) HWY_ATTR {
        auto& s = path[level];
        s.node = node;
        for_each_box(j, node, at, [&](vector near2, vector far2, std::size_t lane) HWY_ATTR {
            const floats d;
            hn::Store(near2, d, s.near2 + lane);
            if (level == lowest) {
                const auto kth = hn::Add(hn::Mul(hn::Sub(far2, near2), hn::Set(d, 0.64f * share)), near2);
                guess = std::min(guess, hn::GetLane(hn::MinOfLanes(d, kth)));
            }
        });
    };
    open(0, 0);
    for (uint level = 0;;) {
        auto& s = path[level];
        auto* const nearest = std::min_element(s.near2, s.near2 + lanes);
        if (level == lowest || !(*nearest < guess)) {
            if (level-- == 0)
                return guess;
            continue;
        }
        *nearest = std::numeric_limits<float>::max();
        open(kernels::first_child(s.node + static_cast<uint>(nearest - s.near2)), level + 1);
        ++level;
    }
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/backend/exact_end.hpp>
