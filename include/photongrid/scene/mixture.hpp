// Mixtures of two materials, such as rust on steel or dust on glass, and what a material does with those parts. A
// surface of a mixture scatters `share` of the light as the second part, the rest as the first.
#pragma once

#include <photongrid/scene/material.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The parts of a mixture; of another material that alone.
class material_parts {
public:
    /// They point to elements of `materials`, or to `m`.
    material_parts(std::span<const material> materials, const material& m) : parts_{&m, nullptr}
    {
        if (is_mixture(m))
            parts_ = {&materials[m.parts[0]], &materials[m.parts[1]]};
    }

    const material* const* begin() const { return parts_.data(); }
    const material* const* end() const { return parts_.data() + (parts_[1] != nullptr ? 2 : 1); }

private:
    std::array<const material*, 2> parts_;
};

/// The parts of a material.
inline material_parts parts_of(std::span<const material> materials, const material& m) { return {materials, m}; }

namespace detail {
    template <class Predicate>
    bool any_part(std::span<const material> materials, const material& m, Predicate predicate)
    {
        const auto parts = parts_of(materials, m);
        return std::any_of(parts.begin(), parts.end(), [&](const material* p) { return predicate(*p); });
    }
} // namespace detail

/// Whether surfaces of this material, or of a part of it, store photons.
inline bool is_diffuse(std::span<const material> materials, const material& m)
{
    return detail::any_part(materials, m, [](const material& p) { return is_diffuse(p); });
}

/// Whether light enters bodies of this material, or of a part of it.
inline bool refracts(std::span<const material> materials, const material& m)
{
    return detail::any_part(materials, m, [](const material& p) { return refracts(p); });
}

/// Whether the material, or a part of it, needs texture coordinates.
inline bool has_texture(std::span<const material> materials, const material& m)
{
    return has_texture(m) || detail::any_part(materials, m, [](const material& p) { return has_texture(p); });
}

/// Checks what a mixture consists of. The photon map holds what reaches the matter that stores photons, so that two
/// such parts must receive the same light: both have no coat.
/// \throws std::invalid_argument for a part that is not an index into `materials`, that is a mixture, or that is not
///         opaque everywhere; or for two parts that store photons, one of them below a coat.
inline void check_parts(std::span<const material> materials, const material& m)
{
    if (!is_mixture(m))
        return;
    for (const auto part : m.parts) {
        detail::require(part < materials.size(), "parts: must be indices into the scene's materials");
        detail::require(!is_mixture(materials[part]), "parts: is a mixture itself; mix two other materials");
        detail::require(!is_clear(materials[part]), "parts: has an opacity; give that to the mixture");
    }
    const auto &a = materials[m.parts[0]], &b = materials[m.parts[1]];
    detail::require(!(is_diffuse(a) && is_diffuse(b)) || (!is_coated(a) && !is_coated(b)),
        "parts: both store photons, and one has a coat; mix what has a coat with what reflects or refracts, or two "
        "without coats");
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
