// A tree of two levels: instances of surfaces, which stand in a scene several times and are stored once. Leaves of the
// upper level are instances; each surface has a triangle_tree.
#pragma once

#include <photongrid/trace/instance.kernel.hpp>
#include <photongrid/trace/triangle_tree.hpp>

#include <bit>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <span>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Where a surface stands.
struct placement {
    std::size_t surface = 0;  ///< its index
    glm::dmat3 linear{1};     ///< scales and turns its vertices ...
    glm::dvec3 offset{0};     ///< ... and then moves them, m
    bool is_in_place = false; ///< its vertices are the scene's; then `linear` is 1 and `offset` 0
    uint first_face = 0;      ///< see trace/instance.glsl, for kernels that look surfaces up
    uint face_code = 0;       ///< likewise
};

namespace detail {
    /// By how much rounding in the space that a matrix leads from may count for more in the space that it leads to; 1
    /// of turns, and of even scales.
    inline double stretch_of(const glm::dmat3& linear)
    {
        const auto size = [](const glm::dmat3& a) {
            return std::sqrt(glm::dot(a[0], a[0]) + glm::dot(a[1], a[1]) + glm::dot(a[2], a[2]));
        };
        return size(linear) * size(glm::inverse(linear)) / 3;
    }

    /// A bound of the rounding error by which rays in a surface's space and hits in the scene differ, m: 64 units of
    /// 2^-24 of the surface's size in the scene.
    inline double rounding_of_placing(const glm::dmat3& linear, const glm::dvec3& size)
    {
        return (size.x + size.y + size.z) * stretch_of(linear) * 0x1p-18;
    }

    class instance_tree_builder {
        static constexpr std::size_t most_placements = std::size_t{1} << 24;

    public:
        /// `limits` of the surfaces' trees.
        instance_tree_builder(
            std::span<const mesh> surfaces, std::span<const placement> placements, const tree_limits& limits = {})
            : surfaces_(surfaces), placements_(placements), limits_(limits)
        {
            for (std::size_t s = 0; s < surfaces.size(); ++s) {
                check(surfaces[s]);
                if (surfaces[s].triangles.empty())
                    throw std::invalid_argument("instances: surface " + std::to_string(s) + " has no triangles");
            }
            if (placements.size() > most_placements)
                throw std::invalid_argument("instances: " + std::to_string(placements.size())
                    + " placements; at most 2^24 are possible, so place fewer");
            for (const auto& p : placements) {
                if (p.surface >= surfaces.size())
                    throw std::invalid_argument("instances: surface " + std::to_string(p.surface)
                        + " is placed; there are " + std::to_string(surfaces.size()));
                const double determinant = glm::determinant(p.linear);
                if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
                    throw std::invalid_argument("instances: a placement makes a surface flat, or is not finite");
                if (p.is_in_place && (p.linear != glm::dmat3(1) || p.offset != glm::dvec3(0)))
                    throw std::invalid_argument("instances: a placement that is in place moves its surface");
            }
        }

        template <class Run>
        triangle_tree build(const Run& run)
        {
            triangle_tree tree;
            if (placements_.empty()) // a tree that no ray meets
                return tree_builder(mesh{}).build(run);
            boxes_within_.resize(surfaces_.size());
            run(surfaces_.size(), [&](std::size_t s) { boxes_within_[s] = boxes_within(surfaces_[s]); });
            std::vector<tree_box> boxes(placements_.size());
            run(placements_.size(), [&](std::size_t i) { boxes[i] = box_of(placements_[i]); });
            enlarge(boxes);
            // A "triangle" for each box, and a leaf for each.
            mesh corners;
            for (const auto& b : boxes) {
                const auto first = static_cast<uint>(corners.positions.size());
                corners.positions.insert(corners.positions.end(), {b.low, b.high});
                corners.triangles.emplace_back(first, first + 1, first);
            }
            const auto levels = static_cast<uint>(std::bit_width(placements_.size() - 1)) + 1;
            tree = tree_builder(corners, {.deepest = levels, .most_in_leaf = 1, .few = 0}).build(run);
            links_.assign(placements_.size(), 0);
            number_leaves(tree);
            tree.corners.clear();
            tree.planes.clear();

            tree_limits limits = limits_;
            limits.deepest -= tree.depth + 1;
            uint depth = 0;
            std::vector<uint> roots(surfaces_.size()), sizes(surfaces_.size());
            for (std::size_t s = 0; s < surfaces_.size(); ++s) {
                require_countable(tree.corners.size() / kernels::TRIANGLE_RECORDS + surfaces_[s].triangles.size());
                if (surfaces_[s].triangles.size() > limits.most_below(0))
                    throw std::invalid_argument("instances: surface " + std::to_string(s) + " has "
                        + std::to_string(surfaces_[s].triangles.size()) + " triangles; below "
                        + std::to_string(placements_.size()) + " placements a tree holds "
                        + std::to_string(limits.most_below(0)) + ", so split the surface or place fewer");
                const auto below = tree_builder(surfaces_[s], limits).build(run);
                roots[s] = static_cast<uint>(tree.pairs.size() / kernels::PAIR_RECORDS);
                sizes[s] = static_cast<uint>(below.pairs.size() / kernels::PAIR_RECORDS);
                append(tree, below, roots[s]);
                depth = std::max(depth, below.depth);
            }
            write_instances(tree, boxes, roots, sizes);
            tree.depth += 1 + depth;
            return tree;
        }

    private:
        /// The boxes of a surface's triangles, in which hits lie. One box holds so many triangles in a row that there
        /// are at most 256 boxes, since every placement moves each of them.
        static std::vector<tree_box> boxes_within(const mesh& m)
        {
            const std::size_t n = m.triangles.size(), per_box = n / 256 + 1;
            std::vector<tree_box> boxes((n + per_box - 1) / per_box);
            for (std::size_t t = 0; t < n; ++t)
                for (const glm::vec3& corner : corners_of(m, t))
                    boxes[t / per_box].add(corner);
            return boxes;
        }
        /// The box of a surface where it stands: around the boxes within it.
        tree_box box_of(const placement& p) const
        {
            const glm::dmat3 spread(glm::abs(p.linear[0]), glm::abs(p.linear[1]), glm::abs(p.linear[2]));
            tree_box b;
            for (const tree_box& part : boxes_within_[p.surface]) {
                const glm::dvec3 low(part.low), high(part.high), middle = p.linear * (0.5 * (low + high)) + p.offset,
                                                                 half = spread * (0.5 * (high - low));
                b.add(glm::vec3(middle - half));
                b.add(glm::vec3(middle + half));
            }
            return b;
        }
        /// rounding_of_placing, for rays.
        float rounding_of(const placement& p) const
        {
            tree_box all;
            for (const tree_box& part : boxes_within_[p.surface])
                all.add(part);
            const glm::dvec3 far(glm::max(glm::abs(all.low), glm::abs(all.high)));
            return static_cast<float>(rounding_of_placing(p.linear,
                glm::abs(p.linear[0]) * far.x + glm::abs(p.linear[1]) * far.y + glm::abs(p.linear[2]) * far.z));
        }
        /// Makes boxes larger by more than what hits in a surface's space and in the scene differ by, of rays from ten
        /// times as far away as the scene is large.
        void enlarge(std::vector<tree_box>& boxes) const
        {
            float largest = 0; // coordinate, m
            for (const auto& b : boxes)
                for (int axis = 0; axis < 3; ++axis) {
                    const float far = std::max(std::abs(b.low[axis]), std::abs(b.high[axis]));
                    if (!(far <= 1e18f))
                        throw std::invalid_argument("instances: a placement moves a surface beyond 10^18 m");
                    largest = std::max(largest, far);
                }
            for (std::size_t i = 0; i < boxes.size(); ++i)
                if (!placements_[i].is_in_place) {
                    const double stretch = std::max(1.0, stretch_of(placements_[i].linear) / 4);
                    const auto margin = static_cast<float>(static_cast<double>(largest) * 0x1p-16 * stretch);
                    boxes[i].low -= margin;
                    boxes[i].high += margin;
                }
        }
        /// Makes each leaf of the upper level name its instance, and finds what instances are below.
        void number_leaves(triangle_tree& tree)
        {
            for (uint pair = 0; pair < tree.pairs.size() / kernels::PAIR_RECORDS; ++pair)
                for (uint side = 0; side < 2; ++side) {
                    auto& child = tree.pairs[pair * kernels::PAIR_RECORDS + side].w;
                    const auto leaf = std::size_t{kernels::first_of_leaf(child)} * kernels::TRIANGLE_RECORDS;
                    if (!kernels::is_leaf(child) || leaf >= tree.corners.size())
                        continue; // the empty second child of a tree of one instance
                    const uint instance = tree.corners[leaf].w;
                    child = kernels::leaf_of(instance, 1);
                    links_[instance] = kernels::below_child(pair, side);
                }
        }
        /// Adds the pairs and triangles of a surface's tree, whose first pair becomes `root`.
        static void append(triangle_tree& tree, const triangle_tree& below, uint root)
        {
            const auto first = static_cast<uint>(tree.corners.size() / kernels::TRIANGLE_RECORDS);
            tree.corners.insert(tree.corners.end(), below.corners.begin(), below.corners.end());
            tree.planes.insert(tree.planes.end(), below.planes.begin(), below.planes.end());
            const auto at = tree.pairs.size();
            tree.pairs.insert(tree.pairs.end(), below.pairs.begin(), below.pairs.end());
            const auto moved = [&](uint child) { return child + (kernels::is_leaf(child) ? first : root); };
            for (auto pair = at; pair < tree.pairs.size(); pair += kernels::PAIR_RECORDS) {
                tree.pairs[pair].w = moved(tree.pairs[pair].w);
                tree.pairs[pair + 1].w = moved(tree.pairs[pair + 1].w);
                if (auto& link = tree.pairs[pair + 2].w; link != kernels::NO_PAIR)
                    link = kernels::below_child(kernels::pair_above(link) + root, kernels::child_above(link));
            }
        }
        void write_instances(triangle_tree& tree, const std::vector<tree_box>& boxes, const std::vector<uint>& roots,
            const std::vector<uint>& sizes) const
        {
            std::uint64_t id = 0, pair = roots.empty() ? 0 : roots[0];
            const auto put = [&](const glm::vec3& v, std::uint64_t w) {
                tree.instances.emplace_back(
                    std::bit_cast<uint>(v.x), std::bit_cast<uint>(v.y), std::bit_cast<uint>(v.z), static_cast<uint>(w));
            };
            const auto row = [](const glm::dmat3& m, int r) { return glm::vec3(m[0][r], m[1][r], m[2][r]); };
            for (std::size_t i = 0; i < placements_.size(); ++i) {
                const auto& p = placements_[i];
                const glm::dmat3 inverse = glm::inverse(p.linear);
                put(row(inverse, 0), id);
                put(row(inverse, 1), pair);
                put(row(inverse, 2), roots[p.surface]);
                put(glm::vec3(p.offset), links_[i]);
                put(boxes[i].low, p.first_face);
                put(boxes[i].high, p.face_code);
                const bool mirrored = glm::determinant(p.linear) < 0;
                put(row(p.linear, 0), p.is_in_place ? kernels::IN_PLACE : mirrored ? kernels::MIRRORED : 0u);
                put(row(p.linear, 1), std::bit_cast<uint>(p.is_in_place ? 0.0f : rounding_of(p)));
                put(row(p.linear, 2), 0);
                id += surfaces_[p.surface].triangles.size();
                pair += sizes[p.surface];
                if (id >= 1u << 31 || pair >= 1u << 31)
                    throw std::invalid_argument("instances: more than 2^31 triangles in all; place fewer");
            }
        }

        std::span<const mesh> surfaces_;
        std::span<const placement> placements_;
        tree_limits limits_;
        std::vector<std::vector<tree_box>> boxes_within_; ///< the surfaces, each in its own space
        std::vector<uint> links_;                         ///< of the instances
    };
} // namespace detail

/// Builds a tree of surfaces that stand in a scene, each as often as placements name it. A hit's triangle is numbered
/// among those of all placements, in their order.
/// \throws std::invalid_argument as build_triangle_tree(mesh) does; for a surface without triangles; for a placement of
///         a surface that does not exist, that makes it flat, or that moves it beyond 10^18 m; for more than 2^24
///         placements or 2^31 triangles of all of them; for a surface of more triangles than a tree holds below so many
///         placements: 2^23 below 1,024, 2^17 below 65,536.
inline triangle_tree build_instance_tree(std::span<const mesh> surfaces, std::span<const placement> placements)
{
    return detail::instance_tree_builder(surfaces, placements).build(detail::run_in_turn);
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
