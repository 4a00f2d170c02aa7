// SIMD code for photons as structures of arrays, and their distances from a point. Included once per instruction set
// (Highway), so it has no include guard: search_simd.hpp includes grow_simd.hpp, and so on through gather_simd.hpp,
// packet_simd.hpp and rows_simd.hpp to this file; other files include simd.hpp.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <photongrid/backends/cpu/overrides/search_job.hpp>

#include <cmath>
#include <limits>

#include <photongrid/core/exact_begin.hpp>

HWY_BEFORE_NAMESPACE();
namespace photongrid::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A query point and its normal.
struct query {
    glm::vec3 at{0}, normal{0};
    kernels::HalfSpace before{}; ///< with search_job::half_spaces
};

/// The attributes of photons in the map or in a packet.
struct photon_vectors {
    soa_vectors<const float> positions, directions, normals; ///< the last two only where a policy needs them
};

/// A query, broadcast to all lanes.
struct query_lanes {
    vector x, y, z, normal_x, normal_y, normal_z;
    vector rounding2;                ///< see off_surface.glsl
    vector way_x, way_y, way_z, far; ///< see half_space.glsl
    HWY_INLINE explicit query_lanes(const query& q)
    {
        const floats d;
        x = hn::Set(d, q.at.x);
        y = hn::Set(d, q.at.y);
        z = hn::Set(d, q.at.z);
        normal_x = hn::Set(d, q.normal.x);
        normal_y = hn::Set(d, q.normal.y);
        normal_z = hn::Set(d, q.normal.z);
        const float rounding = (std::abs(q.at.x) + std::abs(q.at.y) + std::abs(q.at.z)) * 0x1p-17f;
        rounding2 = hn::Set(d, rounding * rounding + std::numeric_limits<float>::min());
        way_x = hn::Set(d, q.before.way.x);
        way_y = hn::Set(d, q.before.way.y);
        way_z = hn::Set(d, q.before.way.z);
        far = hn::Set(d, q.before.far);
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
    const auto plain2 = d2;
    if (POLICIES == 2 && j.flattening > 0) {
        const auto h = hn::Add(hn::Add(hn::Mul(dx, q.normal_x), hn::Mul(dy, q.normal_y)), hn::Mul(dz, q.normal_z));
        d2 = hn::Add(d2, hn::Mul(hn::Set(d, j.flattening), hn::Mul(h, h)));
    }
    d2 = hn::IfThenZeroElse(hn::Lt(d2, smallest), d2);
    if (POLICIES == 1 || (POLICIES == 2 && j.side))
        d2 = hn::IfThenElse(hn::Lt(along_normal(photons.directions), hn::Zero(d)), d2, rejected);
    if (POLICIES == 2 && j.needs_photon_normals) {
        const auto& m = photons.normals;
        const auto cosine = along_normal(m), one = hn::Set(d, 1.0f);
        const auto rise = hn::Add(hn::Add(hn::Mul(dx, hn::Add(q.normal_x, hn::LoadU(d, m.x + i))),
                                      hn::Mul(dy, hn::Add(q.normal_y, hn::LoadU(d, m.y + i)))),
            hn::Mul(dz, hn::Add(q.normal_z, hn::LoadU(d, m.z + i))));
        const auto share2 = hn::Add(hn::Mul(hn::Sub(one, cosine), hn::Add(one, cosine)), hn::Set(d, 0.04f));
        const auto on_surface
            = hn::Le(hn::Mul(rise, rise), hn::Add(hn::Mul(plain2, share2), q.rounding2)); // see is_off_surface
        d2 = hn::IfThenElse(hn::And(hn::Ge(cosine, hn::Set(d, j.min_cosine)), on_surface), d2, rejected);
    }
    if (POLICIES == 2 && j.half_spaces) {
        const auto along = hn::Add(hn::Add(hn::Mul(dx, q.way_x), hn::Mul(dy, q.way_y)), hn::Mul(dz, q.way_z));
        d2 = hn::IfThenElse(hn::Le(along, q.far), d2, rejected);
    }
    return d2;
}

} // namespace photongrid::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#include <photongrid/core/exact_end.hpp>
