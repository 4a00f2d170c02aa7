// A photon map for a host program: its photons go in, irradiance comes out.
//
//     const photongrid::photon_map map(device, photons, {.k = 400});
//     for (const auto& e : map.irradiance(points, {.standard_error = true}))
//         use(e.value, e.error, e.radius, e.count);
//
// The folders map/ and estimate/ have the interface below it: buffers, kernels and interruptible searches.
#pragma once

#include <photongrid/estimate/host_search.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/vector_view.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// What to compute besides the irradiance.
struct irradiance_options {
    bool standard_error = false; ///< standard errors too
};

/// A photon map with its search settings.
///
/// Searches for many points run on the device. It must outlive these calls, and one thread at a time may use it.
/// Searches for one point run in the calling thread, on a copy of the map in the host's memory (see host_search); any
/// number of threads may run them at the same time, also after the device is gone.
///
/// Positions in double precision are stored relative to the photons' median, so that points 0.1 m apart are distinct
/// even 10^6 m from 0; a few strays do not matter. They are rounded to single precision there: a coordinate that is d
/// from the median moves by up to 2^-24 d, 0.06 m at 10^6 m. Photons that differ by less may coincide. This is not
/// reported, since only the caller knows which differences matter. Distances are in single precision.
/// \snippet snippets.cpp photon_map
template <backend B>
class photon_map : public host_queries {
public:
    /// Builds a map of any contiguous range that photon_reader accepts, in a grid that is fitted to the photons and to
    /// `search`.
    /// \throws std::invalid_argument for invalid settings, among them search.errors, since irradiance_options asks for
    ///         standard errors; backend_error if the device has no room.
    template <std::ranges::contiguous_range Range>
    requires std::ranges::sized_range<Range> && own_photon<std::ranges::range_value_t<Range>> photon_map(
        B& device, const Range& photons, const knn_settings& search = {})
        : photon_map(device, detail::attributes_of(photons), search)
    {
    }
    /// The same for photons with attributes in separate arrays: {.positions = p, .powers = w}.
    photon_map(B& device, const photon_attributes& photons, const knn_settings& search = {});

    /// The number of photons.
    uint size() const { return map_.photons.size(); }
    /// The search settings.
    const knn_settings& search() const { return host_.settings(); }
    /// The map on the device.
    const map_buffers<B>& buffers() const& { return map_; }
    const map_buffers<B>& buffers() const&& = delete;

    /// The irradiance at many points, in their order, computed on the device: one thread at a time. Where fewer than k
    /// photons count and max_radius is unbounded there is no estimate (irradiance_at_point::is_estimate).
    /// \throws std::invalid_argument if k exceeds the number of photons and max_radius is unbounded, since no disc then
    ///         holds k photons; backend_error if the device has no room.
    [[nodiscard]] std::vector<irradiance_at_point> irradiance(
        const vector_argument& points, const irradiance_options& options = {}) const
    {
        return searched(points, nullptr, options);
    }
    /// The same with the unit normal of the surface at each point, for leak policies. One thread at a time.
    [[nodiscard]] std::vector<irradiance_at_point> irradiance(
        const vector_argument& points, const vector_argument& normals, const irradiance_options& options = {}) const
    {
        return searched(points, &normals, options);
    }
    /// The irradiance at one point, with its standard error. Any thread may call it; each needs its own scratch.
    /// \throws std::invalid_argument if the search is at_least_k, and as for many points.
    template <detail::vector_like V, detail::vector_like N>
    [[nodiscard]] irradiance_at_point irradiance(const V& point, const N& normal, query_scratch& scratch) const
    {
        require_a_disc();
        return host_.irradiance(local(point), detail::to_vec<float>(normal), scratch);
    }

private:
    static const photon_attributes& checked(const photon_attributes& a, const knn_settings& search);
    static photons<B> uploaded(B& device, const photon_attributes& a, const glm::dvec3& origin);
    void require_a_disc() const;
    std::vector<irradiance_at_point> searched(
        const vector_view& points, const vector_view* normals, const irradiance_options& options) const;

    B* device_;
    map_buffers<B> map_;
};

template <backend B, class Range>
photon_map(B&, const Range&, const knn_settings&) -> photon_map<B>;
template <backend B, class Range>
photon_map(B&, const Range&) -> photon_map<B>;
template <backend B>
photon_map(B&, const photon_attributes&, const knn_settings&) -> photon_map<B>;
template <backend B>
photon_map(B&, const photon_attributes&) -> photon_map<B>;

// Defined outside of the class, and not inline, so that a library can hold them for a backend and files that link it do
// not compile them again (`extern template`; backends/cpu/compiled.hpp).

template <backend B>
photon_map<B>::photon_map(B& device, const photon_attributes& photons, const knn_settings& search)
    : host_queries(detail::origin_of(checked(photons, search).positions)), device_(&device),
      map_(fitted_map(device, uploaded(device, photons, origin_), std::max(search.k, 1u)))
{
    host_ = host_search(device, map_, search, true);
}

template <backend B>
const photon_attributes& photon_map<B>::checked(const photon_attributes& a, const knn_settings& search)
{
    const auto check = [&](const char* name, std::size_t n, bool may_lack) {
        if (n != a.positions.size() && !(may_lack && n == 0))
            throw std::invalid_argument(std::string("photon_map: ") + name + ": " + std::to_string(n) + " elements for "
                + std::to_string(a.positions.size()) + " photons; each needs one");
    };
    check("powers", a.powers.size(), false);
    check("directions", a.directions.size(), true);
    check("normals", a.normals.size(), true);
    detail::check_map_size("photon_map: photons", a.positions.size());
    if (search.errors)
        throw std::invalid_argument(
            "photon_map: search.errors: ask for standard errors by irradiance_options::standard_error instead");
    return a;
}

template <backend B>
photons<B> photon_map<B>::uploaded(B& device, const photon_attributes& a, const glm::dvec3& origin)
{
    const glm::dvec3 zero(0);
    return {detail::upload_view(device, a.positions, origin, 0.0f), detail::upload_view(device, a.powers, zero, 0.0f),
        detail::upload_view(device, a.directions, zero, 0.0f), detail::upload_view(device, a.normals, zero, 0.0f)};
}

template <backend B>
void photon_map<B>::require_a_disc() const
{
    const auto& s = search();
    if (s.k > size() && size() > 0 && detail::is_unbounded(s))
        throw std::invalid_argument("photon_map::irradiance: k: " + std::to_string(s.k)
            + " photons are sought, and the map has " + std::to_string(size())
            + "; use a smaller k, or set max_radius");
}

template <backend B>
std::vector<irradiance_at_point> photon_map<B>::searched(
    const vector_view& points, const vector_view* normals, const irradiance_options& options) const
{
    require_a_disc();
    B& device = *device_;
    auto s = search();
    s.errors = options.standard_error;
    const auto device_points = detail::upload_view(device, points, origin_, 1.0f);
    const auto estimates = [&] {
        if (normals == nullptr)
            return knn_grid_estimate(device, map_, device_points, s);
        const auto surface_normals = detail::upload_view(device, *normals, glm::dvec3(0), 0.0f);
        return knn_grid_estimate(device, map_, device_points, surface_normals, s);
    }();
    const auto values = device.download(estimates.irradiance), errors = device.download(estimates.standard_error);
    const auto used = device.download(estimates.used);
    std::vector<irradiance_at_point> all(values.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        irradiance_at_point e{.value = glm::vec3(values[i]), .radius = std::sqrt(values[i].w), .count = used[i].x};
        if (options.standard_error) {
            e.error = glm::vec3(errors[i]);
            e.error_of_sum = errors[i].w;
        }
        all[i] = detail::estimate_or_none(e, s, local(points[i]));
    }
    return all;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
