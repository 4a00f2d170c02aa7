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

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <ranges>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

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
    /// The number of elements of a V, if its type tells; else 3.
    template <class Reference>
    constexpr std::size_t known_length()
    {
        using V = std::remove_cvref_t<Reference>;
        if constexpr (std::is_array_v<V>)
            return std::extent_v<V>;
        else if constexpr (requires { std::tuple_size<V>::value; })
            return std::tuple_size_v<V>;
        else if constexpr (requires { std::integral_constant<std::size_t, V::length()>(); })
            return V::length(); // GLM
        else if constexpr (requires { std::integral_constant<std::size_t, V::extent>(); })
            return V::extent; // std::span
        else
            return 3;
    }
    template <class V>
    concept has_xyz = requires(const V& v)
    {
        static_cast<float>(v.x);
        static_cast<float>(v.y);
        static_cast<float>(v.z);
    };
    template <class V>
    concept has_elements = known_length<V>()
    >= 3 && requires(const V& v) { static_cast<float>(v[0]); };
    template <class V>
    concept vector_like = has_xyz<V> || has_elements<V>;
    template <class V>
    concept power_like = vector_like<V> || std::is_arithmetic_v<std::remove_cvref_t<V>>;

    /// A vector with components T; a number stands for three equal ones.
    template <class T, class V>
    glm::vec<3, T> to_vec(const V& v)
    {
        if constexpr (std::is_arithmetic_v<V>)
            return glm::vec<3, T>(static_cast<T>(v));
        else if constexpr (has_xyz<V>)
            return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
        else
            return {static_cast<T>(v[0]), static_cast<T>(v[1]), static_cast<T>(v[2])};
    }

    /// Whether C has more digits than float, as double and integers of 32 bits have.
    template <class C>
    inline constexpr bool exceeds_float
        = std::numeric_limits<C>::is_specialized ? (std::numeric_limits<C>::digits > std::numeric_limits<float>::digits)
                                                 : sizeof(C) > sizeof(float);
    /// The same for the components of a vector, or for a number.
    template <class V>
    constexpr bool has_doubles()
    {
        if constexpr (std::is_arithmetic_v<V>)
            return exceeds_float<V>;
        else if constexpr (has_xyz<V>)
            return exceeds_float<std::remove_cvref_t<decltype(std::declval<const V&>().x)>>;
        else
            return exceeds_float<std::remove_cvref_t<decltype(std::declval<const V&>()[0])>>;
    }

    /// Throws if a map cannot have so many photons or points. `what`: "caller: name".
    inline void check_map_size(const std::string& what, std::size_t n)
    {
        if (n > std::numeric_limits<uint>::max())
            throw std::invalid_argument(
                what + ": " + std::to_string(n) + " are more than the 2^32 - 1 that a map can hold");
    }

    /// The coordinates of up to 8,191 finite positions at equal intervals, axis by axis, each axis in ascending order.
    /// `read(i)`: position i, a glm::dvec3.
    template <class Read>
    std::array<std::vector<double>, 3> sampled_coordinates(std::size_t n, const Read& read)
    {
        constexpr std::size_t most = 8191;
        std::array<std::vector<double>, 3> axes;
        // If none of the sample is finite, the interval is halved.
        for (std::size_t step = std::max<std::size_t>(n / 4096, 1); step > 0 && axes[0].empty(); step /= 2)
            for (std::size_t i = 0; i < n && axes[0].size() < most; i += step)
                if (const glm::dvec3 p = read(i); std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        axes[axis].push_back(p[static_cast<int>(axis)]);
        for (auto& axis : axes)
            std::sort(axis.begin(), axis.end());
        return axes;
    }

    /// Throws if single precision is too coarse for these positions: if rounding moves coordinates by more than an
    /// eighth of the distance of neighbours, taken as that of points which are spread evenly over a cube. On a surface
    /// neighbours are closer; what is refused is wrong in any case. A sixteenth of the sample at either end of each
    /// axis does not count, so that strays decide nothing; fewer than 16 positions are not checked. `what`: "caller:
    /// name".
    template <class Read>
    void check_rounding(const std::string& what, std::size_t n, const Read& read)
    {
        const auto axes = sampled_coordinates(n, read);
        const std::size_t sampled = axes[0].size(), strays = sampled / 16;
        if (strays == 0)
            return; // too few to tell their distance
        double moved = 0, extent = 0;
        for (const auto& axis : axes) {
            extent = std::max(extent, axis[sampled - 1 - strays] - axis[strays]);
            for (std::size_t i = strays; i < sampled - strays; ++i)
                moved = std::max(moved, std::abs(axis[i] - static_cast<double>(static_cast<float>(axis[i]))));
        }
        const double apart = extent / std::cbrt(static_cast<double>(n));
        if (apart > 0 && moved * 8 > apart) {
            std::ostringstream message;
            message << what << ": single precision moves coordinates by up to " << moved
                    << " m, and neighbours are about " << apart
                    << " m apart; subtract an origin near them, or use photon_map or point_index, which do; positions "
                       "of float are not checked";
            throw std::invalid_argument(message.str());
        }
    }

    /// Uploads element(0) to element(n - 1), vectors of four.
    template <backend B, class Element>
    buffer_of<B, glm::vec4> upload_each(B& device, std::size_t n, const Element& element)
    {
        std::vector<glm::vec4> staged(n);
        for (std::size_t i = 0; i < n; ++i)
            staged[i] = element(i);
        return device.upload(std::span<const glm::vec4>(staged));
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
///
/// Positions in double precision are rounded to single precision as they are, without a change of origin.
/// \throws std::invalid_argument for more than 2^32 - 1 photons, and if rounding would move positions by more than an
///         eighth of the distance of neighbours, as happens far from 0 (photon_map avoids it; fewer than 16 photons are
///         not checked); backend_error if the device has no room.
/// \snippet snippets.cpp upload_photons
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && own_photon<std::ranges::range_value_t<Range>> photons<B> upload_photons(
    B& device, const Range& own)
{
    using P = std::ranges::range_value_t<Range>;
    using reader = photon_reader<P>;
    const auto n = static_cast<std::size_t>(std::ranges::size(own));
    detail::check_map_size("upload_photons: photons", n);
    const P* const from = std::ranges::data(own);
    if constexpr (detail::has_doubles<std::remove_cvref_t<decltype(reader::position(*from))>>())
        detail::check_rounding("upload_photons: positions", n,
            [&](std::size_t i) { return detail::to_vec<double>(reader::position(from[i])); });
    photons<B> p;
    p.positions = detail::upload_each(device, n, [&](std::size_t i) {
        bool caustic = false;
        if constexpr (requires { reader::caustic(from[i]); })
            caustic = reader::caustic(from[i]);
        return glm::vec4(detail::to_vec<float>(reader::position(from[i])), caustic ? 1.0f : 0.0f);
    });
    p.powers = detail::upload_each(
        device, n, [&](std::size_t i) { return glm::vec4(detail::to_vec<float>(reader::power(from[i])), 0.0f); });
    if constexpr (requires { reader::direction(*from); })
        p.directions = detail::upload_each(device, n,
            [&](std::size_t i) { return glm::vec4(detail::to_vec<float>(reader::direction(from[i])), 0.0f); });
    if constexpr (requires { reader::normal(*from); })
        p.normals = detail::upload_each(
            device, n, [&](std::size_t i) { return glm::vec4(detail::to_vec<float>(reader::normal(from[i])), 0.0f); });
    return p;
}

/// Uploads query points, m: a range of vectors of any type that photon_reader accepts. w is 1, so that each gets an
/// estimate. Doubles are rounded to single precision, as by upload_photons.
/// \throws std::invalid_argument as upload_photons for double positions that lie too far from 0 for their distances;
///         backend_error if the device has no room.
/// \snippet snippets.cpp upload_points
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && detail::vector_like<std::ranges::range_value_t<Range>>
    buffer_of<B, glm::vec4> upload_points(B& device, const Range& points)
{
    const auto* const from = std::ranges::data(points);
    const auto n = static_cast<std::size_t>(std::ranges::size(points));
    if constexpr (detail::has_doubles<std::ranges::range_value_t<Range>>())
        detail::check_rounding(
            "upload_points: points", n, [&](std::size_t i) { return detail::to_vec<double>(from[i]); });
    return detail::upload_each(
        device, n, [&](std::size_t i) { return glm::vec4(detail::to_vec<float>(from[i]), 1.0f); });
}

/// Uploads the unit normals of the surfaces that query points lie on, on the side that is seen: one per point, in the
/// points' order. w is 0.
/// \throws backend_error if the device has no room.
/// \snippet snippets.cpp upload_normals
template <backend B, std::ranges::contiguous_range Range>
requires std::ranges::sized_range<Range> && detail::vector_like<std::ranges::range_value_t<Range>>
    buffer_of<B, glm::vec4> upload_normals(B& device, const Range& normals)
{
    const auto* const from = std::ranges::data(normals);
    return detail::upload_each(device, static_cast<std::size_t>(std::ranges::size(normals)),
        [&](std::size_t i) { return glm::vec4(detail::to_vec<float>(from[i]), 0.0f); });
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
