// Materials, and the table of their kinds. Scene files, checks, the device's records and the reference renderer take
// names, keys, ranges and surfaces from the table. To add a kind: its enumerator and row here, and what a new kind of
// surface does: trace/bounce_photon.glsl, trace/eye_bounce.glsl and reference/bsdf.hpp.
#pragma once

#include <photongrid/scene/check.hpp>
#include <photongrid/scene/texture.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// How a surface scatters light. `metal` is a coloured mirror, which may be rough; `plastic` is Lambertian under a
/// clear coat, which may be rough.
enum class material_kind { lambertian, mirror, metal, glass, plastic };

/// A material.
struct material {
    std::string name;                               ///< any text; in a scene file, the key by which shapes refer to it
    material_kind kind = material_kind::lambertian; ///< how it scatters light
    /// Rgb, 0 to 1; of glass, the transmittance per crossing; of plastic, what is below the coat.
    dvec3 reflectance{0.5};
    double index_of_refraction = 1.5; ///< of glass and of the coat of plastic, 1 to 10; outside is air, 1
    double roughness = 0;  ///< but of Lambertian surfaces and mirrors, 0 to 1: the square root of GGX's alpha; below
                           ///< 0.001 it is smooth
    texture_use texture{}; ///< factor on the reflectance; on meshes with texture coordinates

    bool operator==(const material&) const = default;
};

/// What renderers do at a surface. Several kinds of material may have the same kind of surface. The values are those of
/// Material::kind in kernels (trace/scene_layout.glsl).
enum class surface_kind : std::uint32_t {
    diffuse = 0,    ///< stores photons, and ends eye rays
    reflecting = 1, ///< as a mirror
    refracting = 2, ///< reflects or refracts; bodies must not overlap
    coated = 3,     ///< reflects, or is diffuse below its coat
};

/// A member of `material` that a kind has.
struct material_field {
    const char* key;                                            ///< in scene files
    const char* name;                                           ///< of the member, in the messages of check()
    const char* what;                                           ///< for people, with its article: "a reflectance"
    std::variant<dvec3 material::*, double material::*> member; ///< rgb, or a number
    real_range range;                                           ///< of the number, or of each channel
    std::optional<double> if_absent;                            ///< its value where a file lacks it; none: it must not
};

/// A row of the table: a kind of material.
struct material_entry {
    material_kind kind;
    const char* name;                       ///< in scene files
    surface_kind surface;                   ///< what renderers do at it
    std::uint32_t switches;                 ///< the SWITCHes of its surface in kernels, as bits of launch::switches
    std::span<const material_field> fields; ///< in the order of scene files
};

namespace detail {
    constexpr material_field reflectance(const char* key, std::optional<double> if_absent = std::nullopt)
    {
        return {key, "reflectance", "a reflectance", &material::reflectance, {0, 1, ""}, if_absent};
    }
    inline constexpr material_field lambertian_fields[] = {reflectance("reflectance")};
    inline constexpr material_field mirror_fields[] = {reflectance("reflectance", 1)};
    inline constexpr material_field roughness
        = {"roughness", "roughness", "a roughness", &material::roughness, {0, 1, ""}, 0};
    inline constexpr material_field metal_fields[] = {reflectance("reflectance"), roughness};
    constexpr material_field index_of_refraction(std::optional<double> if_absent = std::nullopt)
    {
        return {"index_of_refraction", "index_of_refraction", "an index of refraction", &material::index_of_refraction,
            {1, 10, ""}, if_absent};
    }
    inline constexpr material_field glass_fields[]
        = {index_of_refraction(), reflectance("transmittance", 1), roughness};
    inline constexpr material_field plastic_fields[]
        = {reflectance("reflectance"), index_of_refraction(1.5), roughness};
} // namespace detail

/// All kinds of materials, in the order of material_kind.
inline constexpr std::array material_kinds{
    material_entry{material_kind::lambertian, "lambertian", surface_kind::diffuse, 0, detail::lambertian_fields},
    material_entry{material_kind::mirror, "mirror", surface_kind::reflecting, 1u << 4, detail::mirror_fields},
    material_entry{material_kind::metal, "metal", surface_kind::reflecting, 1u << 4, detail::metal_fields},
    material_entry{material_kind::glass, "glass", surface_kind::refracting, 1u << 5, detail::glass_fields},
    material_entry{material_kind::plastic, "plastic", surface_kind::coated, 1u << 19 | 1u << 4,
        detail::plastic_fields}, // reflects, too
};

static_assert(
    [] {
        for (std::size_t i = 0; i < material_kinds.size(); ++i)
            if (material_kinds[i].kind != static_cast<material_kind>(i))
                return false;
        return true;
    }(),
    "material_kinds: in the order of material_kind");

namespace detail {
    /// The row of a kind.
    /// \throws std::invalid_argument if it is not an enumerator.
    constexpr const material_entry& entry_of(material_kind k)
    {
        if (static_cast<std::size_t>(k) >= material_kinds.size())
            throw std::invalid_argument("kind: must be one of the enumerators");
        return material_kinds[static_cast<std::size_t>(k)];
    }
} // namespace detail

/// Whether surfaces of this material store photons.
inline bool is_diffuse(const material& m)
{
    const auto surface = detail::entry_of(m.kind).surface;
    return surface == surface_kind::diffuse || surface == surface_kind::coated;
}

/// Whether surfaces of this material are diffuse below a clear coat.
inline bool is_coated(const material& m) { return detail::entry_of(m.kind).surface == surface_kind::coated; }

/// Whether light enters bodies of this material.
inline bool refracts(const material& m) { return detail::entry_of(m.kind).surface == surface_kind::refracting; }

/// Whether surfaces of this material reflect and refract by facets (trace/microfacet.glsl).
inline bool is_rough(const material& m)
{
    const auto& fields = detail::entry_of(m.kind).fields;
    const auto says_so = [](const material_field& f) {
        const auto* number = std::get_if<double material::*>(&f.member);
        return number != nullptr && *number == &material::roughness;
    };
    return m.roughness >= 0.001 && std::any_of(fields.begin(), fields.end(), says_so);
}

/// The parameter alpha of the distribution of facets (GGX); 0 of smooth surfaces.
inline double alpha_of(const material& m) { return is_rough(m) ? m.roughness * m.roughness : 0; }

/// \throws std::invalid_argument for a member that the kind has and that is out of its range: a reflectance outside 0
/// to 1, an index of refraction outside 1 to 10, or a roughness outside 0 to 1; or a texture that check()
/// rejects.
inline void check(const material& m)
{
    for (const auto& f : detail::entry_of(m.kind).fields)
        std::visit(
            [&](auto member) {
                const auto& v = m.*member;
                if constexpr (requires { v.x; })
                    detail::require(f.range.has(v.x) && f.range.has(v.y) && f.range.has(v.z),
                        std::string(f.name) + ": each channel must be from " + f.range.ends());
                else
                    f.range.check(f.name, v);
            },
            f.member);
    check(m.texture);
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
