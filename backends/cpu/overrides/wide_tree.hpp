// The tree that the cpu backend searches for the hits of rays: a triangle_tree with up to eight children a node and up
// to eight triangles a leaf, so that one SIMD operation tests a ray against all of them.
#pragma once

#include <photongrid/backends/cpu/cpu_backend.hpp>
#include <photongrid/trace/instance_tree.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <map>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid::cpu {

inline constexpr std::size_t wide = 8; ///< children of a node, and triangles of a block
/// A node is so many rows of `wide` floats: the boxes' lowest x, y and z, their highest x, y and z, and the children,
/// as bits. A child that does not exist has a box that no ray meets.
inline constexpr std::size_t node_rows = 7, row_of_children = 6;
/// A block is so many rows of `wide` floats: x, y and z of the triangles' first corners, of the second and of the third
/// ones, and the triangles' indices in the mesh, as bits.
inline constexpr std::size_t block_rows = 10, row_of_indices = 9;

/// A child is a node or a leaf: a block, as kernels::leaf_of() has it for triangles. Above instances a leaf is one of
/// them.
struct wide_tree {
    std::vector<float> nodes;           ///< the root first
    std::vector<float> blocks;          ///< of triangles
    glm::vec3 low{1e30f}, high{-1e30f}; ///< box of all, m; without triangles no ray meets it
    std::vector<wide_root> roots;       ///< of the instances' surfaces
};

/// Makes a wide_tree from a triangle_tree.
class tree_widener {
public:
    explicit tree_widener(const triangle_tree& from) : from_(from), spans_(from.pairs.size() / kernels::PAIR_RECORDS)
    {
        for (auto pair = static_cast<uint>(spans_.size()); pair-- > 0;) // those below a pair come after it
            spans_[pair] = {span_of(child_of(pair, 0)).first, span_of(child_of(pair, 1)).past};
    }

    wide_tree build()
    {
        above_instances_ = !from_.instances.empty();
        const auto whole = add_tree(0);
        made_.low = whole.low;
        made_.high = whole.high;
        above_instances_ = false;
        std::map<uint, wide_root> roots; // surfaces by their first pairs
        for (std::size_t at = 0; at < from_.instances.size(); at += kernels::INSTANCE_RECORDS) {
            const auto [found, is_new] = roots.try_emplace(from_.instances[at + 2].w);
            if (is_new)
                found->second = add_tree(found->first);
            made_.roots.push_back(found->second);
        }
        return std::move(made_);
    }

private:
    struct span {
        uint first, past; ///< triangles, in the order of the leaves
        uint size() const { return past - first; }
    };
    struct child {
        uint id; ///< as in the triangle_tree
        photongrid::detail::tree_box box;
    };
    struct children {
        std::array<child, wide> of;
        std::size_t size = 0;
    };

    uint child_of(uint pair, uint side) const { return from_.pairs[kernels::PAIR_RECORDS * pair + side].w; }
    span span_of(uint id) const
    {
        return kernels::is_leaf(id) ? span{kernels::first_of_leaf(id), kernels::past_leaf(id)} : spans_[id];
    }

    /// Adds the nodes from a pair on.
    wide_root add_tree(uint pair)
    {
        children all;
        open(pair, all);
        wide_root root{0, glm::vec3(1e30f), glm::vec3(-1e30f)};
        for (std::size_t c = 0; c < all.size; ++c) {
            root.low = glm::min(root.low, all.of[c].box.low);
            root.high = glm::max(root.high, all.of[c].box.high);
        }
        root.node = add_node(all);
        return root;
    }
    /// Whether a child becomes a leaf: an instance, or up to eight triangles.
    bool becomes_leaf(uint id) const { return above_instances_ ? kernels::is_leaf(id) : span_of(id).size() <= wide; }

    /// Adds the children of a pair, but for empty ones.
    void open(uint pair, children& to) const
    {
        for (uint side = 0; side < 2; ++side) {
            const auto at = kernels::PAIR_RECORDS * pair + 2 * side;
            const child c{
                child_of(pair, side), {kernels::corner_of(from_.pairs[at]), kernels::corner_of(from_.pairs[at + 1])}};
            if (c.box.low.x <= c.box.high.x)
                to.of[to.size++] = c;
        }
    }

    /// Replaces children by theirs, the largest first, until there are eight, and adds them as a node.
    uint add_node(children c)
    {
        while (c.size < wide) {
            std::size_t largest = wide;
            for (std::size_t i = 0; i < c.size; ++i)
                if (!becomes_leaf(c.of[i].id) && (largest == wide || c.of[i].box.area() > c.of[largest].box.area()))
                    largest = i;
            if (largest == wide)
                break;
            const uint pair = c.of[largest].id;
            c.of[largest] = c.of[--c.size];
            open(pair, c);
        }
        const std::size_t at = made_.nodes.size();
        made_.nodes.resize(at + node_rows * wide);
        for (std::size_t i = 0; i < wide; ++i) {
            const auto box = i < c.size ? c.of[i].box : photongrid::detail::tree_box{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                made_.nodes[at + axis * wide + i] = box.low[static_cast<int>(axis)];
                made_.nodes[at + (3 + axis) * wide + i] = box.high[static_cast<int>(axis)];
            }
        }
        for (std::size_t i = 0; i < c.size; ++i) {
            uint id = c.of[i].id;
            if (becomes_leaf(id)) {
                if (!above_instances_)
                    id = add_block(span_of(id));
            } else {
                children below;
                open(c.of[i].id, below);
                id = add_node(below);
            }
            made_.nodes[at + row_of_children * wide + i] = std::bit_cast<float>(id);
        }
        return static_cast<uint>(at / (node_rows * wide));
    }

    uint add_block(const span& triangles)
    {
        const std::size_t at = made_.blocks.size();
        made_.blocks.resize(at + block_rows * wide);
        for (uint i = 0; i < triangles.size(); ++i) {
            const auto* corners = &from_.corners[kernels::TRIANGLE_RECORDS * (triangles.first + i)];
            for (std::size_t c = 0; c < 3; ++c) {
                const glm::vec3 p = kernels::corner_of(corners[c]);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    made_.blocks[at + (3 * c + axis) * wide + i] = p[static_cast<int>(axis)];
            }
            made_.blocks[at + row_of_indices * wide + i] = std::bit_cast<float>(corners[0].w);
        }
        return kernels::leaf_of(static_cast<uint>(at / (block_rows * wide)), triangles.size());
    }

    const triangle_tree& from_;
    std::vector<span> spans_; ///< of the pairs; without meaning above instances
    bool above_instances_ = false;
    wide_tree made_;
};

} // namespace photongrid::cpu

#include <photongrid/backend/exact_end.hpp>
