// SIMD code that reads photons and finds which of them a map holds. Included once per instruction set, so it has no
// include guard; other files include simd.hpp.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <photongrid/backends/cpu/buffer.hpp>
#include <photongrid/map/grid.kernel.hpp>
#include <photongrid/map/map_buffers.hpp>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A register of photons.
struct photon_register {
    using floats_tag = hn::CappedTag<float, lanes>;
    using uints_tag = hn::RebindToUnsigned<floats_tag>;
    hn::VFromD<floats_tag> x, y, z;              ///< positions, m
    hn::Mask<uints_tag> is_invalid, is_left_out; ///< as in map_buffers
};

/// Loads the photons from number i on. `powers`: null for points, which have none. `parts`: of the light.
HWY_INLINE photon_register load_photons(const glm::vec4* positions, const glm::vec4* powers, uint parts, std::size_t i)
{
    const photon_register::floats_tag d;
    const photon_register::uints_tag du;
    const auto exponent = hn::Set(du, 0x7F800000u);
    auto x = hn::Zero(d), y = x, z = x, w = x, red = x, green = x, blue = x, unused = x;
    hn::LoadInterleaved4(d, &positions[i].x, x, y, z, w);
    if (powers != nullptr)
        hn::LoadInterleaved4(d, &powers[i].x, red, green, blue, unused);
    auto bad = hn::Zero(du);
    for (const auto& v : {x, y, z, red, green, blue})
        bad = hn::Or(bad, hn::VecFromMask(du, hn::Eq(hn::And(hn::BitCast(du, v), exponent), exponent)));
    const auto caustic = hn::RebindMask(du, hn::Eq(w, hn::Set(d, 1.0f)));
    const auto part = hn::IfThenElse(caustic, hn::Set(du, caustic_part), hn::Set(du, other_part));
    return {x, y, z, hn::Ne(bad, hn::Zero(du)), hn::Eq(hn::And(part, hn::Set(du, parts)), hn::Zero(du))};
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
