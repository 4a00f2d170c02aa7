// SIMD code that computes the bias of an estimate from the photons that its search found. Included once per instruction
// set, so it has no include guard; other files include simd.hpp.
#include <photongrid/backends/cpu/overrides/gather_simd.hpp>
#include <photongrid/estimate/bias_estimate.kernel.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// curve_weight() and jump_weight() of estimate/bias_weights.glsl in vectors.
HWY_INLINE vector curve_weight_of(vector t)
{
    const floats d;
    return hn::Sub(hn::Mul(hn::Set(d, 2.0f), t), hn::Set(d, 1.0f));
}
HWY_INLINE vector jump_weight_of(vector t)
{
    const floats d;
    const auto rho = hn::Sqrt(t);
    const auto inverse = hn::IfThenElseZero(hn::Gt(rho, hn::Set(d, 1e-9f)), hn::Div(hn::Set(d, 1.0f), rho));
    return hn::Sub(inverse, hn::Set(d, 1.33333333f));
}

/// Computes and stores the bias of the estimate at a point with the radius `r`, as gather_bias.glsl and
/// bias_estimate.glsl do, from the packet's photons and their distances.
HWY_NOINLINE inline void store_bias(const search_job& j, uint point, chosen_radius r, const packet& near)
{
    const floats d;
    constexpr std::size_t width = hn::MaxLanes(d);
    const std::size_t n = near.size();
    const float* const distances = near.of(packet::squared_distance);
    const glm::vec4 at = j.points[point], normal = j.in_plane ? j.point_normals[point] : glm::vec4(0);
    const float disc2 = std::max(r.radius2, kernels::least_disc2(at, j.min_radius2));
    const auto radius2 = hn::Set(d, r.radius2), inverse = hn::Set(d, 1.0f / disc2), one = hn::Set(d, 1.0f),
               per_radius = hn::Set(d, 1.0f / (3.0f * std::sqrt(disc2)));
    lane_sums even[3], slope[3], tilt[3], jump[3];
    for (std::size_t i = 0; i < n;) {
        for (const std::size_t stop = std::min(n, i + lane_sums::few * lanes); i < stop;)
            for (std::size_t group = 0; group < lanes / width; ++group, i += width) {
                const auto d2 = hn::Load(d, distances + i);
                const auto counts = hn::Lt(d2, radius2);
                const auto t = hn::Min(hn::Mul(d2, inverse), one);
                const auto curve = curve_weight_of(t), bent = jump_weight_of(t);
                auto flux = hn::Zero(d), above = hn::Zero(d);
                vector offset[3];
                for (int c = 0; c < 3; ++c) {
                    const auto power = hn::IfThenElseZero(
                        counts, hn::Load(d, near.of(static_cast<packet::component>(packet::red + c)) + i));
                    even[c].add(group, power);
                    slope[c].add(group, hn::IfThenElseZero(counts, hn::Mul(power, curve)));
                    flux = hn::Add(flux, power);
                    offset[c] = hn::Sub(
                        hn::Load(d, near.of(static_cast<packet::component>(packet::x + c)) + i), hn::Set(d, at[c]));
                    above = hn::Add(above, hn::Mul(offset[c], hn::Set(d, normal[c])));
                }
                flux = hn::Mul(flux, per_radius);
                for (int c = 0; c < 3; ++c) {
                    const auto in_plane = hn::Sub(offset[c], hn::Mul(above, hn::Set(d, normal[c])));
                    const auto moment = hn::IfThenElseZero(counts, hn::Mul(in_plane, flux));
                    tilt[c].add(group, moment);
                    jump[c].add(group, hn::IfThenElseZero(counts, hn::Mul(moment, bent)));
                }
            }
        for (int c = 0; c < 3; ++c)
            for (auto* const sums : {even, slope, tilt, jump})
                sums[c].flush();
    }
    glm::vec4 totals[4];
    for (int c = 0; c < 3; ++c)
        totals[0][c] = even[c].total(0), totals[1][c] = slope[c].total(0), totals[2][c] = tilt[c].total(0),
        totals[3][c] = jump[c].total(0);
    const glm::vec4 radius(0, 0, 0, r.radius2);
    kernels::bias_estimate e;
    e.args = {.min_radius2 = j.min_radius2, .factor = j.bias_factor};
    e.bind(slot<0>{}, std::span(totals, 1));
    e.bind(slot<1>{}, std::span(totals + 1, 1));
    e.bind(slot<2>{}, std::span(totals + 2, 1));
    e.bind(slot<3>{}, std::span(totals + 3, 1));
    e.bind(slot<4>{}, std::span(&radius, 1));
    e.bind(slot<5>{}, std::span(j.points + point, 1));
    e.kernel(0);
    j.biases.bias[point] = e.bias;
    j.biases.tilt[point] = e.tilt;
    j.biases.jump[point] = e.jump;
    j.biases.constant[point] = e.constant;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
