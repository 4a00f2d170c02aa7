// A tree of boxes over the triangles of a mesh, built on the host: a bounding volume hierarchy with two children a
// node, split where the surface area heuristic says (MacDonald and Booth, Heuristics for ray tracing using space
// subdivision, 1990), binned (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).
#pragma once

#include <photongrid/scene/mesh.hpp>
#include <photongrid/trace/tree_node.kernel.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The records of a tree, as trace/tree_node.glsl describes them.
struct triangle_tree {
    std::vector<glm::uvec4> pairs;   ///< of nodes
    std::vector<glm::uvec4> corners; ///< of the triangles, in the order of the leaves
    uint depth = 0;                  ///< of the deepest pair; the first has 0
};

namespace detail {
    struct tree_box {
        glm::vec3 low{1e30f}, high{-1e30f}; ///< m; without contents no ray meets it

        void add(const tree_box& b)
        {
            low = glm::min(low, b.low);
            high = glm::max(high, b.high);
        }
        void add(const glm::vec3& p)
        {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        /// Half of the surface, m^2; 0 of a box without contents.
        double area() const
        {
            const glm::dvec3 e = glm::dvec3(high) - glm::dvec3(low);
            return e.x < 0 ? 0 : e.x * e.y + e.y * e.z + e.z * e.x;
        }
    };

    /// Builds a triangle_tree. The same mesh gives the same tree on every machine.
    class tree_builder {
    public:
        explicit tree_builder(const mesh& m) : mesh_(m)
        {
            for (std::size_t t = 0; t < m.triangles.size(); ++t) {
                item x{{}, static_cast<uint>(t)};
                for (const auto& c : corners_of(m, t))
                    x.box.add(c);
                items_.push_back(x);
            }
        }

        triangle_tree build()
        {
            tree_.pairs.reserve(items_.size() * kernels::PAIR_RECORDS / 2 + kernels::PAIR_RECORDS);
            const range all{0, items_.size()};
            // The first pair has no parent, whose split it would be: a tree of one leaf has an empty second child.
            const auto middle = split(all, box_of(all), 0);
            add_pair({all.first, middle}, {middle, all.past}, kernels::NO_PAIR, 0);
            for (const item& x : items_) {
                const auto corners = corners_of(mesh_, x.triangle);
                for (std::size_t c = 0; c < 3; ++c)
                    tree_.corners.push_back(bits_of(corners[c], c == 0 ? x.triangle : 0));
            }
            return std::move(tree_);
        }

    private:
        static constexpr std::size_t bins = 16;
        static constexpr std::size_t few = 4; ///< the most triangles of a leaf that could be split

        struct item {
            tree_box box;
            uint triangle;

            /// Twice the middle of its box along an axis, m.
            float middle(int axis) const { return box.low[axis] + box.high[axis]; }
        };
        struct range {
            std::size_t first, past; ///< of items_
            std::size_t size() const { return past - first; }
        };
        /// A split of a range by a plane between two bins.
        struct plane {
            double cost = std::numeric_limits<double>::max(); ///< triangles times area, summed over both sides, m^2
            int axis = 0;
            float low = 0, per_bin = 0; ///< item::middle of the first bin's start; 1 / bin's width
            std::size_t bin = 0;        ///< the last one of the first side

            std::size_t bin_of(const item& x) const
            {
                return std::min(static_cast<std::size_t>((x.middle(axis) - low) * per_bin), bins - 1);
            }
        };

        static glm::uvec4 bits_of(const glm::vec3& v, uint w)
        {
            return {std::bit_cast<uint>(v.x), std::bit_cast<uint>(v.y), std::bit_cast<uint>(v.z), w};
        }

        tree_box box_of(const range& r) const
        {
            tree_box b;
            for (std::size_t i = r.first; i < r.past; ++i)
                b.add(items_[i].box);
            return b;
        }

        /// The best plane for a range; its cost is the largest number if all middles are one point.
        plane best_plane(const range& r) const
        {
            tree_box middles;
            for (std::size_t i = r.first; i < r.past; ++i)
                middles.add(glm::vec3(items_[i].middle(0), items_[i].middle(1), items_[i].middle(2)));
            plane best;
            for (int axis = 0; axis < 3; ++axis) {
                plane p;
                p.axis = axis;
                p.low = middles.low[axis];
                p.per_bin = static_cast<float>(bins) / (middles.high[axis] - p.low);
                if (!(p.per_bin <= std::numeric_limits<float>::max()))
                    continue; // no width, or too little to divide by
                std::array<tree_box, bins> boxes;
                std::array<std::size_t, bins> counts{};
                for (std::size_t i = r.first; i < r.past; ++i) {
                    const std::size_t b = p.bin_of(items_[i]);
                    boxes[b].add(items_[i].box);
                    ++counts[b];
                }
                std::array<double, bins> after{}; // cost of the bins from here on
                tree_box right;
                std::size_t held = 0;
                for (std::size_t b = bins; b-- > 1;) {
                    right.add(boxes[b]);
                    held += counts[b];
                    after[b] = static_cast<double>(held) * right.area();
                }
                tree_box left;
                held = 0;
                for (std::size_t b = 0; b + 1 < bins; ++b) {
                    left.add(boxes[b]);
                    held += counts[b];
                    if (held == 0 || held == r.size())
                        continue;
                    p.cost = static_cast<double>(held) * left.area() + after[b + 1];
                    p.bin = b;
                    if (p.cost < best.cost)
                        best = p;
                }
            }
            return best;
        }

        /// The most triangles that a subtree can hold if its first pair has this depth.
        static std::uint64_t most_below(uint depth)
        {
            return depth > kernels::DEEPEST_PAIR
                ? kernels::MOST_IN_LEAF
                : std::uint64_t{kernels::MOST_IN_LEAF} << (kernels::DEEPEST_PAIR + 1 - depth);
        }

        /// Orders the items of a range so that those of one side come first. Returns where the others begin, or the
        /// range's end if it is to be a leaf. `box`: around the range; `depth`: of the pair that the sides would be.
        std::size_t split(const range& r, const tree_box& box, uint depth)
        {
            if (r.size() <= 1 || depth > kernels::DEEPEST_PAIR)
                return r.past;
            const plane p = best_plane(r);
            const double area = box.area();
            // A pair costs as much as the test of one triangle.
            if (depth > 0 && r.size() <= few && !(p.cost + area < static_cast<double>(r.size()) * area))
                return r.past;
            const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(r.first),
                       end = items_.begin() + static_cast<std::ptrdiff_t>(r.past);
            if (p.cost < std::numeric_limits<double>::max()) {
                const auto middle = std::partition(begin, end, [&](const item& x) { return p.bin_of(x) <= p.bin; });
                const auto held = static_cast<std::uint64_t>(std::max(middle - begin, end - middle));
                if (held <= most_below(depth + 1))
                    return static_cast<std::size_t>(middle - items_.begin());
            }
            // No plane divides them, or the tree would become too deep: halves, by place, or by index at one place.
            const auto half = begin + (end - begin) / 2;
            std::nth_element(begin, half, end, [&](const item& a, const item& b) {
                const float x = a.middle(p.axis), y = b.middle(p.axis);
                return x < y || (x == y && a.triangle < b.triangle);
            });
            return static_cast<std::size_t>(half - items_.begin());
        }

        uint add_pair(const range& first, const range& second, uint link, uint depth)
        {
            const auto pair = static_cast<uint>(tree_.pairs.size() / kernels::PAIR_RECORDS);
            tree_.depth = std::max(tree_.depth, depth);
            tree_.pairs.resize(tree_.pairs.size() + kernels::PAIR_RECORDS);
            uint children[2]{};
            const range sides[] = {first, second};
            for (uint side = 0; side < 2; ++side) {
                const range& r = sides[side];
                const tree_box b = box_of(r);
                const auto at = pair * kernels::PAIR_RECORDS + 2 * side;
                tree_.pairs[at] = bits_of(b.low, 0);
                tree_.pairs[at + 1] = bits_of(b.high, 0);
                const auto middle = split(r, b, depth + 1);
                children[side] = middle == r.past
                    ? kernels::leaf_of(
                        static_cast<uint>(r.first), static_cast<uint>(std::max<std::size_t>(r.size(), 1)))
                    : add_pair({r.first, middle}, {middle, r.past}, kernels::below_child(pair, side), depth + 1);
            }
            tree_.pairs[pair * kernels::PAIR_RECORDS].w = children[0];
            tree_.pairs[pair * kernels::PAIR_RECORDS + 1].w = children[1];
            tree_.pairs[pair * kernels::PAIR_RECORDS + 2].w = link;
            return pair;
        }

        const mesh& mesh_;
        std::vector<item> items_;
        triangle_tree tree_;
    };
} // namespace detail

namespace detail {
    /// \throws std::invalid_argument for more triangles than the leaves of a tree can number.
    inline void require_countable(std::size_t triangles)
    {
        if (triangles > 1u << 28)
            throw std::invalid_argument(
                "mesh: triangles: " + std::to_string(triangles) + "; a tree holds at most 2^28, so split the mesh");
    }
} // namespace detail

/// Builds the tree of a mesh.
/// \throws std::invalid_argument as check(mesh) does, or for more than 2^28 triangles.
inline triangle_tree build_triangle_tree(const mesh& m)
{
    check(m);
    detail::require_countable(m.triangles.size());
    return detail::tree_builder(m).build();
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
