// SIMD code that finds the hits of rays among triangles in a wide_tree. Included once per instruction set, so it has no
// include guard; other files include simd.hpp.
//
// The hits are the kernels', whose hits do not depend on the tree: a box is visited if the kernels' inside_box() says
// so, and sometimes if not, and the lanes only choose the triangles that hit_triangle() is then asked about.
#include <hwy/cache_control.h>

#include <photongrid/backends/cpu/overrides/ray_job.hpp>
#include <photongrid/backends/cpu/overrides/wide_tree.hpp>
#include <photongrid/core/vector.kernel.hpp>
#include <photongrid/trace/instance.kernel.hpp>
#include <photongrid/trace/ray_state.kernel.hpp>
#include <photongrid/trace/ray_tests.kernel.hpp>

#include <bit>
#include <optional>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using eight_floats = hn::CappedTag<float, wide>;
using eight_vector = hn::VFromD<eight_floats>;

/// A ray, for tests against eight boxes or triangles.
class wide_ray {
    kernels::Ray ray_;
    float origin_[3], inverse_[3];
    float slack_[3];                    ///< by so much boxes are enlarged, in lengths of the direction
    std::size_t enters_[3], leaves_[3]; ///< rows of a node: where the ray enters and leaves boxes along each axis
    std::size_t first_, second_, main_; ///< axes; the last is that of the direction's largest component
    float shear_[2];

public:
    /// `low`, `high`: box of all that it may meet.
    wide_ray(const glm::vec3& low, const glm::vec3& high, const glm::vec3& o, const glm::vec3& d)
        : ray_(kernels::ray_of(o, d))
    {
        const glm::vec3 far = glm::max(glm::abs(low - o), glm::abs(high - o));
        // inside_box() enlarges a box of the tree by at most half of this. The other half is 16 times what a distance
        // rounds by; the two tests differ by less than 5 times that.
        const float more = std::max(far.x, std::max(far.y, far.z)) * 0x1p-19f;
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const bool down = ray_.inverse[axis] < 0;
            origin_[a] = o[axis];
            inverse_[a] = ray_.inverse[axis];
            slack_[a] = more * std::abs(ray_.inverse[axis]);
            enters_[a] = down ? 3 + a : a;
            leaves_[a] = down ? a : 3 + a;
        }
        main_ = ray_.along.x != 0 ? 0 : ray_.along.y != 0 ? 1 : 2;
        first_ = main_ == 0 ? 1 : 0;
        second_ = main_ == 2 ? 1 : 2;
        shear_[0] = ray_.across_x[static_cast<int>(main_)];
        shear_[1] = ray_.across_y[static_cast<int>(main_)];
    }

    /// The children of a node whose boxes the ray meets before `closest`, as bits; stores where it enters them.
    HWY_INLINE uint meets(const float* node, float closest, float* entries) const
    {
        const eight_floats d;
        uint met = 0;
        for (std::size_t lane = 0; lane < wide; lane += hn::Lanes(d)) {
            auto enter = hn::Zero(d), leave = hn::Set(d, closest);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto origin = hn::Set(d, origin_[axis]), inverse = hn::Set(d, inverse_[axis]),
                           slack = hn::Set(d, slack_[axis]);
                const auto first = hn::Sub(hn::LoadU(d, node + enters_[axis] * wide + lane), origin),
                           last = hn::Sub(hn::LoadU(d, node + leaves_[axis] * wide + lane), origin);
                // In this order Max and Min ignore NaN, which is infinity less infinity where MulAdd rounds twice.
                enter = hn::Max(hn::MulSub(first, inverse, slack), enter);
                leave = hn::Min(hn::MulAdd(last, inverse, slack), leave);
            }
            hn::StoreU(enter, d, entries + lane);
            met |= bits_of(d, hn::Le(enter, leave)) << lane;
        }
        return met;
    }

    /// The triangles of a block that the ray's line does not pass by, as bits: those of which hit_triangle() does not
    /// see the line both to the left and to the right of an edge.
    HWY_INLINE uint passes_through(const float* block) const
    {
        const eight_floats d;
        uint through = 0;
        for (std::size_t lane = 0; lane < wide; lane += hn::Lanes(d)) {
            eight_vector x[3], y[3];
            for (std::size_t c = 0; c < 3; ++c) {
                const auto from = [&](std::size_t axis) HWY_ATTR {
                    return hn::Sub(hn::LoadU(d, block + (3 * c + axis) * wide + lane), hn::Set(d, origin_[axis]));
                };
                const auto main = from(main_);
                x[c] = hn::Add(hn::Mul(main, hn::Set(d, shear_[0])), from(first_));
                y[c] = hn::Add(hn::Mul(main, hn::Set(d, shear_[1])), from(second_));
            }
            auto left = hn::FirstN(d, 0), right = left;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t n = (c + 1) % 3;
                const auto forth = hn::Mul(x[c], y[n]), back = hn::Mul(x[n], y[c]);
                left = hn::Or(left, hn::Gt(forth, back));
                right = hn::Or(right, hn::Lt(forth, back));
            }
            through |= bits_of(d, hn::Not(hn::And(left, right))) << lane;
        }
        return through;
    }

    /// As hit_triangle() of the kernels, for a triangle of a block.
    float hit(const float* block, std::size_t triangle) const
    {
        return kernels::hit_triangle(
            corner(block, triangle, 0), corner(block, triangle, 1), corner(block, triangle, 2), ray_);
    }
    /// As is_behind() of the kernels.
    bool leaves(const glm::vec4& plane, const float* block, std::size_t triangle) const
    {
        return kernels::is_behind(
            plane, corner(block, triangle, 0), corner(block, triangle, 1), corner(block, triangle, 2), ray_);
    }

private:
    static glm::vec3 corner(const float* block, std::size_t triangle, std::size_t c)
    {
        const float* x = block + 3 * c * wide + triangle;
        return glm::vec3(x[0], x[wide], x[2 * wide]);
    }
};

/// The search for the hit of one ray: the closest, of several at one distance that with the least index, or any.
///
/// Above instances leaves are instances, and below them the ray is in the space of the surface, as in
/// trace/trace_ray.glsl.
class hit_search {
    struct entry {
        uint child;
        float enter; ///< where the ray enters its box
    };
    static constexpr uint nowhere = kernels::NO_INSTANCE;

    wide_ray ray_;            ///< in the space of what is visited
    const std::size_t index_; ///< of the ray
    uint instance_ = nowhere; ///< in which the search is
    std::size_t above_ = 0;   ///< so many entries were held when it entered
    uint first_id_ = 0;       ///< of the instance's triangles
    glm::vec2 inside_{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()}; ///< its box
    float closest_;
    uint triangle_ = kernels::NO_TRIANGLE;
    std::size_t held_ = 0;
    // To visit; the last comes first. Each node of the deepest path leaves at most seven children, and is below another
    // pair of the triangle_tree.
    entry left_[(wide - 1) * (kernels::DEEPEST_PAIR + 1) + 1];

public:
    hit_search(const ray_job& j, std::size_t i)
        : ray_(j.low, j.high, glm::vec3(j.origins[i]), glm::vec3(j.directions[i])), index_(i),
          closest_(kernels::distance_of_hit(j.states[i]))
    {
        left_[held_++] = {0, 0};
    }

    /// Visits the next node or block. Returns false if there is none: the search is complete.
    template <bool ANY>
    HWY_INLINE bool step(const ray_job& j)
    {
        const entry now = left_[--held_];
        if (kernels::is_leaf(now.child)) {
            if (is_above_instances(j)) {
                enter(j, kernels::first_of_leaf(now.child), now.enter);
            } else {
                visit_block(j, now.child);
                if (ANY && triangle_ != kernels::NO_TRIANGLE)
                    return false;
            }
        } else {
            visit_node<ANY>(node_of(j, now.child));
        }
        while (held_ > 0 && left_[held_ - 1].enter > closest_)
            --held_;
        if (instance_ != nowhere && held_ <= above_)
            leave(j);
        if (held_ == 0)
            return false;
        // Other rays are searched for until this is in the cache.
        const uint next = left_[held_ - 1].child;
        const float* first = !kernels::is_leaf(next) ? node_of(j, next)
            : is_above_instances(j)                  ? node_of(j, j.roots[kernels::first_of_leaf(next)].node)
                                                     : block_of(j, next);
        for (std::size_t row = 0; row < block_rows; row += 2) // two are a cache line; a node has fewer
            hwy::Prefetch(first + row * wide);
        return true;
    }
    /// Stores what was found.
    void store(const ray_job& j) const
    {
        j.states[index_] = kernels::ray_state(kernels::NO_PAIR, 0, closest_, triangle_);
    }

private:
    static const float* block_of(const ray_job& j, uint leaf)
    {
        return j.blocks + kernels::first_of_leaf(leaf) * std::size_t{block_rows * wide};
    }
    static const float* node_of(const ray_job& j, uint node) { return j.nodes + node * std::size_t{node_rows * wide}; }

    bool is_above_instances(const ray_job& j) const { return j.instances != nullptr && instance_ == nowhere; }

    /// Goes on in the space of an instance's surface.
    HWY_NOINLINE void enter(const ray_job& j, uint instance, float where)
    {
        const glm::uvec4* of = j.instances + instance * std::size_t{kernels::INSTANCE_RECORDS};
        const auto row = [&](std::size_t record) { return kernels::corner_of(of[record]); };
        const auto turned = [&](const glm::vec3& v) {
            return glm::vec3(kernels::dot3(row(0), v), kernels::dot3(row(1), v), kernels::dot3(row(2), v));
        };
        const glm::vec3 o(j.origins[index_]), d(j.directions[index_]);
        instance_ = instance;
        above_ = held_;
        first_id_ = of[kernels::ID_OF_INSTANCE].w;
        inside_ = kernels::inside_box(row(4), row(5), kernels::ray_of(o, d));
        const auto& root = j.roots[instance];
        ray_ = wide_ray(root.low, root.high, turned(o - row(3)), turned(d));
        left_[held_++] = {root.node, where};
    }
    HWY_NOINLINE void leave(const ray_job& j)
    {
        instance_ = nowhere;
        ray_ = wide_ray(j.low, j.high, glm::vec3(j.origins[index_]), glm::vec3(j.directions[index_]));
    }

    HWY_INLINE void visit_block(const ray_job& j, uint leaf)
    {
        const float* block = block_of(j, leaf);
        const glm::vec4* planes = j.planes + kernels::first_of_leaf(leaf) * wide;
        const uint all = (1u << (kernels::past_leaf(leaf) - kernels::first_of_leaf(leaf))) - 1; // its triangles
        for (uint some = ray_.passes_through(block) & all; some != 0; some &= some - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(some));
            const float t = ray_.hit(block, n);
            const uint index = first_id_ + std::bit_cast<uint>(block[row_of_indices * wide + n]);
            if (t >= std::numeric_limits<float>::min() && t >= inside_.x && t <= inside_.y
                && (t < closest_ || (t == closest_ && index < triangle_)) && !ray_.leaves(planes[n], block, n)) {
                closest_ = t;
                triangle_ = index;
            }
        }
    }

    template <bool ANY>
    HWY_INLINE void visit_node(const float* node)
    {
        HWY_ALIGN float entries[wide];
        const std::size_t begin = held_;
        for (uint met = ray_.meets(node, closest_, entries); met != 0; met &= met - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(met));
            const entry e{std::bit_cast<uint>(node[row_of_children * wide + n]), entries[n]};
            std::size_t at = held_++;
            for (; !ANY && at > begin && left_[at - 1].enter < e.enter; --at) // the nearest last
                left_[at] = left_[at - 1];
            left_[at] = e;
        }
    }
};

/// Finds the hits of rays: of several at a time, in turns, so that memory is awaited for one while another is tested.
template <bool ANY>
HWY_INLINE void trace_rays(const ray_job& j, std::size_t begin, std::size_t end)
{
    constexpr std::size_t most = 8; // four are slower, 16 no faster
    std::optional<hit_search> searches[most];
    std::size_t next = begin, searching = 0;
    const auto start = [&](std::optional<hit_search>& s) HWY_ATTR {
        while (next < end && kernels::pair_of(j.states[next]) == kernels::NO_PAIR)
            ++next;
        if (next == end)
            return false;
        s.emplace(j, next++);
        return true;
    };
    while (searching < most && start(searches[searching]))
        ++searching;
    while (searching > 0)
        for (std::size_t s = 0; s < searching;) {
            if (searches[s]->template step<ANY>(j)) {
                ++s;
                continue;
            }
            searches[s]->store(j);
            if (start(searches[s]))
                ++s;
            else if (s != --searching)
                searches[s].emplace(*searches[searching]);
        }
}
inline HWY_ATTR void trace_block(const ray_job& j, std::size_t begin, std::size_t end)
{
    if (j.any)
        trace_rays<true>(j, begin, end);
    else
        trace_rays<false>(j, begin, end);
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
