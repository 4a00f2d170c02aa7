// The filters of an estimate by name. To add one: its enumerator and row here, its SWITCH, weight and edge integral and
// edge moment in filter.glsl, and its weight in vectors in the cpu backend's gather_simd.hpp.
#pragma once

#include <photongrid/core/kernel.hpp>

#include <array>
#include <cstdint>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The weight of a photon at distance d, for the radius r. Each filter is normalised to a mean of 1 over the disc.
enum class filter_kind : std::uint8_t {
    constant,     ///< 1
    cone,         ///< 1 - d/r (Jensen's with slope 1)
    epanechnikov, ///< 1 - d^2/r^2
    silverman,    ///< (1 - d^2/r^2)^2 (Silverman 1986)
};

/// A filter's name, and what normalises it.
struct filter_entry {
    const char* name; ///< in scene files and on the command line
    filter_kind kind;
    float norm;           ///< 1 / mean of the weights in filter.glsl over the disc
    float mean_distance2; ///< mean of d^2 / r^2 over the disc, weighted by the filter
};

/// All filters, in the order of filter_kind.
inline constexpr std::array filters{
    filter_entry{"constant", filter_kind::constant, 1, 1 / 2.0f},
    filter_entry{"cone", filter_kind::cone, 3, 3 / 10.0f},
    filter_entry{"epanechnikov", filter_kind::epanechnikov, 2, 1 / 3.0f},
    filter_entry{"silverman", filter_kind::silverman, 3, 1 / 4.0f},
};

static_assert(
    [] {
        for (std::size_t i = 0; i < filters.size(); ++i)
            if (filters[i].kind != static_cast<filter_kind>(i))
                return false;
        return true;
    }(),
    "filters: in the order of filter_kind");

namespace detail {
    constexpr const filter_entry& entry_of(filter_kind f) { return filters[static_cast<std::size_t>(f)]; }

    /// By how much the bias of an estimate by filter `f` is larger than the difference of the estimates by the constant
    /// and by Epanechnikov's filter. Light with a Laplacian L raises an estimate by L r^2 / 4 times its mean_distance2.
    constexpr float bias_factor(filter_kind f)
    {
        return entry_of(f).mean_distance2
            / (entry_of(filter_kind::constant).mean_distance2 - entry_of(filter_kind::epanechnikov).mean_distance2);
    }

    /// The SWITCH of filter.glsl, as a bit of launch::switches.
    constexpr uint filter_switch(filter_kind f)
    {
        return f == filter_kind::constant ? 0u : 1u << (15u + static_cast<uint>(f));
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
