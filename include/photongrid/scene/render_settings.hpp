// How to render: the paper's parameters, and what goes beyond them.
#pragma once

#include <photongrid/estimate/estimate_settings.hpp>
#include <photongrid/scene/check.hpp>

#include <cstdint>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// How a photon map is built: sorted_map (2.2.1) or routed_map (2.2.2).
enum class map_builder { sort, route };

/// Which part of the light a picture shows. The photon map's part is split by the photons' paths: a caustic photon met
/// mirrors and glass only, an indirect one a diffuse surface too. Lamps that the eye sees count as direct.
enum class light_part { all, direct, caustic, indirect };

/// How to render: the paper's parameters, and what goes beyond them.
struct render_settings {
    std::uint32_t width = 512;     ///< pixels, 1 to 16384
    std::uint32_t height = 512;    ///< pixels, 1 to 16384
    std::uint32_t photons = 65000; ///< photons *stored*
    std::uint32_t k = 500;         ///< photons sought by an estimate
    glm::uvec3 grid{
        25, 25, 50}; ///< cells of the photon map over the scene; 0, 0, 0: fitted to photons and k (fitting_grid.hpp)
    double max_radius = 0.1;          ///< m
    std::uint32_t light_samples = 32; ///< shadow rays a light, pixel and eye ray; a point light needs one
    std::uint32_t spp = 1;            ///< eye rays per pixel and pass
    std::uint32_t passes
        = 1;                 ///< that the picture is the mean of; each has photons, eye rays and shadow rays of its own
    std::uint32_t depth = 8; ///< reflections and refractions an eye ray follows
    std::uint32_t photon_depth = 32;                 ///< surfaces a photon path meets at most
    std::uint32_t seed = 1;                          ///< of all random numbers; the same seed gives the same picture
    map_builder builder = map_builder::sort;         ///< sorted or routed
    std::uint32_t slots = 4;                         ///< m: routed cells have m x m slots
    double exposure = 0;                             ///< EV for tone-mapped output: pixel values times 2^exposure
    search_kind search = search_kind::exact_k;       ///< which photons an estimate uses
    filter_kernel kernel = filter_kernel::silverman; ///< their weight by distance
    bias_kind bias = bias_kind::unbiased;            ///< does the photon that sets the radius count?
    leak_policy leaks{.side = true};                 ///< photons that are refused
    edge_correction edges = edge_correction::none;   ///< polygons: needs leak_policy::min_cosine above 0
    light_part only = light_part::all;               ///< what of the light is drawn
    bool aov = false; ///< radius, count and relative standard error of the estimate are wanted per pixel

    bool operator==(const render_settings&) const = default; ///< of every member
};

/// The settings that reproduce the paper's estimate (2.3): at least k, constant kernel, no policy, no correction. The
/// rest stays.
/// \snippet snippets.cpp as_paper
inline render_settings as_paper(render_settings s)
{
    s.search = search_kind::at_least_k;
    s.kernel = filter_kernel::constant;
    s.bias = bias_kind::paper;
    s.leaks = {};
    s.edges = edge_correction::none;
    s.passes = 1;
    return s;
}

/// \throws std::invalid_argument for a setting out of its range, which the message gives.
inline void check(const render_settings& s)
{
    detail::require(s.width >= 1 && s.height >= 1 && s.width <= 16384 && s.height <= 16384,
        "size: width and height must be from 1 to 16384 pixels");
    detail::require(s.photons >= 1 && s.photons <= (1u << 27), "photons: must be from 1 to 2^27");
    detail::require(s.k >= 1 && s.k <= (1u << 24), "k: must be from 1 to 2^24");
    detail::require(s.grid == glm::uvec3(0) || (s.grid.x >= 1 && s.grid.y >= 1 && s.grid.z >= 1),
        "grid: each axis needs at least one cell (or all three 0: fitted to the photons)");
    detail::require(detail::finite(s.max_radius) && s.max_radius > 0, "max_radius: must be finite and greater than 0");
    detail::require(s.light_samples >= 1 && s.light_samples <= 65536, "light_samples: must be from 1 to 65536");
    detail::require(s.spp >= 1 && s.spp <= 65536, "spp: must be from 1 to 65536");
    detail::require(s.passes >= 1 && s.passes <= 65536, "passes: must be from 1 to 65536");
    detail::require(s.depth <= 64, "depth: must be at most 64");
    detail::require(s.photon_depth >= 1 && s.photon_depth <= 64, "photon_depth: must be from 1 to 64");
    detail::require(
        s.leaks.compression >= 1 && s.leaks.compression <= 1e6f, "leaks: compression must be from 1 to 10^6");
    detail::require(s.leaks.min_cosine >= -1 && s.leaks.min_cosine <= 1, "leaks: min_cosine must be from -1 to 1");
    detail::require(s.edges == edge_correction::none || s.leaks.min_cosine > 0,
        "edge_correction: photons of adjoining walls would count, though their area does not; it needs the leak policy "
        "normals with a cosine above 0, for example 0.5 (or edge_correction none)");
    detail::require(s.slots >= 1 && s.slots <= 16, "slots: must be from 1 to 16");
    detail::require(detail::finite(s.exposure) && std::abs(s.exposure) <= 64, "exposure: must be from -64 to 64 EV");
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
