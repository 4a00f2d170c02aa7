// A tree of boxes over the triangles of a mesh, built on the host: a bounding volume hierarchy with two children a
// node, split where the surface area heuristic says (MacDonald and Booth, Heuristics for ray tracing using space
// subdivision, 1990), binned (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).
#pragma once

#include <photongrid/scene/mesh.hpp>
#include <photongrid/trace/tree_box.hpp>
#include <photongrid/trace/tree_node.kernel.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
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
    std::vector<glm::uvec4>
        instances{}; ///< of a tree of two levels (instance_tree.hpp), as trace/instance.glsl has them
};

namespace detail {
    /// The shape of a tree.
    struct tree_limits {
        uint deepest = kernels::DEEPEST_PAIR;      ///< pair
        uint most_in_leaf = kernels::MOST_IN_LEAF; ///< triangles
        std::size_t few = 6;                       ///< the most triangles of a leaf that could be split

        /// The most triangles that a subtree can hold if its first pair has this depth.
        std::uint64_t most_below(uint at) const
        {
            return at > deepest ? most_in_leaf : std::uint64_t{most_in_leaf} << (deepest + 1 - at);
        }
    };

    /// Builds a triangle_tree. The same mesh gives the same tree on every machine, with any number of threads.
    class tree_builder {
    public:
        explicit tree_builder(const mesh& m, const tree_limits& limits = {})
            : mesh_(m), limits_(limits), items_(m.triangles.size())
        {
        }

        /// `run(n, f)` calls f(i) for each i below n, in any order or at once.
        template <class Run>
        triangle_tree build(const Run& run)
        {
            const std::size_t n = items_.size();
            part all{0, n};
            for (std::size_t t = 0; t < n; ++t) {
                const auto c = corners_of(mesh_, t);
                items_[t] = item(c, static_cast<uint>(t));
                all.add(items_[t]);
            }
            // The upper part of the tree, then what is below it, in pieces.
            std::vector<piece> pieces;
            grower top{items_, limits_, std::max<std::size_t>(n / 32, 4096), &pieces};
            top.grow_root(all);
            std::vector<grower> below(pieces.size(), grower{items_, limits_});
            run(pieces.size(), [&](std::size_t i) { pieces[i].root = below[i].grow(pieces[i].of, pieces[i].depth); });

            triangle_tree tree{std::move(top.pairs), {}, top.depth};
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                append(tree, pieces[i], below[i].pairs);
                tree.depth = std::max(tree.depth, below[i].depth);
            }
            tree.corners.resize(n * kernels::TRIANGLE_RECORDS);
            constexpr std::size_t block = 65536;
            run((n + block - 1) / block, [&](std::size_t b) {
                for (std::size_t t = b * block; t < std::min(n, (b + 1) * block); ++t) {
                    const uint triangle = items_[t].triangle();
                    const auto corners = corners_of(mesh_, triangle);
                    for (std::size_t c = 0; c < 3; ++c)
                        tree.corners[t * kernels::TRIANGLE_RECORDS + c] = bits_of(corners[c], c == 0 ? triangle : 0);
                }
            });
            return tree;
        }

    private:
        static constexpr std::size_t most_bins = 16;

        /// A triangle's box, and the halves of its index in the mesh as two floats. The index's bits as one float would
        /// often be subnormal, and arithmetic on all lanes slow.
        struct item {
            least_box box;

            item() = default;
            item(const std::array<glm::vec3, 3>& corners, uint triangle) : box(least_box::of(corners[0]))
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
        struct part {
            std::size_t first, past;
            least_box box = least_box::of_nothing(), middles = box; ///< of the items' boxes; of their middles

            std::size_t size() const { return past - first; }
            void add(const item& x)
            {
                box.add(x.box);
                middles.add(x.middle());
            }
        };
        /// A part that another grower makes a subtree of.
        struct piece {
            part of;
            uint depth, above; ///< of its first pair; the pair and child that it is below
            uint root = 0;     ///< what it becomes, in the grower's own pairs
        };
        /// A split of a part by a plane between two bins.
        struct plane {
            double cost = std::numeric_limits<double>::max(); ///< triangles times area, summed over both sides, m^2
            std::size_t axis = 0;
            std::size_t bin = 0; ///< the last one of the first side
        };
        /// The bins of a part along each axis, of equal width.
        struct bins {
            std::size_t count;
            std::array<float, 4> low;     ///< item::middle() where the first bin starts
            std::array<float, 4> per_bin; ///< 1 / bin's width; 0 without width

            explicit bins(const part& p) : count(p.size() <= 4 ? 4 : p.size() <= 16 ? 8 : most_bins)
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
            std::array<int, 4> of(const item& x) const
            {
                const auto m = x.middle();
                const int last = static_cast<int>(count) - 1;
                std::array<int, 4> n;
                for (std::size_t i = 0; i < 4; ++i) {
                    const int b = static_cast<int>((m.least[i] - low[i]) * per_bin[i]);
                    n[i] = b < last ? b : last;
                }
                return n;
            }
        };

        static glm::uvec4 bits_of(const glm::vec3& v, uint w)
        {
            return {std::bit_cast<uint>(v.x), std::bit_cast<uint>(v.y), std::bit_cast<uint>(v.z), w};
        }

        /// Makes pairs of nodes of parts.
        struct grower {
            std::vector<item>& items;
            tree_limits limits;
            std::size_t size_of_piece = 0;        ///< parts of up to so many items are left to others ...
            std::vector<piece>* pieces = nullptr; ///< ... and added here; null: none is
            std::vector<glm::uvec4> pairs{};
            uint depth = 0; ///< of the deepest pair

            /// The first pair has no parent, whose split it would be: a tree of one leaf has an empty second child.
            void grow_root(const part& all)
            {
                part halves[2]{all, {all.past, all.past}};
                (void)split(all, 0, halves);
                add_pair(halves, 0);
            }

            /// The child that a part becomes: a leaf, or the pair of its halves, at that depth.
            uint grow(const part& p, uint at)
            {
                part halves[2]{};
                return split(p, at, halves) ? add_pair(halves, at)
                                            : kernels::leaf_of(static_cast<uint>(p.first),
                                                static_cast<uint>(std::max<std::size_t>(p.size(), 1)));
            }

        private:
            uint add_pair(const part (&halves)[2], uint at)
            {
                const auto pair = static_cast<uint>(pairs.size() / kernels::PAIR_RECORDS),
                           first = pair * kernels::PAIR_RECORDS;
                depth = std::max(depth, at);
                pairs.resize(pairs.size() + kernels::PAIR_RECORDS);
                for (uint side = 0; side < 2; ++side) {
                    const part& p = halves[side];
                    const uint above = kernels::below_child(pair, side);
                    const tree_box box = p.box.box();
                    pairs[first + 2 * side] = bits_of(box.low, pairs[first + 2 * side].w);
                    pairs[first + 2 * side + 1] = bits_of(box.high, pairs[first + 2 * side + 1].w);
                    if (pieces != nullptr && p.size() > 0 && p.size() <= size_of_piece) {
                        pieces->push_back({p, at + 1, above});
                        continue;
                    }
                    const uint child = grow(p, at + 1);
                    pairs[first + side].w = child;
                    if (!kernels::is_leaf(child))
                        pairs[child * kernels::PAIR_RECORDS + 2].w = above;
                }
                if (pair == 0)
                    pairs[2].w = kernels::NO_PAIR;
                return pair;
            }

            /// The best plane for a part; its cost is the largest number if all middles are one point.
            plane best_plane(const part& p, const bins& in) const
            {
                struct contents {
                    least_box box;
                    std::size_t held;
                };
                contents found[3][most_bins];
                for (auto& of_axis : found)
                    std::fill_n(of_axis, in.count, contents{least_box::of_nothing(), 0});
                for (std::size_t i = p.first; i < p.past; ++i) {
                    const item& x = items[i];
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
                        if (cost < best.cost)
                            best = {cost, axis, b};
                    }
                }
                return best;
            }

            /// Divides a part, whose items are ordered so that those of one half come first. Returns false if it is to
            /// be a leaf. `at`: depth of the pair that the halves would be.
            bool split(const part& p, uint at, part (&halves)[2])
            {
                if (p.size() <= 1 || at > limits.deepest)
                    return false;
                const bins in(p);
                const plane best = best_plane(p, in);
                const double area = p.box.area();
                // A pair costs as much as the tests of three triangles.
                if (at > 0 && p.size() <= limits.few && !(best.cost + 3 * area < static_cast<double>(p.size()) * area))
                    return false;
                if (best.cost < std::numeric_limits<double>::max()) {
                    halves[0] = {p.first, p.first};
                    halves[1] = {p.past, p.past};
                    while (halves[0].past < halves[1].first) {
                        item& x = items[halves[0].past];
                        if (static_cast<std::size_t>(in.of(x)[best.axis]) <= best.bin) {
                            halves[0].add(x);
                            ++halves[0].past;
                        } else {
                            halves[1].add(x);
                            std::swap(x, items[--halves[1].first]);
                        }
                    }
                    if (std::max(halves[0].size(), halves[1].size()) <= limits.most_below(at + 1))
                        return true;
                }
                // No plane divides them, or the tree would become too deep: halves, by place, or by index at one place.
                const auto begin = items.begin() + static_cast<std::ptrdiff_t>(p.first),
                           end = items.begin() + static_cast<std::ptrdiff_t>(p.past), half = begin + (end - begin) / 2;
                std::nth_element(begin, half, end, [&](const item& a, const item& b) {
                    const float x = a.middle().least[best.axis], y = b.middle().least[best.axis];
                    return x < y || (x == y && a.triangle() < b.triangle());
                });
                const auto middle = static_cast<std::size_t>(half - items.begin());
                halves[0] = {p.first, middle};
                halves[1] = {middle, p.past};
                for (part& h : halves)
                    for (std::size_t i = h.first; i < h.past; ++i)
                        h.add(items[i]);
                return true;
            }
        };

        /// Adds the pairs of a piece behind those of the tree.
        static void append(triangle_tree& tree, const piece& p, const std::vector<glm::uvec4>& pairs)
        {
            const auto offset = static_cast<uint>(tree.pairs.size() / kernels::PAIR_RECORDS);
            const auto moved = [&](uint child) { return kernels::is_leaf(child) ? child : child + offset; };
            tree.pairs.insert(tree.pairs.end(), pairs.begin(), pairs.end());
            for (std::size_t at = offset * kernels::PAIR_RECORDS; at < tree.pairs.size(); at += kernels::PAIR_RECORDS) {
                tree.pairs[at].w = moved(tree.pairs[at].w);
                tree.pairs[at + 1].w = moved(tree.pairs[at + 1].w);
                tree.pairs[at + 2].w = at == offset * kernels::PAIR_RECORDS
                    ? p.above
                    : kernels::below_child(
                        kernels::pair_above(tree.pairs[at + 2].w) + offset, kernels::child_above(tree.pairs[at + 2].w));
            }
            tree.pairs[kernels::pair_above(p.above) * kernels::PAIR_RECORDS + kernels::child_above(p.above)].w
                = moved(p.root);
        }

        const mesh& mesh_;
        tree_limits limits_;
        std::vector<item> items_;
    };

    /// \throws std::invalid_argument for more triangles than the leaves of a tree can number.
    inline void require_countable(std::size_t triangles)
    {
        if (triangles > 1u << 28)
            throw std::invalid_argument(
                "mesh: triangles: " + std::to_string(triangles) + "; a tree holds at most 2^28, so split the mesh");
    }

    template <class Run>
    triangle_tree build_triangle_tree(const mesh& m, const Run& run)
    {
        check(m);
        require_countable(m.triangles.size());
        return tree_builder(m).build(run);
    }

    /// Runs one after the other.
    inline constexpr auto run_in_turn = [](std::size_t n, const auto& f) {
        for (std::size_t i = 0; i < n; ++i)
            f(i);
    };
} // namespace detail

/// Builds the tree of a mesh.
/// \throws std::invalid_argument as check(mesh) does, or for more than 2^28 triangles.
inline triangle_tree build_triangle_tree(const mesh& m) { return detail::build_triangle_tree(m, detail::run_in_turn); }

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
