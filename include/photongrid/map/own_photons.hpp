// Reads photons from the caller's own data: any contiguous range of structs, with any vector type.
//
//     struct particle { double where[3]; float mass; };
//     template <>
//     struct photongrid::photon_reader<particle> {
//         static auto position(const particle& p) { return std::span(p.where); }
//         static float power(const particle& p) { return p.mass; }
//     };
//     auto map = photongrid::sorted_map(device, photongrid::upload_photons(device, particles), grid);
//
// The map's `list` then holds indices into `particles`.
#pragma once

#include <photongrid/map/map_buffers.hpp>

#include <concepts>
#include <limits>
#include <ranges>
#include <span>
#include <type_traits>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Reads photons of type P. By default it uses the members `position` (m) and `power` (W) and, if P has them,
/// `direction` (of the photon, a unit vector), `normal` (of the surface, a unit vector) and `caustic` (whether the
/// photon counts as caustic light). Specialise it for structs with other names.
///
/// Positions, directions and normals may be of any type with members x, y, z or elements [0] to [2]. A power may be of
/// such a type, with the channels red, green and blue, or one number for all three.
/// \snippet snippets.cpp photon_reader
template <class P>
struct photon_reader {
    /// \name Members of a specialisation; position and power are required
    /// @{
    static const auto& position(const P& p) requires requires { p.position; }
    {
        return p.position;
    } ///< m
    static const auto& power(const P& p) requires requires { p.power; }
    {
        return p.power;
    } ///< W
    static const auto& direction(const P& p) requires requires { p.direction; }
    {
        return p.direction;
    } ///< unit vector; leak_policy::side needs it
    static const auto& normal(const P& p) requires requires { p.normal; }
    {
        return p.normal;
    } ///< of the surface, unit vector; leak_policy::min_cosine needs it
    static bool caustic(const P& p) requires requires { p.caustic; }
    {
        return p.caustic;
    } ///< true: caustic_part, false: other_part
    /// @}
};

namespace detail {
    template <class V>
    concept has_xyz = requires(const V& v)
    {
        static_cast<float>(v.x);
        static_cast<float>(v.y);
        static_cast<float>(v.z);
    };
    template <class V>
    concept has_elements = requires(const V& v)
    {
        static_cast<float>(v[0]);
    };
    template <class V>
    concept vector_like = has_xyz<V> || has_elements<V>;
    template <class V>
    concept power_like = vector_like<V> || std::is_arithmetic_v<std::remove_cvref_t<V>>;

    template <class V>
    glm::vec3 to_vec3(const V& v)
    {
        if constexpr (std::is_arithmetic_v<V>)
            return glm::vec3(static_cast<float>(v));
        else if constexpr (has_xyz<V>)
            return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
        else
            return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    }
} // namespace detail

/// A type that photon_reader can read.
template <class P>
concept own_photon = requires(const P& p)
{
    {
        photon_reader<P>::position(p)
        } -> detail::vector_like;
    {
        photon_reader<P>::power(p)
        } -> detail::power_like;
};

/// Uploads the caller's photons in their order. Directions and normals are uploaded if the type has them. Besides the
/// buffers it needs 16 bytes per photon while it runs.
/// \throws std::invalid_argument for more than 2^32 - 1 photons, backend_error if the device has no room.
/// \snippet snippets.cpp upload_photons
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && own_photon<std::ranges::range_value_t<Range>> photons<B> upload_photons(
    B& b, const Range& own)
{
    using P = std::ranges::range_value_t<Range>;
    using reader = photon_reader<P>;
    const auto n = static_cast<std::size_t>(std::ranges::size(own));
    if (n > std::numeric_limits<uint>::max())
        throw std::invalid_argument(
            "upload_photons: photons: " + std::to_string(n) + " are more than the 2^32 - 1 that a map can hold");
    const P* const from = std::ranges::data(own);
    std::vector<glm::vec4> staged(n);
    const auto upload = [&](auto&& element) {
        for (std::size_t i = 0; i < n; ++i)
            staged[i] = element(from[i]);
        return b.upload(std::span<const glm::vec4>(staged));
    };
    photons<B> p;
    p.positions = upload([](const P& o) {
        bool caustic = false;
        if constexpr (requires { reader::caustic(o); })
            caustic = reader::caustic(o);
        return glm::vec4(detail::to_vec3(reader::position(o)), caustic ? 1.0f : 0.0f);
    });
    p.powers = upload([](const P& o) { return glm::vec4(detail::to_vec3(reader::power(o)), 0.0f); });
    if constexpr (requires(const P& o) { reader::direction(o); })
        p.directions = upload([](const P& o) { return glm::vec4(detail::to_vec3(reader::direction(o)), 0.0f); });
    if constexpr (requires(const P& o) { reader::normal(o); })
        p.normals = upload([](const P& o) { return glm::vec4(detail::to_vec3(reader::normal(o)), 0.0f); });
    return p;
}

namespace detail {
    template <backend B, std::ranges::contiguous_range Range>
    buffer_of<B, glm::vec4> upload_vectors(B& b, const Range& vectors, float w)
    {
        std::vector<glm::vec4> staged;
        staged.reserve(static_cast<std::size_t>(std::ranges::size(vectors)));
        for (const auto& v : vectors)
            staged.emplace_back(to_vec3(v), w);
        return b.upload(std::span<const glm::vec4>(staged));
    }
} // namespace detail

/// Uploads query points, m: a range of vectors of any type that photon_reader accepts. w is 1, so that each gets an
/// estimate.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp upload_points
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && detail::vector_like<std::ranges::range_value_t<Range>>
    buffer_of<B, glm::vec4> upload_points(B& b, const Range& points)
{
    return detail::upload_vectors(b, points, 1.0f);
}

/// Uploads the unit normals of the surfaces that query points lie on, on the side that is seen: one per point, in the
/// points' order. w is 0.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp upload_normals
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && detail::vector_like<std::ranges::range_value_t<Range>>
    buffer_of<B, glm::vec4> upload_normals(B& b, const Range& normals)
{
    return detail::upload_vectors(b, normals, 0.0f);
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
