// Where to divide triangles to make a tree over them (triangle_tree.hpp): by the surface area heuristic (MacDonald and
// Booth, Heuristics for ray tracing using space subdivision, 1990), binned (Wald, On fast Construction of SAH-based
// Bounding Volume Hierarchies, 2007).
#pragma once

#include <photongrid/trace/tree_box.hpp>
#include <photongrid/trace/tree_node.kernel.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The shape of a tree.
struct tree_limits {
    uint deepest = kernels::DEEPEST_PAIR;      ///< pair
    uint most_in_leaf = kernels::MOST_IN_LEAF; ///< triangles
    std::size_t few = 6;                       ///< the most triangles of a leaf that could be split
    std::size_t whole = 1; ///< so many triangles are a leaf without a look at what it would cost to split them

    /// The most triangles that a subtree can hold if its first pair has this depth.
    std::uint64_t most_below(uint at) const
    {
        return at > deepest ? most_in_leaf : std::uint64_t{most_in_leaf} << (deepest + 1 - at);
    }
};

/// A triangle's box, and the halves of its index in the mesh as two floats. The index's bits as one float would
/// often be subnormal, and arithmetic on all lanes slow.
struct tree_item {
    least_box box;

    tree_item() = default;
    tree_item(const std::array<glm::vec3, 3>& corners, uint triangle) : box(least_box::of(corners[0]))
    {
        box.add(least_box::of(corners[1]));
        box.add(least_box::of(corners[2]));
        box.least[3] = static_cast<float>(triangle & 0xFFFFu);
        box.least[7] = static_cast<float>(triangle >> 16u);
    }
    uint triangle() const { return static_cast<uint>(box.least[3]) | static_cast<uint>(box.least[7]) << 16u; }
    /// Twice the middle of its box, m.
    least_box middle() const
    {
        least_box m;
        for (std::size_t i = 0; i < 4; ++i)
            m.least[i] = box.least[i] - box.least[4 + i];
        for (std::size_t i = 0; i < 4; ++i)
            m.least[4 + i] = box.least[4 + i] - box.least[i];
        return m;
    }
};

/// A range of items, to become a subtree.
struct tree_part {
    std::size_t first, past;
    least_box box = least_box::of_nothing(), middles = box; ///< of the items' boxes; of their middles

    std::size_t size() const { return past - first; }
    void add(const tree_item& x)
    {
        box.add(x.box);
        middles.add(x.middle());
    }
};

/// Divides parts of the items of a mesh.
class tree_splitter {
public:
    tree_splitter(tree_item* items, const tree_limits& limits) : items_(items), limits_(limits) {}

    /// Divides a part, whose items are ordered so that those of one half come first. Returns false if it is to
    /// be a leaf. `at`: depth of the pair that the halves would be.
    bool split(const tree_part& p, uint at, tree_part (&halves)[2]) const
    {
        if (p.size() <= limits_.whole || at > limits_.deepest)
            return false;
        const bins in(p);
        const plane best = best_plane(p, in);
        const double area = p.box.area();
        // A pair costs as much as the tests of three triangles.
        if (at > 0 && p.size() <= limits_.few && !(best.cost + 3 * area < static_cast<double>(p.size()) * area))
            return false;
        if (best.cost < std::numeric_limits<double>::max()) {
            // Without a branch, which processors would often predict wrongly.
            least_box middles[2] = {least_box::of_nothing(), least_box::of_nothing()};
            std::size_t past = p.first; // of the items of the first side
            for (std::size_t i = p.first; i < p.past; ++i) {
                const tree_item x = items_[i];
                const std::size_t side = in.of(x, best.axis) > static_cast<int>(best.bin) ? 1 : 0;
                middles[side].add(x.middle());
                items_[i] = items_[past];
                items_[past] = x;
                past += 1 - side;
            }
            halves[0] = {p.first, past, best.boxes[0], middles[0]};
            halves[1] = {past, p.past, best.boxes[1], middles[1]};
            if (std::max(halves[0].size(), halves[1].size()) <= limits_.most_below(at + 1))
                return true;
        }
        // No plane divides them, or the tree would become too deep: halves, by place, or by index at one place.
        tree_item *const begin = items_ + p.first, *const end = items_ + p.past, *const half = begin + p.size() / 2;
        std::nth_element(begin, half, end, [&](const tree_item& a, const tree_item& b) {
            const float x = a.middle().least[best.axis], y = b.middle().least[best.axis];
            return x < y || (x == y && a.triangle() < b.triangle());
        });
        const auto middle = static_cast<std::size_t>(half - items_);
        halves[0] = {p.first, middle};
        halves[1] = {middle, p.past};
        for (tree_part& h : halves)
            for (std::size_t i = h.first; i < h.past; ++i)
                h.add(items_[i]);
        return true;
    }

private:
    static constexpr std::size_t most_bins = 16;

    /// A split of a part by a plane between two bins.
    struct plane {
        double cost = std::numeric_limits<double>::max(); ///< triangles times area, summed over both sides, m^2
        std::size_t axis = 0;
        std::size_t bin = 0;     ///< the last one of the first side
        least_box boxes[2] = {}; ///< of both sides
    };
    /// The bins of a part along each axis, of equal width.
    struct bins {
        std::size_t count;
        std::array<float, 4> low;     ///< tree_item::middle() where the first bin starts
        std::array<float, 4> per_bin; ///< 1 / bin's width; 0 without width

        explicit bins(const tree_part& p) : count(p.size() <= 4 ? 4 : p.size() <= 32 ? 8 : most_bins)
        {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = p.middles.least[axis];
                per_bin[axis] = static_cast<float>(count) / (-p.middles.least[4 + axis] - low[axis]);
                if (!(per_bin[axis] > 0 && per_bin[axis] <= std::numeric_limits<float>::max()))
                    per_bin[axis] = 0; // or too little width to divide by
            }
            low[3] = per_bin[3] = 0;
        }
        /// Along each axis; the fourth has no meaning.
        std::array<int, 4> of(const tree_item& x) const
        {
            std::array<int, 4> n;
            for (std::size_t i = 0; i < 4; ++i)
                n[i] = of(x, i);
            return n;
        }
        /// Along one axis.
        int of(const tree_item& x, std::size_t i) const
        {
            const int last = static_cast<int>(count) - 1,
                      b = static_cast<int>((x.box.least[i] - x.box.least[4 + i] - low[i]) * per_bin[i]);
            return b < last ? b : last;
        }
    };

    /// The best plane for a part; its cost is the largest number if all middles are one point.
    plane best_plane(const tree_part& p, const bins& in) const
    {
        struct contents {
            least_box box;
            std::size_t held;
        };
        contents found[3][most_bins];
        for (auto& of_axis : found)
            std::fill_n(of_axis, in.count, contents{least_box::of_nothing(), 0});
        for (std::size_t i = p.first; i < p.past; ++i) {
            const tree_item& x = items_[i];
            const auto bin = in.of(x);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                contents& c = found[axis][static_cast<std::size_t>(bin[axis])];
                c.box.add(x.box);
                ++c.held;
            }
        }
        plane best;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (in.per_bin[axis] == 0)
                continue;
            std::array<double, most_bins> after; // cost of the bins from here on
            contents right{least_box::of_nothing(), 0};
            for (std::size_t b = in.count; b-- > 1;) {
                right.box.add(found[axis][b].box);
                right.held += found[axis][b].held;
                after[b] = static_cast<double>(right.held) * right.box.area();
            }
            contents left{least_box::of_nothing(), 0};
            for (std::size_t b = 0; b + 1 < in.count; ++b) {
                left.box.add(found[axis][b].box);
                left.held += found[axis][b].held;
                if (left.held == 0 || left.held == p.size())
                    continue;
                const double cost = static_cast<double>(left.held) * left.box.area() + after[b + 1];
                if (cost < best.cost) {
                    best.cost = cost;
                    best.axis = axis;
                    best.bin = b;
                }
            }
        }
        for (least_box& box : best.boxes)
            box = least_box::of_nothing();
        for (std::size_t b = 0; b < in.count; ++b)
            best.boxes[b > best.bin ? 1 : 0].add(found[best.axis][b].box);
        return best;
    }

    tree_item* items_;
    tree_limits limits_;
};

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
