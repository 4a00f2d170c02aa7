// Materials: how surfaces answer light.
#pragma once

#include <photongrid/scene/check.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// How a surface answers light. `metal` is a mirror with a colour.
enum class material_kind { lambertian, mirror, metal, glass };

/// A material. Reflectance per channel (rgb), 0 to 1; for glass it is the transmittance of each crossing (1: clear).
struct material {
    std::string name;                               ///< free; in a scene file, the key that shapes name it by
    material_kind kind = material_kind::lambertian; ///< what `reflectance` means
    dvec3 reflectance{0.5};                         ///< rgb, 0 to 1: see above
    double index_of_refraction = 1.5;               ///< glass only, 1 to 10; air, 1, is outside

    bool operator==(const material&) const = default; ///< of every member
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
