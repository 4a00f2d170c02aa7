// Views of a host's vectors: a range of vectors, or a member of a range of structs.
#pragma once

#include <photongrid/map/own_photons.hpp>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

namespace detail {
    template <class V>
    glm::dvec3 to_dvec3(const V& v)
    {
        if constexpr (std::is_arithmetic_v<V>)
            return glm::dvec3(static_cast<double>(v));
        else if constexpr (has_xyz<V>)
            return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
        else
            return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
    }

    /// Whether V has components with more precision than a float.
    template <class V>
    constexpr bool has_doubles()
    {
        if constexpr (std::is_arithmetic_v<V>)
            return sizeof(V) > sizeof(float);
        else if constexpr (has_xyz<V>)
            return sizeof(std::declval<const V&>().x) > sizeof(float);
        else
            return sizeof(std::declval<const V&>()[0]) > sizeof(float);
    }

    // clang-format off
    template <class Range>
    concept vector_range = std::ranges::contiguous_range<Range> && std::ranges::sized_range<Range>
        && power_like<std::ranges::range_value_t<Range>>;
    /// A range whose elements outlive it, or an lvalue (Range is then a reference).
    template <class Range>
    concept lasting_vector_range = vector_range<Range> && std::ranges::borrowed_range<Range>;
    // clang-format on
} // namespace detail

/// A view of a host's vectors or numbers, which must outlive it. It can be made from any contiguous range of numbers or
/// of vectors that photon_reader accepts, but not from a temporary that owns them. A number stands for three equal
/// components.
class vector_view {
public:
    vector_view() = default;
    template <detail::lasting_vector_range Range>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): a vector_view is no range, so copies are not hidden
    vector_view(Range&& range)
        : vector_view(
            std::ranges::data(range), static_cast<std::size_t>(std::ranges::size(range)),
            [](const std::ranges::range_value_t<Range>& v) -> const auto& { return v; })
    {
    }
    /// A view of a member of structs: `read`, a function object without state, returns the member.
    template <class T, class Read>
    vector_view(const T* first, std::size_t size, Read)
        : data_(first), size_(size),
          has_doubles_(detail::has_doubles<std::remove_cvref_t<std::invoke_result_t<Read, const T&>>>()),
          read_(
              [](const void* data, std::size_t i) { return detail::to_dvec3(Read{}(static_cast<const T*>(data)[i])); })
    {
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    glm::dvec3 operator[](std::size_t i) const { return read_(data_, i); }
    /// Whether the components have more precision than a float.
    bool has_doubles() const { return has_doubles_; }

private:
    const void* data_ = nullptr;
    std::size_t size_ = 0;
    bool has_doubles_ = false;
    glm::dvec3 (*read_)(const void*, std::size_t) = nullptr;
};

/// A vector_view as a parameter: it may also be made from a temporary range, which lives until the call returns. Not to
/// be kept.
class vector_argument : public vector_view {
public:
    vector_argument(const vector_view& view) : vector_view(view) {}
    template <detail::vector_range Range>
    vector_argument(const Range& range) : vector_view(range)
    {
    }
};

/// Photons whose attributes are in separate arrays, with one element per photon. Directions and normals may be left
/// out.
struct photon_attributes {
    vector_view positions{};  ///< m
    vector_view powers{};     ///< W
    vector_view directions{}; ///< unit vectors
    vector_view normals{};    ///< of the surface, unit vectors
};

namespace detail {
    /// The attributes of a range of structs.
    template <class Range>
    photon_attributes attributes_of(const Range& photons)
    {
        using P = std::ranges::range_value_t<Range>;
        using reader = photon_reader<P>;
        const P* const first = std::ranges::data(photons);
        const auto n = static_cast<std::size_t>(std::ranges::size(photons));
        photon_attributes a{.positions = {first, n, [](const P& p) -> decltype(auto) { return reader::position(p); }},
            .powers = {first, n, [](const P& p) -> decltype(auto) { return reader::power(p); }}};
        if constexpr (requires(const P& p) { reader::direction(p); })
            a.directions = {first, n, [](const P& p) -> decltype(auto) { return reader::direction(p); }};
        if constexpr (requires(const P& p) { reader::normal(p); })
            a.normals = {first, n, [](const P& p) -> decltype(auto) { return reader::normal(p); }};
        return a;
    }

    /// The origin of positions on the device. For doubles it is the centre of the positions, so that single precision
    /// suffices however far from 0 they lie; for floats it is 0.
    inline glm::dvec3 origin_of(const vector_view& positions)
    {
        constexpr double most = std::numeric_limits<double>::infinity();
        glm::dvec3 low(most), high(-most);
        for (std::size_t i = 0; positions.has_doubles() && i < positions.size(); ++i)
            if (const auto p = positions[i]; std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) {
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
        return low.x <= high.x ? 0.5 * low + 0.5 * high : glm::dvec3(0);
    }

    template <backend B>
    buffer_of<B, glm::vec4> upload_view(B& b, const vector_view& vectors, const glm::dvec3& origin, float w)
    {
        std::vector<glm::vec4> staged(vectors.size());
        for (std::size_t i = 0; i < staged.size(); ++i)
            staged[i] = glm::vec4(glm::vec3(vectors[i] - origin), w);
        return b.upload(std::span<const glm::vec4>(staged));
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
