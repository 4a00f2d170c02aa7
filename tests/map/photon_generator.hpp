// Photons and query points by RapidCheck, number by number, so that a failing case shrinks to few photons at simple
// places. Numbers that tie, denormal, huge and infinite ones and NaN are among them.
#pragma once

#include "photon_sets.hpp"

#include <rapidcheck.h>

#include <array>
#include <limits>
#include <vector>

namespace photongrid::testing {

/// A number: a multiple of 1/8 up to 1, so that distances tie; any other up to 1; and rarely one that is hard to
/// compute with, or none.
inline rc::Gen<float> any_number()
{
    using limits = std::numeric_limits<float>;
    const auto within = [](int steps) {
        return rc::gen::map(rc::gen::inRange(-steps, steps + 1),
            [steps](int i) { return static_cast<float>(i) / static_cast<float>(steps); });
    };
    return rc::gen::weightedOneOf<float>({{40, within(8)}, {40, within(1 << 20)},
        {4,
            rc::gen::element(-0.0f, limits::denorm_min(), -1e-40f, limits::min(), limits::epsilon(), 1e18f, -1e30f,
                limits::max(), limits::lowest())},
        {1, rc::gen::element(limits::quiet_NaN(), limits::infinity(), -limits::infinity())}});
}

/// Vectors of three such numbers, and `w`.
inline rc::Gen<std::vector<glm::vec4>> any_vectors(float w)
{
    return rc::gen::container<std::vector<glm::vec4>>(rc::gen::apply(
        [w](float x, float y, float z) { return glm::vec4(x, y, z, w); }, any_number(), any_number(), any_number()));
}

/// Where photons lie densely: evenly in a box, a rectangle, on a line or at a point.
struct clump {
    glm::vec3 middle;
    float extent; ///< half of it; from far below the smallest number whose square is one to 10^6
    int axes;     ///< along how many axes it has an extent
};

/// A clump anywhere from 0 to 10^9 m away.
inline rc::Gen<clump> any_clump()
{
    const auto middle = rc::gen::element(0.0f, 1.0f, -0.75f, 1000.3f, 1e6f, -1e9f);
    return rc::gen::apply(
        [](float x, float y, float z, float extent, int axes) -> clump {
            return {{x, y, z}, extent, axes};
        },
        middle, middle, middle, rc::gen::element(1.0f, 0.0f, 1e-3f, 1e-6f, 1e-12f, 3e-20f, 1e-40f, 1e3f, 1e6f),
        rc::gen::inRange(0, 4));
}

/// A place in one of `clumps`: at one of 17 steps along each axis, so that distances tie, or anywhere; and `w`.
inline rc::Gen<glm::vec4> place_in(const std::vector<clump>& clumps, float w)
{
    return rc::gen::apply(
        [clumps, w](std::size_t number, const std::array<int, 3>& steps, bool ties) {
            const auto& c = clumps[number];
            glm::vec4 at(c.middle, w);
            for (int axis = 0; axis < c.axes; ++axis) {
                const int step = steps[static_cast<std::size_t>(axis)];
                at[axis] += c.extent * (ties ? static_cast<float>(step % 9) / 8 : static_cast<float>(step) * 0x1p-20f);
            }
            return at;
        },
        rc::gen::inRange<std::size_t>(0, clumps.size()),
        rc::gen::container<std::array<int, 3>>(rc::gen::inRange(-(1 << 20), (1 << 20) + 1)),
        rc::gen::arbitrary<bool>());
}

/// Up to `most` elements, more of them as RapidCheck's size grows. The elements do not grow with it.
template <class T>
rc::Gen<std::vector<T>> up_to(double most, const rc::Gen<T>& element)
{
    return rc::gen::scale(
        most / rc::kNominalSize, rc::gen::container<std::vector<T>>(rc::gen::resize(rc::kNominalSize, element)));
}

/// Keys to sort: below `distinct`, one in eight that of an invalid photon.
inline rc::Gen<std::vector<uint>> any_keys(uint distinct, double most)
{
    return up_to(
        most, rc::gen::weightedOneOf<uint>({{7, rc::gen::inRange(0u, distinct)}, {1, rc::gen::just(0xFFFFFFFFu)}}));
}

/// A number for each photon of a set: see make_photons() and make_oriented().
inline rc::Gen<std::vector<std::uint64_t>> photon_numbers(double most)
{
    return up_to(most, rc::gen::arbitrary<std::uint64_t>());
}

/// Any of the distributions on which searches break.
inline rc::Gen<distribution> any_distribution()
{
    return rc::gen::elementOf(std::vector<distribution>(std::begin(all_distributions), std::end(all_distributions)));
}

inline bool is_finite(const glm::vec4& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace photongrid::testing
