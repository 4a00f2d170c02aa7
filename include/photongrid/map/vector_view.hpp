// Views of a host's vectors: a range of vectors, or a member of a range of structs.
#pragma once

#include <photongrid/map/own_photons.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

namespace detail {
    // clang-format off
    template <class Range>
    concept vector_range = std::ranges::contiguous_range<Range> && std::ranges::sized_range<Range>
        && vector_like<std::ranges::range_value_t<Range>>;
    template <class Range>
    concept power_range = std::ranges::contiguous_range<Range> && std::ranges::sized_range<Range>
        && power_like<std::ranges::range_value_t<Range>>;
    template <class Range>
    concept number_range = power_range<Range> && std::is_arithmetic_v<std::ranges::range_value_t<Range>>;
    // Ranges whose elements outlive them, or lvalues (Range is then a reference).
    template <class Range>
    concept lasting_vector_range = vector_range<Range> && std::ranges::borrowed_range<Range>;
    template <class Range>
    concept lasting_power_range = power_range<Range> && std::ranges::borrowed_range<Range>;
    template <class Range>
    concept lasting_number_range = number_range<Range> && std::ranges::borrowed_range<Range>;
    // clang-format on
} // namespace detail

class power_view;

/// A view of a host's vectors, which must outlive it. It can be made from any contiguous range of vectors that
/// photon_reader accepts, but not from a temporary that owns them. For numbers see flat().
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
    template <detail::number_range Range>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): a vector_view is no range of numbers either
    vector_view(Range&&) = delete; // numbers are no vectors; for x, y, z, x, y, z, ... write vector_view::flat(numbers)

    /// A view of a member of structs: `read`, a function object without state, returns the member, a vector.
    template <class T, class Read>
    requires detail::vector_like<std::remove_cvref_t<std::invoke_result_t<Read, const T&>>> vector_view(
        const T* first, std::size_t size, Read)
        : vector_view(any_member{}, first, size, Read{})
    {
    }

    /// A view of vectors as numbers one after the other: x, y and z of the first, of the second, and so on.
    /// \throws std::invalid_argument if their number is not a multiple of three.
    template <detail::lasting_number_range Range>
    static vector_view flat(Range&& numbers)
    {
        using number = std::ranges::range_value_t<Range>;
        const auto n = static_cast<std::size_t>(std::ranges::size(numbers));
        if (n % 3 != 0)
            throw std::invalid_argument(
                "vector_view::flat: numbers: " + std::to_string(n) + "; three per vector are needed");
        vector_view view;
        view.data_ = std::ranges::data(numbers);
        view.size_ = n / 3;
        view.has_doubles_ = detail::has_doubles<number>();
        view.read_ = [](const void* data, std::size_t i) {
            const number* const v = static_cast<const number*>(data) + 3 * i;
            return glm::dvec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
        };
        return view;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    glm::dvec3 operator[](std::size_t i) const { return read_(data_, i); }
    /// Whether the components have more precision than a float.
    bool has_doubles() const { return has_doubles_; }

private:
    friend power_view;
    struct any_member {};
    template <class T, class Read>
    vector_view(any_member, const T* first, std::size_t size, Read)
        : data_(first), size_(size),
          has_doubles_(detail::has_doubles<std::remove_cvref_t<std::invoke_result_t<Read, const T&>>>()),
          read_([](const void* data, std::size_t i) {
              return detail::to_vec<double>(Read{}(static_cast<const T*>(data)[i]));
          })
    {
    }

    const void* data_ = nullptr;
    std::size_t size_ = 0;
    bool has_doubles_ = false;
    glm::dvec3 (*read_)(const void*, std::size_t) = nullptr;
};

/// A view of photons' powers, as of vectors. It can also be made from a range of numbers: each is the power in all
/// three channels.
class power_view {
public:
    power_view() = default;
    template <detail::lasting_power_range Range>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): a power_view is no range, so copies are not hidden
    power_view(Range&& range)
        : power_view(
            std::ranges::data(range), static_cast<std::size_t>(std::ranges::size(range)),
            [](const std::ranges::range_value_t<Range>& v) -> const auto& { return v; })
    {
    }
    power_view(const vector_view& powers) : view_(powers) {}
    /// A view of a member of structs: `read`, a function object without state, returns the member.
    template <class T, class Read>
    power_view(const T* first, std::size_t size, Read) : view_(vector_view::any_member{}, first, size, Read{})
    {
    }

    std::size_t size() const { return view_.size(); }
    bool empty() const { return view_.empty(); }
    glm::dvec3 operator[](std::size_t i) const { return view_[i]; }

private:
    vector_view view_;
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
    template <detail::number_range Range>
    vector_argument(const Range&) = delete; // numbers are no vectors; for x, y, z, ... write vector_view::flat(numbers)
};

/// Photons whose attributes are in separate arrays, with one element per photon. Directions and normals may be left
/// out.
struct photon_attributes {
    vector_view positions{};  ///< m
    power_view powers{};      ///< W
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

    /// The origin of positions on the device. For doubles it is the median of a sample, axis by axis, so that single
    /// precision suffices however far from 0 most of them lie; a few strays do not move it. For floats it is 0.
    inline glm::dvec3 origin_of(const vector_view& positions)
    {
        if (!positions.has_doubles())
            return glm::dvec3(0);
        const auto axes = sampled_coordinates(positions.size(), [&](std::size_t i) { return positions[i]; });
        const auto median = [](const std::vector<double>& ascending) {
            return ascending.empty() ? 0.0 : ascending[ascending.size() / 2];
        };
        return {median(axes[0]), median(axes[1]), median(axes[2])};
    }

    /// Uploads a vector_view or power_view.
    template <backend B, class View>
    buffer_of<B, glm::vec4> upload_view(B& device, const View& vectors, const glm::dvec3& origin, float w)
    {
        return upload_each(
            device, vectors.size(), [&](std::size_t i) { return glm::vec4(glm::vec3(vectors[i] - origin), w); });
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
