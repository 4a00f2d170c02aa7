// Some of the points of a buffer, next to each other, and their estimates among those of all.
#pragma once

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/prefix_sums.hpp>
#include <photongrid/render/is_searched.kernel.hpp>
#include <photongrid/render/searched_point.kernel.hpp>
#include <photongrid/render/searched_words.kernel.hpp>
#include <photongrid/render/take_estimate.kernel.hpp>
#include <photongrid/render/take_vector.kernel.hpp>

#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The points whose state is SEARCHED (pixel_tile.glsl).
template <backend B>
struct marked_points {
    uint count = 0;
    buffer_of<B, uint> words, sums; ///< see searched_words.glsl; inclusive prefix sums of their bits

    marked_points() = default;
    marked_points(B& device, const buffer_of<B, uint>& states)
        : count(checked_count<kernels::is_searched>(device, states.size(), {}, reads(states))),
          words(device.template make<uint>((states.size() + 31) / 32))
    {
        auto bits = device.template make<uint>(words.size());
        device.template run<kernels::searched_words>(
            words.size(), {.pixels = static_cast<uint>(states.size())}, reads(states), writes(words, bits));
        sums = prefix_sums(device, bits);
    }
    /// They and their normals.
    std::pair<buffer_of<B, glm::vec4>, buffer_of<B, glm::vec4>> gather(
        B& device, const buffer_of<B, glm::vec4>& points, const buffer_of<B, glm::vec4>& normals) const
    {
        auto places = device.template make<glm::vec4>(count), place_normals = device.template make<glm::vec4>(count);
        device.template run<kernels::searched_point>(count, {.words = static_cast<uint>(words.size())},
            reads(words, sums, points, normals), writes(places, place_normals));
        return {std::move(places), std::move(place_normals)};
    }
};

/// Puts estimates `found` at the marked points among those of all points. Tiles of pixels (pixel_tile.glsl) are of
/// pictures of `size`.
template <backend B>
void take_estimates(B& device, glm::uvec2 size, const buffer_of<B, uint>& states, const marked_points<B>& marked,
    knn_estimates<B> found, knn_estimates<B>& all)
{
    const auto n = states.size();
    const auto take = [&](const buffer_of<B, glm::vec4>& from, buffer_of<B, glm::vec4>& values) {
        auto taken = device.template make<glm::vec4>(values.size());
        device.template run<kernels::take_vector>(
            values.size(), {.size = size}, reads(states, marked.words, marked.sums, from, values), writes(taken));
        values = std::move(taken);
    };
    auto irradiance = device.template make<glm::vec4>(n);
    auto used = device.template make<glm::uvec2>(n);
    device.template run<kernels::take_estimate>(n, {.size = size},
        reads(states, marked.words, marked.sums, found.irradiance, found.used, all.irradiance, all.used),
        writes(irradiance, used));
    all.irradiance = std::move(irradiance);
    all.used = std::move(used);
    take(found.standard_error, all.standard_error);
    const auto biases = found.biases.all();
    const auto taken = all.biases.all();
    for (std::size_t i = 0; i < biases.size(); ++i)
        take(*biases[i], *taken[i]);
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
