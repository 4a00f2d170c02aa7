// A tree of boxes over the triangles of a mesh, built on the host: a bounding volume hierarchy with two children a
// node, divided where tree_split.hpp says.
#pragma once

#include <photongrid/scene/mesh.hpp>
#include <photongrid/trace/tree_box.hpp>
#include <photongrid/trace/tree_node.kernel.hpp>
#include <photongrid/trace/tree_split.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The records of a tree, as trace/tree_node.glsl describes them.
struct triangle_tree {
    std::vector<glm::uvec4> pairs;   ///< of nodes
    std::vector<glm::uvec4> corners; ///< of the triangles, in the order of the leaves
    std::vector<glm::vec4> planes;   ///< of the triangles, in the same order
    uint depth = 0;                  ///< of the deepest pair; the first has 0
    std::vector<glm::uvec4>
        instances{}; ///< of a tree of two levels (instance_tree.hpp), as trace/instance.glsl has them
};

namespace detail {
    /// The plane of a triangle, rounded from double precision: its unit normal, its offset. 0 if the triangle is so
    /// thin that rounding in double precision may tilt its plane by more than in single precision.
    inline glm::vec4 plane_of(const std::array<glm::vec3, 3>& corners)
    {
        const glm::dvec3 a(corners[0]), ab = glm::dvec3(corners[1]) - a, ac = glm::dvec3(corners[2]) - a,
                                        n = glm::cross(ab, ac);
        const double size = glm::length(n);
        if (!(size > 0x1p-28 * glm::length(ab) * glm::length(ac)))
            return glm::vec4(0);
        return {glm::vec3(n / size), static_cast<float>(glm::dot(n, a) / size)};
    }

    /// Builds a triangle_tree. The same mesh gives the same tree on every machine, with any number of threads.
    class tree_builder {
    public:
        explicit tree_builder(const mesh& m, const tree_limits& limits = {})
            : mesh_(m), limits_(limits), items_(std::make_unique_for_overwrite<tree_item[]>(m.triangles.size()))
        {
        }

        /// `run(n, f)` calls f(i) for each i below n, in any order or at once.
        template <class Run>
        triangle_tree build(const Run& run)
        {
            const std::size_t n = mesh_.triangles.size(), most_in_piece = std::max<std::size_t>(n / 32, 4096);
            const tree_part all = make_items(run);
            const tree_splitter by(items_.get(), limits_);
            grower top{by};
            std::vector<piece> pieces;
            if (n <= most_in_piece)
                top.grow_root(all);
            else
                pieces = split_large(top, all, most_in_piece, run);
            std::vector<grower> below(pieces.size(), grower{by});
            triangle_tree tree;
            run(pieces.size() + 1, [&](std::size_t i) {
                if (i == 0) { // much new memory, which takes its time
                    tree.corners.resize(n * kernels::TRIANGLE_RECORDS);
                    tree.planes.resize(n);
                } else
                    pieces[i - 1].root = below[i - 1].grow(pieces[i - 1].of, pieces[i - 1].depth);
            });
            tree.pairs = std::move(top.pairs);
            tree.depth = top.depth;
            std::size_t pairs = tree.pairs.size();
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                pieces[i].first_pair = static_cast<uint>(pairs / kernels::PAIR_RECORDS);
                pairs += below[i].pairs.size();
                tree.depth = std::max(tree.depth, below[i].depth);
            }
            tree.pairs.resize(pairs);
            run(pieces.size(), [&](std::size_t i) { put(tree, pieces[i], below[i].pairs); });
            for_blocks(run, [&](std::size_t first, std::size_t past) {
                for (std::size_t t = first; t < past; ++t) {
                    const uint triangle = items_[t].triangle();
                    const auto corners = corners_of(mesh_, triangle);
                    for (std::size_t c = 0; c < 3; ++c)
                        tree.corners[t * kernels::TRIANGLE_RECORDS + c] = bits_of(corners[c], c == 0 ? triangle : 0);
                    tree.planes[t] = plane_of(corners);
                }
            });
            return tree;
        }

    private:
        static constexpr std::size_t per_block = 65536;

        /// Calls f(first, past) for blocks of triangles.
        template <class Run, class F>
        void for_blocks(const Run& run, const F& f) const
        {
            const std::size_t n = mesh_.triangles.size();
            run((n + per_block - 1) / per_block,
                [&](std::size_t b) { f(b * per_block, std::min(n, (b + 1) * per_block)); });
        }

        /// A part that is still to become a subtree.
        struct piece {
            tree_part of;
            uint depth, above;   ///< of its first pair; the pair and child that it is below
            uint root = 0;       ///< what it becomes, in its grower's own pairs
            uint first_pair = 0; ///< where these are in the tree
        };
        static glm::uvec4 bits_of(const glm::vec3& v, uint w)
        {
            return {std::bit_cast<uint>(v.x), std::bit_cast<uint>(v.y), std::bit_cast<uint>(v.z), w};
        }

        /// Makes pairs of nodes of parts.
        struct grower {
            tree_splitter by;
            std::vector<glm::uvec4> pairs{};
            uint depth = 0; ///< of the deepest pair

            /// The first pair has no parent, whose split it would be: a tree of one leaf has an empty second child.
            void grow_root(const tree_part& all)
            {
                tree_part halves[2]{all, {all.past, all.past}};
                (void)by.split(all, 0, halves);
                grow_pair(halves, 0);
                pairs[2].w = kernels::NO_PAIR;
            }

            /// The child that a part becomes: a leaf, or the pair of its halves, at that depth.
            uint grow(const tree_part& p, uint at)
            {
                tree_part halves[2]{};
                return by.split(p, at, halves) ? grow_pair(halves, at)
                                               : kernels::leaf_of(static_cast<uint>(p.first),
                                                   static_cast<uint>(std::max<std::size_t>(p.size(), 1)));
            }

            /// Adds a pair with the boxes of both halves and no children.
            uint add_pair(const tree_part (&halves)[2], uint at)
            {
                const auto pair = static_cast<uint>(pairs.size() / kernels::PAIR_RECORDS);
                depth = std::max(depth, at);
                for (const tree_part& p : halves) {
                    const tree_box box = p.box.box();
                    pairs.push_back(bits_of(box.low, 0));
                    pairs.push_back(bits_of(box.high, 0));
                }
                return pair;
            }
            void link(uint pair, uint side, uint child)
            {
                pairs[pair * kernels::PAIR_RECORDS + side].w = child;
                if (!kernels::is_leaf(child))
                    pairs[child * kernels::PAIR_RECORDS + 2].w = kernels::below_child(pair, side);
            }

        private:
            uint grow_pair(const tree_part (&halves)[2], uint at)
            {
                const uint pair = add_pair(halves, at);
                for (uint side = 0; side < 2; ++side)
                    link(pair, side, grow(halves[side], at + 1));
                return pair;
            }
        };

        /// Makes an item of each triangle. Returns the part of all.
        template <class Run>
        tree_part make_items(const Run& run)
        {
            const std::size_t n = mesh_.triangles.size();
            std::vector<tree_part> blocks((n + per_block - 1) / per_block, tree_part{0, n});
            for_blocks(run, [&](std::size_t first, std::size_t past) {
                tree_part& block = blocks[first / per_block];
                for (std::size_t t = first; t < past; ++t) {
                    items_[t] = tree_item(corners_of(mesh_, t), static_cast<uint>(t));
                    block.add(items_[t]);
                }
            });
            tree_part all{0, n};
            for (const tree_part& block : blocks) {
                all.box.add(block.box);
                all.middles.add(block.middles);
            }
            return all;
        }

        /// Makes the upper pairs of the tree: splits parts of more than `most` items, all of one level at once. Returns
        /// the smaller parts that are left.
        template <class Run>
        static std::vector<piece> split_large(grower& top, const tree_part& all, std::size_t most, const Run& run)
        {
            struct two_parts {
                tree_part of[2]{};
            };
            std::vector<piece> level{{all, 0, kernels::NO_PAIR}}, left;
            while (!level.empty()) {
                std::vector<two_parts> halves(level.size());
                run(level.size(),
                    [&](std::size_t i) { (void)top.by.split(level[i].of, level[i].depth, halves[i].of); });
                std::vector<piece> next;
                for (std::size_t i = 0; i < level.size(); ++i) {
                    const uint above = level[i].above, at = level[i].depth, pair = top.add_pair(halves[i].of, at);
                    if (above == kernels::NO_PAIR)
                        top.pairs[2].w = above;
                    else
                        top.link(kernels::pair_above(above), kernels::child_above(above), pair);
                    for (uint side = 0; side < 2; ++side) {
                        const tree_part& half = halves[i].of[side];
                        (half.size() > most ? next : left).push_back({half, at + 1, kernels::below_child(pair, side)});
                    }
                }
                level = std::move(next);
            }
            return left;
        }

        /// Puts a piece with its pairs into the tree.
        static void put(triangle_tree& tree, const piece& p, const std::vector<glm::uvec4>& pairs)
        {
            const auto moved = [&](uint child) { return kernels::is_leaf(child) ? child : child + p.first_pair; };
            glm::uvec4* to = tree.pairs.data() + std::size_t{p.first_pair} * kernels::PAIR_RECORDS;
            std::copy(pairs.begin(), pairs.end(), to);
            for (std::size_t at = 0; at < pairs.size(); at += kernels::PAIR_RECORDS) {
                to[at].w = moved(to[at].w);
                to[at + 1].w = moved(to[at + 1].w);
                const uint above = to[at + 2].w;
                to[at + 2].w = at == 0
                    ? p.above
                    : kernels::below_child(kernels::pair_above(above) + p.first_pair, kernels::child_above(above));
            }
            tree.pairs[kernels::pair_above(p.above) * kernels::PAIR_RECORDS + kernels::child_above(p.above)].w
                = moved(p.root);
        }

        const mesh& mesh_;
        tree_limits limits_;
        std::unique_ptr<tree_item[]> items_; ///< of the triangles
    };

    /// \throws std::invalid_argument for more triangles than the leaves of a tree can number.
    inline void require_countable(std::size_t triangles)
    {
        if (triangles > 1u << 28)
            throw std::invalid_argument(
                "mesh: triangles: " + std::to_string(triangles) + "; a tree holds at most 2^28, so split the mesh");
    }

    template <class Run>
    triangle_tree build_triangle_tree(const mesh& m, const Run& run, const tree_limits& limits = {})
    {
        check(m);
        require_countable(m.triangles.size());
        return tree_builder(m, limits).build(run);
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

#include <photongrid/core/exact_end.hpp>
