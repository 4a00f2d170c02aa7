// A tree of balls around lights, by which a sample of direct light chooses one of many (trace/chosen_light.glsl).
#pragma once

#include <photongrid/scene/scene.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A ball that holds those of two children. A child is the number of a node, or -1 - the number of a ball.
struct light_node {
    light_ball ball;
    std::int64_t left = 0, right = 0;
};

namespace detail {
    /// Of more lights than these each sample of direct light chooses one, by the tree.
    inline constexpr uint most_lights_sampled_each = 16;

    /// The ball around a light, from its records (trace/light_record.glsl); none for light from outside of the scene.
    template <class Kind, class Light>
    std::optional<light_ball> ball_around(Kind, const Light& l, const glm::vec4* record)
    {
        if constexpr (requires(const bounds& box) { Kind::power_into(box, l); })
            return {};
        light_ball ball{.center = vector_of(record[1])};
        if constexpr (requires { Kind::ball(record); })
            ball = Kind::ball(record);
        ball.power = glm::dot(vector_of(record[5]), dvec3(1));
        return ball;
    }

    class light_tree_builder {
    public:
        explicit light_tree_builder(std::span<const light_ball> lights) : lights_(lights), order_(lights.size())
        {
            std::iota(order_.begin(), order_.end(), std::size_t{0});
        }

        std::vector<light_node> build()
        {
            if (order_.size() > 1)
                add(order_);
            return std::move(nodes_);
        }

    private:
        /// Appends the tree of these lights and returns its number as a child.
        std::int64_t add(std::span<std::size_t> lights)
        {
            if (lights.size() == 1)
                return -1 - static_cast<std::int64_t>(lights[0]);
            bounds box;
            for (const std::size_t n : lights)
                box.add(lights_[n].center, dvec3(lights_[n].radius));
            light_ball ball{.center = 0.5 * (box.low + box.high)};
            for (const std::size_t n : lights) {
                ball.radius = std::max(ball.radius, glm::distance(lights_[n].center, ball.center) + lights_[n].radius);
                ball.power += lights_[n].power;
            }
            // Kernels have the ball in single precision.
            ball.radius += 0x1p-20 * (ball.radius + glm::length(ball.center));

            const dvec3 size = box.high - box.low;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const auto middle = static_cast<std::ptrdiff_t>(lights.size() / 2);
            std::nth_element(lights.begin(), lights.begin() + middle, lights.end(), [&](std::size_t a, std::size_t b) {
                const double p = lights_[a].center[axis], q = lights_[b].center[axis];
                return p != q ? p < q : a < b;
            });
            const std::size_t number = nodes_.size();
            nodes_.push_back({.ball = ball});
            const auto half = static_cast<std::size_t>(middle);
            const std::int64_t left = add(lights.first(half)), right = add(lights.subspan(half));
            nodes_[number].left = left;
            nodes_[number].right = right;
            return static_cast<std::int64_t>(number);
        }

        std::span<const light_ball> lights_;
        std::vector<std::size_t> order_;
        std::vector<light_node> nodes_;
    };
} // namespace detail

/// A tree of at most 1 + log2(n) levels; node 0 is its root. Empty for fewer than two lights.
inline std::vector<light_node> build_light_tree(std::span<const light_ball> lights)
{
    return detail::light_tree_builder(lights).build();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
