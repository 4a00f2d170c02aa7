// The bias of estimates, from their own photons (docs/design/decisions.md, "The bias is estimated"). A search for a
// radius and an estimate come first; this is one more walk over the photons of each disc.
//
//     bias_start -> gather_bias -> bias_estimate
#pragma once

#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/estimate/bias_estimate.kernel.hpp>
#include <photongrid/estimate/bias_start.kernel.hpp>
#include <photongrid/estimate/gather_bias.kernel.hpp>
#include <photongrid/estimate/knn_settings.hpp>

#include <array>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The biases of estimates, one per query point in each buffer.
template <backend B>
struct estimate_biases {
    /// rgb: how much too high the estimate is on the average, W/m^2, as far as the light's curvature over the disc
    /// tells. It has noise of its own: by Silverman's filter 0.65 of the estimate's, by the constant one 1.73.
    buffer_of<B, glm::vec4> bias;
    // Two moments of the light over the disc, W/m^2, mean of the channels, which find steps of the light
    // (render/pixel_bias.hpp). Where the light steps by H on a line through the point, across the line:
    buffer_of<B, glm::vec4> tilt;     ///< xyz: the first moment, 2 H / (3 pi). A slope of g, W/m^3, gives g r / 4
    buffer_of<B, glm::vec4> jump;     ///< xyz: one that is 0 where light has a slope, H / (9 pi)
    buffer_of<B, glm::vec4> constant; ///< rgb: the irradiance by the constant filter, W/m^2

    /// All of them, for passes over each.
    std::array<buffer_of<B, glm::vec4>*, 4> all() { return {&bias, &tilt, &jump, &constant}; }
};

namespace detail {
    /// Biases of 0.
    template <backend B>
    estimate_biases<B> no_biases(B& device, std::size_t n)
    {
        estimate_biases<B> none;
        for (auto* buffer : none.all()) {
            *buffer = device.template make<glm::vec4>(n);
            device.template run<kernels::zero_vectors>(n, {}, reads(), writes(*buffer));
        }
        return none;
    }

    /// The sums over the photons of estimates that report their biases, in steps.
    template <backend B>
    class bias_sums {
    public:
        /// `irradiances`: of the estimates; w: squared radius, m^2.
        bias_sums(const search_inputs<B>& in, buffer_of<B, glm::vec4> irradiances);

        /// Runs at most `passes` more passes over the points that are not done.
        progress advance(uint passes);

        /// The biases, if the sums are finished.
        estimate_biases<B> biases();

    private:
        search_inputs<B> in_;
        buffer_of<B, glm::vec4> irradiances_, even_, slope_, tilt_, jump_;
        buffer_of<B, glm::uvec4> cursor_, tally_;
    };

    template <backend B>
    bias_sums<B>::bias_sums(const search_inputs<B>& in, buffer_of<B, glm::vec4> irradiances)
        : in_(in), irradiances_(std::move(irradiances)), even_(in.template make<glm::vec4>()),
          slope_(in.template make<glm::vec4>()), tilt_(in.template make<glm::vec4>()),
          jump_(in.template make<glm::vec4>()), cursor_(in.template make<glm::uvec4>()),
          tally_(in.template make<glm::uvec4>())
    {
        in_.device->template run<kernels::bias_start>(in_.points->size(), {.searching = in_.searching() ? 1u : 0u},
            reads(*in_.points), writes(even_, slope_, tilt_, jump_, cursor_, tally_));
    }

    template <backend B>
    progress bias_sums<B>::advance(uint passes)
    {
        const map_buffers<B>& m = *in_.map;
        return in_.device->template run_until_done<kernels::gather_bias>(
            {in_.points->size(), 0u,
                in_.template map_switches<kernels::gather_bias>() | in_.template halved<kernels::gather_bias>()
                    | in_.template together<kernels::gather_bias>()},
            {.grid = m.cells_of,
                .leaks = in_.leaks(),
                .min_radius2 = in_.min_radius2(),
                .in_plane = in_.normals != nullptr ? 1.0f : 0.0f,
                .visits = in_.s.visits_per_pass,
                .ranges = in_.s.ranges_per_pass,
                .levels = m.levels,
                .in_blocks = m.in_blocks},
            reads(*in_.points, in_.point_normals(), m.cells, m.photons.positions, in_.directions(),
                in_.photon_normals(), m.photons.powers, m.boxes, irradiances_),
            writes(even_, slope_, tilt_, jump_, cursor_, tally_), passes);
    }

    template <backend B>
    estimate_biases<B> bias_sums<B>::biases()
    {
        estimate_biases<B> e;
        for (auto* buffer : e.all())
            *buffer = in_.template make<glm::vec4>();
        in_.device->template run<kernels::bias_estimate>(in_.points->size(),
            {.min_radius2 = in_.min_radius2(), .factor = bias_factor(in_.s.filter)},
            reads(even_, slope_, tilt_, jump_, irradiances_, *in_.points), writes(e.constant, e.bias, e.tilt, e.jump));
        return e;
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
