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

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::cpu {

inline constexpr std::size_t wide = 8; ///< children of a node, and triangles of a block
/// A node is so many rows of `wide` floats: the boxes' lowest x, y and z, their highest x, y and z, and the children,
/// as bits. A child that does not exist has a box that no ray meets.
inline constexpr std::size_t node_rows = 7, row_of_children = 6;
/// A block is so many rows of `wide` floats: x, y and z of the triangles' first corners, of the second and of the third
/// ones, and the triangles' indices in the mesh, as bits.
inline constexpr std::size_t block_rows = 10, row_of_indices = 9;

/// Makes such a tree from a triangle_tree, the same with any number of threads.
///
/// A child is a node or a leaf: a block, as kernels::leaf_of() has it for triangles. Above instances a leaf is one of
/// them.
class tree_widener {
public:
    explicit tree_widener(const triangle_tree& from) : from_(from), below_(from.pairs.size() / kernels::PAIR_RECORDS)
    {
        for (auto pair = static_cast<uint>(below_.size()); pair-- > 0;) { // those below a pair come after it
            const contents a = contents_of(child_of(pair, 0)), b = contents_of(child_of(pair, 1));
            below_[pair] = {a.first, b.past, a.blocks + b.blocks};
            if (below_[pair].size() <= wide)
                below_[pair].blocks = 1;
        }
    }

    /// `run(n, f)` calls f(i) for each i below n, in any order or at once.
    template <class Run>
    device_triangles<cpu_backend> build(cpu_backend& device, const Run& run) const
    {
        const bool has_instances = !from_.instances.empty();
        std::map<uint, surface> surfaces; // by their first pairs
        for (std::size_t at = 0; at < from_.instances.size(); at += kernels::INSTANCE_RECORDS)
            surfaces.try_emplace(from_.instances[at + 2].w);
        if (!has_instances)
            surfaces.try_emplace(0u);
        uint blocks = 0;
        for (auto& [pair, s] : surfaces) {
            s.first_block = blocks;
            for (uint side = 0; side < 2; ++side)
                blocks += is_empty(pair, side) ? 0 : contents_of(child_of(pair, side)).blocks;
        }

        device_triangles<cpu_backend> made;
        made.blocks = device.make<float>(blocks * block_rows * wide);
        made.planes = device.make<glm::vec4>(blocks * wide);
        const targets to{device.elements_to_write(made.blocks).data(), device.elements_to_write(made.planes).data()};
        // The upper nodes, then what is below them, in pieces.
        maker top{*this, to};
        wide_root whole{};
        if (has_instances) {
            top.above_instances = true;
            whole = top.add_tree(0, 0);
            top.above_instances = false;
        }
        top.most_in_piece = std::max<std::size_t>(from_.corners.size() / kernels::TRIANGLE_RECORDS / 64, 2048);
        for (auto& [pair, s] : surfaces)
            s.root = top.add_tree(pair, s.first_block);
        if (!has_instances)
            whole = surfaces.begin()->second.root;
        std::vector<maker> below(top.pieces.size(), maker{*this, to});
        run(below.size(), [&](std::size_t i) { below[i].add_tree(top.pieces[i].pair, top.pieces[i].first_block); });

        std::size_t size = top.nodes.size();
        std::vector<std::size_t> begins;
        for (std::size_t i = 0; i < below.size(); ++i) {
            top.nodes[top.pieces[i].link] = std::bit_cast<float>(node_at(size));
            begins.push_back(size);
            size += below[i].nodes.size();
        }
        made.nodes = device.make<float>(size);
        float* const to_nodes = device.elements_to_write(made.nodes).data();
        std::copy(top.nodes.begin(), top.nodes.end(), to_nodes);
        run(below.size(), [&](std::size_t i) { below[i].copy_to(to_nodes + begins[i], node_at(begins[i])); });

        made.low = whole.low;
        made.high = whole.high;
        for (std::size_t at = 0; at < from_.instances.size(); at += kernels::INSTANCE_RECORDS)
            made.roots.push_back(surfaces.at(from_.instances[at + 2].w).root);
        return made;
    }

private:
    static constexpr std::size_t node_floats = node_rows * wide;

    /// What is below a pair or leaf; without meaning above instances.
    struct contents {
        uint first, past; ///< triangles, in the order of the leaves
        uint blocks;      ///< that they become

        uint size() const { return past - first; }
    };
    struct surface {
        wide_root root{};
        uint first_block = 0;
    };
    struct child {
        uint id; ///< as in the triangle_tree
        uint first_block;
        photongrid::detail::tree_box box;
    };
    struct children {
        std::array<child, wide> of;
        std::size_t size = 0;
    };
    /// A pair that another maker makes nodes of.
    struct piece {
        uint pair, first_block;
        std::size_t link; ///< the element of the nodes that is to name its node
    };

    static uint node_at(std::size_t element) { return static_cast<uint>(element / node_floats); }
    uint child_of(uint pair, uint side) const { return from_.pairs[kernels::PAIR_RECORDS * pair + side].w; }
    /// Whether there is nothing in a child: the second one of a tree of one leaf, or both.
    bool is_empty(uint pair, uint side) const
    {
        const auto at = kernels::PAIR_RECORDS * pair + 2 * side;
        return kernels::corner_of(from_.pairs[at]).x > kernels::corner_of(from_.pairs[at + 1]).x;
    }
    contents contents_of(uint id) const
    {
        return kernels::is_leaf(id) ? contents{kernels::first_of_leaf(id), kernels::past_leaf(id), 1} : below_[id];
    }

    /// Where blocks are written.
    struct targets {
        float* blocks;
        glm::vec4* planes; ///< `wide` for each block
    };

    /// Makes nodes and blocks of pairs.
    struct maker {
        const tree_widener& from;
        targets to;
        std::size_t most_in_piece = 0; ///< children of up to so many triangles become pieces
        bool above_instances = false;
        std::vector<float> nodes{};
        std::vector<piece> pieces{};

        /// Adds the nodes from a pair on.
        wide_root add_tree(uint pair, uint first_block)
        {
            children all;
            open(pair, first_block, all);
            wide_root root{0, glm::vec3(1e30f), glm::vec3(-1e30f)};
            for (std::size_t c = 0; c < all.size; ++c) {
                root.low = glm::min(root.low, all.of[c].box.low);
                root.high = glm::max(root.high, all.of[c].box.high);
            }
            root.node = add_node(all);
            return root;
        }
        /// Copies the nodes to where the first one is `first`.
        void copy_to(float* to, uint first) const
        {
            std::copy(nodes.begin(), nodes.end(), to);
            for (float* row = to + row_of_children * wide; row < to + nodes.size(); row += node_floats)
                for (std::size_t i = 0; i < wide; ++i)
                    if (const auto id = std::bit_cast<uint>(row[i]); !kernels::is_leaf(id))
                        row[i] = std::bit_cast<float>(id + first);
        }

    private:
        /// Whether a child becomes a leaf: an instance, or up to eight triangles.
        bool becomes_leaf(uint id) const
        {
            return above_instances ? kernels::is_leaf(id) : from.contents_of(id).size() <= wide;
        }

        /// Adds the children of a pair, but for empty ones.
        void open(uint pair, uint first_block, children& to) const
        {
            for (uint side = 0; side < 2; ++side) {
                const auto at = kernels::PAIR_RECORDS * pair + 2 * side;
                const auto& pairs = from.from_.pairs;
                if (from.is_empty(pair, side))
                    continue;
                const child c{from.child_of(pair, side), first_block,
                    {kernels::corner_of(pairs[at]), kernels::corner_of(pairs[at + 1])}};
                to.of[to.size++] = c;
                first_block += above_instances ? 0 : from.contents_of(c.id).blocks;
            }
        }

        /// Replaces children by theirs, the largest first, until there are eight, and adds them as a node.
        uint add_node(children c)
        {
            std::array<double, wide> areas; // of the boxes of those that do not become leaves; the others have -1
            const auto area_of = [&](std::size_t i) { return becomes_leaf(c.of[i].id) ? -1 : c.of[i].box.area(); };
            for (std::size_t i = 0; i < c.size; ++i)
                areas[i] = area_of(i);
            while (c.size < wide) {
                const auto largest = static_cast<std::size_t>(
                    std::max_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(c.size))
                    - areas.begin());
                if (c.size == 0 || areas[largest] < 0)
                    break;
                const child opened = c.of[largest];
                c.of[largest] = c.of[--c.size];
                areas[largest] = areas[c.size];
                const std::size_t first = c.size;
                open(opened.id, opened.first_block, c);
                for (std::size_t i = first; i < c.size; ++i)
                    areas[i] = area_of(i);
            }
            const std::size_t at = nodes.size();
            nodes.resize(at + node_floats);
            for (std::size_t i = 0; i < wide; ++i) {
                const auto box = i < c.size ? c.of[i].box : photongrid::detail::tree_box{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    nodes[at + axis * wide + i] = box.low[static_cast<int>(axis)];
                    nodes[at + (3 + axis) * wide + i] = box.high[static_cast<int>(axis)];
                }
            }
            for (std::size_t i = 0; i < c.size; ++i) {
                const child& below = c.of[i];
                const std::size_t link = at + row_of_children * wide + i;
                uint id = below.id;
                if (becomes_leaf(id)) {
                    if (!above_instances)
                        id = write_block(below.first_block, from.contents_of(id));
                } else if (!above_instances && from.contents_of(id).size() <= most_in_piece) {
                    pieces.push_back({id, below.first_block, link});
                    continue;
                } else {
                    children opened;
                    open(id, below.first_block, opened);
                    id = add_node(opened);
                }
                nodes[link] = std::bit_cast<float>(id);
            }
            return node_at(at);
        }

        uint write_block(uint block, const contents& triangles)
        {
            float* const rows = to.blocks + std::size_t{block} * block_rows * wide;
            glm::vec4* const planes = to.planes + std::size_t{block} * wide;
            std::fill_n(rows, block_rows * wide, 0.0f);
            std::fill_n(planes, wide, glm::vec4(0));
            for (uint i = 0; i < triangles.size(); ++i) {
                const auto* corners = &from.from_.corners[kernels::TRIANGLE_RECORDS * (triangles.first + i)];
                for (std::size_t c = 0; c < 3; ++c) {
                    const glm::vec3 p = kernels::corner_of(corners[c]);
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        rows[(3 * c + axis) * wide + i] = p[static_cast<int>(axis)];
                }
                rows[row_of_indices * wide + i] = std::bit_cast<float>(corners[0].w);
                planes[i] = from.from_.planes[triangles.first + i];
            }
            return kernels::leaf_of(block, triangles.size());
        }
    };

    const triangle_tree& from_;
    std::vector<contents> below_; ///< the pairs
};

} // namespace photongrid::cpu

#include <photongrid/core/exact_end.hpp>
