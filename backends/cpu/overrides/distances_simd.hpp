// SIMD code for photons as structures of arrays, and their distances from a point. Included once per instruction set
// (Highway), so it has no include guard: search_simd.hpp includes grow_simd.hpp, and so on through gather_simd.hpp,
// packet_simd.hpp and rows_simd.hpp to this file; other files include simd.hpp.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <photongrid/backends/cpu/overrides/compress_table.hpp>
#include <photongrid/backends/cpu/overrides/search_job.hpp>

#include <limits>

#include <photongrid/backend/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using floats = hn::CappedTag<float, lanes>;
using uints = hn::RebindToUnsigned<floats>;
using ints = hn::RebindToSigned<floats>;
using vector = hn::VFromD<floats>;

/// Stores the lanes of the mask contiguously, and undefined values in the rest of a register's width. Returns the
/// number of lanes in the mask. It does not use Highway's CompressStore: for short registers g++ copies its tables to
/// the stack at every call, which made the whole search five times slower with AVX2, and AVX-512's instruction that
/// compresses to memory is microcode on AMD's Zen 4, where it did the same.
template <class D, class Mask>
HWY_INLINE std::size_t store_some(D d, hn::VFromD<D> v, Mask mask, hn::TFromD<D>* to)
{
    constexpr std::size_t width = hn::MaxLanes(d);
    if constexpr (width > 1 && width <= 8) {
        std::uint8_t bits[8]; // StoreMaskBits writes up to 8 bytes
        const std::size_t some = hn::CountTrue(d, mask);
        hn::StoreMaskBits(d, mask, bits);
        const std::int32_t* const order = compress_table<width>[bits[0]].data();
        hn::StoreU(hn::TableLookupLanes(v, hn::SetTableIndices(d, order)), d, to);
        return some;
    } else {
        hn::StoreU(hn::Compress(v, mask), d, to);
        return hn::CountTrue(d, mask);
    }
}

/// The lanes of a mask as bits, the first lane lowest.
template <class D>
HWY_INLINE uint bits_of(D d, hn::Mask<D> mask)
{
    std::uint8_t bits[8] = {}; // StoreMaskBits writes up to 8 bytes
    hn::StoreMaskBits(d, mask, bits);
    return bits[0] | static_cast<uint>(bits[1]) << 8;
}

/// A query point and its normal.
struct query {
    glm::vec3 at{0}, normal{0};
};

/// The attributes of photons in the map or in a packet.
struct photon_vectors {
    soa_vectors<const float> positions, directions, normals; ///< the last two only where a policy needs them
};

/// A query, broadcast to all lanes.
struct query_lanes {
    vector x, y, z, normal_x, normal_y, normal_z;
    HWY_INLINE explicit query_lanes(const query& q)
    {
        const floats d;
        x = hn::Set(d, q.at.x);
        y = hn::Set(d, q.at.y);
        z = hn::Set(d, q.at.z);
        normal_x = hn::Set(d, q.normal.x);
        normal_y = hn::Set(d, q.normal.y);
        normal_z = hn::Set(d, q.normal.z);
    }
};

/// Squared distances of a register of photons, from photon i on, as in photon_distance.glsl: photons that a policy
/// rejects are farther than any radius. POLICIES: 0: none, 1: only leak_policy::side, 2: any. `photons`:
/// photon_vectors, or the job itself for those of the map.
template <int POLICIES, class Photons>
HWY_INLINE vector squared_distances(const search_job& j, const query_lanes& q, const Photons& photons, std::size_t i)
{
    const floats d;
    const auto smallest = hn::Set(d, std::numeric_limits<float>::min()),
               rejected = hn::Set(d, std::numeric_limits<float>::max());
    const auto& at = photons.positions;
    const auto dx = hn::Sub(hn::LoadU(d, at.x + i), q.x), dy = hn::Sub(hn::LoadU(d, at.y + i), q.y),
               dz = hn::Sub(hn::LoadU(d, at.z + i), q.z);
    auto d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto along_normal = [&](const soa_vectors<const float>& v) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(hn::LoadU(d, v.x + i), q.normal_x), hn::Mul(hn::LoadU(d, v.y + i), q.normal_y)),
            hn::Mul(hn::LoadU(d, v.z + i), q.normal_z));
    };
    if (POLICIES == 2 && j.flattening > 0) {
        const auto h = hn::Add(hn::Add(hn::Mul(dx, q.normal_x), hn::Mul(dy, q.normal_y)), hn::Mul(dz, q.normal_z));
        d2 = hn::Add(d2, hn::Mul(hn::Set(d, j.flattening), hn::Mul(h, h)));
    }
    d2 = hn::IfThenZeroElse(hn::Lt(d2, smallest), d2);
    if (POLICIES == 1 || (POLICIES == 2 && j.side))
        d2 = hn::IfThenElse(hn::Lt(along_normal(photons.directions), hn::Zero(d)), d2, rejected);
    if (POLICIES == 2 && j.needs_photon_normals)
        d2 = hn::IfThenElse(hn::Ge(along_normal(photons.normals), hn::Set(d, j.min_cosine)), d2, rejected);
    return d2;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/backend/exact_end.hpp>
