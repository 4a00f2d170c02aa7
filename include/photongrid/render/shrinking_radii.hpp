// Radii that shrink from pass to pass (Knaus and Zwicker, Progressive Photon Mapping: A Probabilistic Approach, ACM
// Transactions on Graphics 30(3), 2011), so that the blur of estimates goes to 0 as passes are added. The first radius
// of a point is what the search of the settings finds there in a map of its own, whose photons are in no pass. That map
// has fewer photons, of which as many times fewer are sought. All points' radii shrink by the same given sequence, so
// that passes do not depend on each other.
#pragma once

#include <photongrid/map/map_buffers.hpp>
#include <photongrid/render/shrunk_radius.kernel.hpp>
#include <photongrid/scene/render_settings.hpp>

#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The number of the pass whose photons give the first radii.
inline constexpr std::uint32_t radius_pass = 0xFFFFFFFFu;

/// The share of the first squared radius in pass number `pass`: the product of (i - 1 + alpha) / i for i from 1 to
/// `pass`, with alpha = 2/3. It falls as pass^(alpha - 1), by which noise and blur fall at the same rate.
inline double shrunk_share2(std::uint32_t pass)
{
    constexpr double alpha = 2.0 / 3;
    double share2 = 1;
    for (double i = 1; i <= pass; ++i)
        share2 *= (i - 1 + alpha) / i;
    return share2;
}

/// The most photons sought for a first radius. The squared radius has a relative standard deviation of 1 / sqrt(k),
/// which adds little to noise and blur; to find more photons takes time at every point.
inline constexpr std::uint32_t most_for_first_radius = 25;

/// Where the first radii of points come from.
template <backend B>
struct first_radii {
    const map_buffers<B>* map = nullptr; ///< null: each pass finds its own radii
    uint k = 0;                          ///< the photons sought in it
};

/// The radii of a pass.
template <backend B>
struct pass_radii {
    std::vector<first_radii<B>> firsts{}; ///< of each light map of the pass; empty: it finds its own
    double share2 = 1;                    ///< shrunk_share2 of the pass

    /// Those of the light map with this number.
    first_radii<B> first(std::size_t number) const { return firsts.empty() ? first_radii<B>{} : firsts.at(number); }
    /// Those of caustic photons, whichever map they are in.
    first_radii<B> of_caustics() const { return firsts.empty() ? first_radii<B>{} : firsts.back(); }
};

namespace detail {
    /// Points with the radii of a pass. `firsts`: w: squared radii in the first map, m^2; `share2`: of them.
    template <backend B>
    buffer_of<B, glm::vec4> points_with_radii(B& device, const buffer_of<B, glm::vec4>& points,
        const buffer_of<B, glm::vec4>& firsts, double share2, float max_radius2)
    {
        auto own = device.template make<glm::vec4>(points.size());
        device.template run<kernels::shrunk_radius>(points.size(),
            {.share2 = static_cast<float>(share2), .max_radius2 = max_radius2}, reads(points, firsts), writes(own));
        return own;
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
