// Materials, and the table of their kinds. Scene files, checks, the device's records and the reference renderer take
// names, keys, ranges and surfaces from the table. To add a kind: its enumerator and row here, and what a new kind of
// surface does: trace/scatter.glsl and reference/bsdf.hpp (docs/guide/add_a_material.md).
#pragma once

#include <photongrid/scene/check.hpp>
#include <photongrid/scene/texture.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// How a surface scatters light. `metal` is a coloured mirror, which may be rough; `plastic` is Lambertian under a
/// clear coat, which may be rough; a `mixture` scatters a share of the light as one material, the rest as another;
/// `thin_glass` is a pane of glass as one surface.
enum class material_kind { lambertian, mirror, metal, glass, plastic, mixture, thin_glass };

/// What becomes of the light that one facet of rough metal or glass sends to another.
enum class facet_bounces {
    multiple, ///< it is scattered again, until it leaves
    single,   ///< it is lost
};
inline constexpr std::array<const char*, 2> facet_bounces_names{"multiple", "single"}; ///< in scene files

/// A material.
struct material {
    std::string name;                               ///< any text; in a scene file, the key by which shapes refer to it
    material_kind kind = material_kind::lambertian; ///< how it scatters light
    /// Rgb, 0 to 1; of glass, the transmittance per crossing, of thin glass that of what passes; of plastic, what is
    /// below the coat.
    dvec3 reflectance{0.5};
    /// Of glass, thin or not, and of the coat of plastic, 1 to 10; of glass from 0.1 on, as of bubbles in water. Air
    /// has 1.
    double index_of_refraction = 1.5;
    double roughness = 0;  ///< but of Lambertian surfaces and mirrors, 0 to 1: the square root of GGX's alpha; below
                           ///< 0.001 it is smooth
    texture_use texture{}; ///< factor on the reflectance; on meshes with texture coordinates, as all textures
    double opacity = 1;    ///< of meshes, 0 to 1: the share of light that meets the surface; the rest goes straight on
    texture_use opacity_texture{};                  ///< factor on it
    texture_use roughness_texture{};                ///< factor on the roughness of metal and glass
    std::array<std::uint32_t, 2> parts{0, 0};       ///< of a mixture: indices of other materials (scene/mixture.hpp)
    double share = 0.5;                             ///< of the second part, 0 to 1
    texture_use share_texture{};                    ///< factor on it
    facet_bounces energy = facet_bounces::multiple; ///< of metal and glass
    /// Of glass: what its inside absorbs of light on its way, rgb, 1/m: e^-absorption is left after a metre.
    dvec3 absorption{0};
    /// Of glass, 0 to 1000: where bodies overlap, the one of the highest priority is there; of equal ones the smallest.
    /// 0: the surface is an interface of its own: its index of refraction is relative to what lies outside.
    double priority = 1;

    bool operator==(const material&) const = default;
};

/// What renderers do at a surface. Several kinds of material may have the same kind of surface. The values are those of
/// Material::kind in kernels (trace/scene_layout.glsl).
enum class surface_kind : std::uint32_t {
    diffuse = 0,    ///< stores photons, and ends eye rays
    reflecting = 1, ///< as a mirror
    refracting = 2, ///< reflects or refracts
    coated = 3,     ///< reflects, or is diffuse below its coat
    mixed = 4,      ///< that of one of its parts
    thin = 5,       ///< reflects, or lets light pass straight on; if it is rough, spread by facets
};

/// A member of `material` that a kind has.
struct material_field {
    const char* key;                                            ///< in scene files
    const char* name;                                           ///< of the member, in the messages of check()
    const char* what;                                           ///< for people, with its article: "a reflectance"
    std::variant<dvec3 material::*, double material::*> member; ///< rgb, or a number
    real_range range;                                           ///< of the number, or of each channel
    std::optional<double> if_absent;                            ///< its value where a file lacks it; none: it must not
    texture_use material::*texture = nullptr; ///< factor on a number, in scene files `key`_texture; null: it has none
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
    inline constexpr material_field opacity
        = {"opacity", "opacity", "an opacity", &material::opacity, {0, 1, ""}, 1, &material::opacity_texture};
    inline constexpr material_field lambertian_fields[] = {reflectance("reflectance"), opacity};
    inline constexpr material_field mirror_fields[] = {reflectance("reflectance", 1), opacity};
    inline constexpr material_field roughness
        = {"roughness", "roughness", "a roughness", &material::roughness, {0, 1, ""}, 0, &material::roughness_texture};
    inline constexpr material_field roughness_of_coat
        = {"roughness", "roughness", "a roughness", &material::roughness, {0, 1, ""}, 0};
    inline constexpr material_field metal_fields[] = {reflectance("reflectance"), roughness, opacity};
    constexpr material_field index_of_refraction(std::optional<double> if_absent = std::nullopt, double least = 1)
    {
        return {"index_of_refraction", "index_of_refraction", "an index of refraction", &material::index_of_refraction,
            {least, 10, ""}, if_absent};
    }
    inline constexpr material_field absorption
        = {"absorption", "absorption", "an absorption", &material::absorption, {0, 1e9, " 1/m"}, 0};
    inline constexpr material_field priority
        = {"priority", "priority", "a priority", &material::priority, {0, 1000, ""}, 1};
    inline constexpr material_field glass_fields[] = {index_of_refraction(std::nullopt, 0.1),
        reflectance("transmittance", 1), roughness, absorption, priority, opacity};
    inline constexpr material_field thin_glass_fields[]
        = {index_of_refraction(1.5), reflectance("transmittance", 1), roughness, opacity};
    inline constexpr material_field plastic_fields[]
        = {reflectance("reflectance"), index_of_refraction(1.5), roughness_of_coat, opacity};
    inline constexpr material_field mixture_fields[] = {
        {"share", "share", "a share", &material::share, {0, 1, ""}, std::nullopt, &material::share_texture}, opacity};
} // namespace detail

/// All kinds of materials, in the order of material_kind.
inline constexpr std::array material_kinds{
    material_entry{material_kind::lambertian, "lambertian", surface_kind::diffuse, 0, detail::lambertian_fields},
    material_entry{material_kind::mirror, "mirror", surface_kind::reflecting, 1u << 4, detail::mirror_fields},
    material_entry{material_kind::metal, "metal", surface_kind::reflecting, 1u << 4, detail::metal_fields},
    material_entry{material_kind::glass, "glass", surface_kind::refracting, 1u << 5, detail::glass_fields},
    material_entry{material_kind::plastic, "plastic", surface_kind::coated, 1u << 19 | 1u << 4,
        detail::plastic_fields}, // reflects, too
    material_entry{material_kind::mixture, "mixture", surface_kind::mixed, 1u << 21, detail::mixture_fields},
    material_entry{material_kind::thin_glass, "thin_glass", surface_kind::thin, 1u << 5, detail::thin_glass_fields},
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

/// Whether a material is a mixture of two others. What follows knows nothing of these: see scene/mixture.hpp.
inline bool is_mixture(const material& m) { return detail::entry_of(m.kind).surface == surface_kind::mixed; }

/// Whether the material has an opacity: some light does not meet its surfaces.
inline bool is_clear(const material& m) { return m.opacity < 1 || m.opacity_texture.map; }

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

/// Whether surfaces of this material are panes of thin glass.
inline bool is_thin(const material& m) { return detail::entry_of(m.kind).surface == surface_kind::thin; }

/// Whether such panes let light pass straight on, here or where a texture has the roughness 0.
inline bool is_smooth_pane(const material& m) { return is_thin(m) && (!is_rough(m) || m.roughness_texture.map); }

/// The parameter alpha of the distribution of facets (GGX); 0 of smooth surfaces.
inline double alpha_of(const material& m) { return is_rough(m) ? m.roughness * m.roughness : 0; }

/// Whether a kind of material has the member `energy`. A coat passes to its base what its facets hide.
inline bool has_energy(const material_entry& kind)
{
    return kind.surface != surface_kind::coated && kind.surface != surface_kind::thin
        && std::any_of(kind.fields.begin(), kind.fields.end(),
            [](const material_field& f) { return f.texture == &material::roughness_texture; });
}

/// Whether light is scattered by several facets of the material, one after the other (trace/rebounds.glsl).
inline bool has_rebounds(const material& m)
{
    return m.energy == facet_bounces::multiple && is_rough(m) && has_energy(detail::entry_of(m.kind));
}

namespace detail {
    /// The textures of a material that are numbers, by their names in scene files.
    inline constexpr std::array<std::pair<const char*, texture_use material::*>, 3> number_textures{
        {{"roughness_texture", &material::roughness_texture}, {"opacity_texture", &material::opacity_texture},
            {"share_texture", &material::share_texture}}};

    /// The key of such a texture in scene files.
    constexpr const char* texture_key(texture_use material::*texture)
    {
        for (const auto& [name, member] : number_textures)
            if (member == texture)
                return name;
        return nullptr;
    }

    /// Whether the kind of material has a number on which this texture is a factor.
    inline bool has_texture(const material& m, texture_use material::*texture)
    {
        const auto& fields = entry_of(m.kind).fields;
        return std::any_of(fields.begin(), fields.end(), [&](const auto& f) { return f.texture == texture; });
    }
} // namespace detail

/// Whether the material needs texture coordinates.
inline bool has_texture(const material& m)
{
    return m.texture.map
        || std::any_of(detail::number_textures.begin(), detail::number_textures.end(),
            [&](const auto& t) { return (m.*t.second).map != nullptr; });
}

/// \throws std::invalid_argument for a member that the kind has and that is out of its range: a reflectance, a
/// roughness, an opacity or a share outside 0 to 1, or an index of refraction outside 1 to 10, of
/// glass 0.1 to 10; or a texture that
/// check() rejects or that the kind does not have.
inline void check(const material& m)
{
    detail::require(!is_mixture(m) || !m.texture.map, "texture: of a mixture; give its parts one");
    detail::require(
        static_cast<std::size_t>(m.energy) < facet_bounces_names.size(), "energy: must be one of the enumerators");
    for (const auto& [name, texture] : detail::number_textures) {
        detail::require(!(m.*texture).map || detail::has_texture(m, texture),
            std::string(name) + ": " + detail::entry_of(m.kind).name + " has none");
        check(m.*texture);
    }
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

#include <photongrid/core/exact_end.hpp>
