// A tree of boxes over the shapes of a scene, but for meshes, whose triangles have one of their own
// (triangle_tree.hpp). Rays walk it without a stack, since each node says which node follows what is below it
// (intersect/tree.glsl).
#pragma once

#include <photongrid/scene/bounds.hpp>
#include <photongrid/trace/tree_box.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A shape in its box.
struct boxed_shape {
    detail::tree_box box;   ///< m
    std::uint32_t kind = 0; ///< shape_kind::number
    std::uint32_t at = 0;   ///< its record
};

/// A node, in the order of a walk from the root down, first children first.
struct shape_node {
    boxed_shape shape;      ///< of an inner node only the box
    bool is_leaf = true;    ///< it holds one shape
    std::uint32_t past = 0; ///< the node after all that are below this one
};

namespace detail {
    /// Scenes of more shapes, and surfaces of lights, than these have a tree.
    inline constexpr std::size_t most_shapes_without_tree = 32;

    class shape_tree_builder {
    public:
        explicit shape_tree_builder(std::span<const boxed_shape> shapes) : shapes_(shapes), order_(shapes.size())
        {
            std::iota(order_.begin(), order_.end(), std::uint32_t{0});
            nodes_.reserve(2 * shapes.size());
        }

        /// `apart`: so many of the last shapes are below the root's second child, all others below its first.
        std::vector<shape_node> build(std::size_t apart)
        {
            const std::span all(order_);
            if (apart > 0 && apart < all.size())
                join(all, all.size() - apart, 0);
            else if (!all.empty())
                add(all);
            return std::move(nodes_);
        }

    private:
        /// Appends the tree of these shapes, `level` nodes below the root.
        void add(std::span<std::uint32_t> shapes, int level = 0)
        {
            if (shapes.size() == 1) {
                nodes_.push_back({shapes_[shapes[0]], true, static_cast<std::uint32_t>(nodes_.size() + 1)});
                return;
            }
            // From level 32 on halves, so that the tree is at most 32 + log2(n) levels deep.
            const bool in_the_middle = shapes.size() > 8192 || level >= 32;
            join(shapes, in_the_middle ? split_in_the_middle(shapes) : split(shapes), level);
        }

        /// Appends a node, and below it the trees of the first `half` of these shapes and of the rest.
        void join(std::span<std::uint32_t> shapes, std::size_t half, int level)
        {
            const std::size_t number = nodes_.size();
            shape_node made{{}, false, 0};
            for (const auto n : shapes)
                made.shape.box.add(shapes_[n].box);
            nodes_.push_back(made);
            add(shapes.first(half), level + 1);
            add(shapes.subspan(half), level + 1);
            nodes_[number].past = static_cast<std::uint32_t>(nodes_.size());
        }

        /// Sorts shapes and returns where to split them: by the surface area heuristic (Goldsmith and Salmon, Automatic
        /// Creation of Object Hierarchies for Ray Tracing, 1987) over all splits of all axes.
        std::size_t split(std::span<std::uint32_t> shapes)
        {
            const auto n = static_cast<double>(shapes.size());
            double least = std::numeric_limits<double>::infinity();
            std::size_t best = 0;
            int best_axis = 0;
            std::vector<double> below(shapes.size());
            for (int axis = 0; axis < 3; ++axis) {
                sort_along(axis, shapes);
                tree_box box;
                for (std::size_t i = 0; i < shapes.size(); ++i) {
                    below[i] = box.area() * static_cast<double>(i);
                    box.add(shapes_[shapes[i]].box);
                }
                box = {};
                for (std::size_t i = shapes.size() - 1; i > 0; --i) {
                    box.add(shapes_[shapes[i]].box);
                    const double here = static_cast<double>(i), cost = below[i] + box.area() * (n - here);
                    // Of splits that cost the same, as where all boxes are equal, the one in the middle.
                    const double uneven = std::abs(2 * here - n) / n;
                    if (cost * (1 + 1e-6 * uneven) < least) {
                        least = cost * (1 + 1e-6 * uneven);
                        best = i;
                        best_axis = axis;
                    }
                }
            }
            sort_along(best_axis, shapes);
            return best;
        }
        std::size_t split_in_the_middle(std::span<std::uint32_t> shapes) const
        {
            tree_box box;
            for (const auto n : shapes)
                box.add(shapes_[n].box);
            const glm::vec3 size = box.high - box.low;
            sort_along(size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2, shapes);
            return shapes.size() / 2;
        }
        void sort_along(int axis, std::span<std::uint32_t> shapes) const
        {
            const auto middle = [&](std::uint32_t n) { return shapes_[n].box.low[axis] + shapes_[n].box.high[axis]; };
            std::sort(shapes.begin(), shapes.end(), [&](std::uint32_t a, std::uint32_t b) {
                const float p = middle(a), q = middle(b);
                return p != q ? p < q : a < b;
            });
        }

        std::span<const boxed_shape> shapes_;
        std::vector<std::uint32_t> order_;
        std::vector<shape_node> nodes_;
    };
} // namespace detail

/// The tree of some shapes, the root first: a leaf for each shape. The same shapes have the same tree. `apart`: so many
/// of the last shapes are below the root's second child, all others below its first.
inline std::vector<shape_node> build_shape_tree(std::span<const boxed_shape> shapes, std::size_t apart = 0)
{
    return detail::shape_tree_builder(shapes).build(apart);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
