// Materials.
#pragma once

#include <photongrid/scene/check.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// How a surface scatters light. `metal` is a coloured mirror.
enum class material_kind { lambertian, mirror, metal, glass };

/// A material.
struct material {
    std::string name;                               ///< any text; in a scene file, the key by which shapes refer to it
    material_kind kind = material_kind::lambertian; ///< how it scatters light
    dvec3 reflectance{0.5};                         ///< rgb, 0 to 1; of glass, the transmittance per crossing
    double index_of_refraction = 1.5;               ///< of glass, 1 to 10; outside is air, 1

    bool operator==(const material&) const = default;
};

/// \throws std::invalid_argument for a reflectance outside 0 to 1, or glass with an index of refraction outside 1
/// to 10.
inline void check(const material& m)
{
    const auto& r = m.reflectance;
    detail::require(detail::finite(r) && r.x >= 0 && r.y >= 0 && r.z >= 0 && r.x <= 1 && r.y <= 1 && r.z <= 1,
        "reflectance: each channel must be from 0 to 1");
    if (m.kind == material_kind::glass)
        detail::require(
            detail::finite(m.index_of_refraction) && m.index_of_refraction >= 1 && m.index_of_refraction <= 10,
            "index_of_refraction: must be from 1 to 10");
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
