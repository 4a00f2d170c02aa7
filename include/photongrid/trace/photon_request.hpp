// Which photons a picture needs.
#pragma once

#include <photongrid/trace/photon_event.kernel.hpp>
#include <photongrid/trace/scene_records.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Which photons tracing stores.
struct photon_request {
    uint photons = 0; ///< to store
    /// Sum of kernels::FIRST_HITS, CAUSTICS and OTHER_PHOTONS.
    uint kinds = kernels::CAUSTICS | kernels::OTHER_PHOTONS;
    /// After so many paths tracing ends, with fewer photons if they did not store as many. Powers are divided by the
    /// paths, so that what was stored counts: light that so few paths find is noisy, and dim.
    std::uint64_t most_paths = 0;
    bool are_caustics_of_others = false; ///< caustic photons of a picture whose other photons are in another map
    uint ends = kernels::NOTHING_ENDS;   ///< what ends paths besides absorption (photon_event.glsl)

    /// Whether they are those on rough surfaces (rough_photons.hpp).
    bool on_rough() const { return ends == kernels::ROUGH_ENDS; }
    bool operator==(const photon_request&) const = default;
};

/// Whether a scene has surfaces that may make caustics.
inline bool may_have_caustics(const scene_layout& layout)
{
    return (layout.features & (has_mirrors | has_glass | has_rough | has_coats)) != 0;
}

/// The most paths for each photon of a request: for photons of all light, for caustic photons alone, and for the other
/// photons where caustic ones have a map of their own, since each pass then pays for both. Of light that a share s of
/// all paths finds, n paths leave a noise of sqrt(s / n) of all light: where few find it, more of them are not needed.
constexpr uint most_paths_per_photon = 256, most_paths_per_caustic_photon = 32, most_paths_per_other_photon = 2;

/// A request for caustic photons alone.
inline photon_request request_of_caustics(uint photons)
{
    photon_request r{photons, kernels::CAUSTICS, std::uint64_t{photons} * most_paths_per_caustic_photon};
    r.ends = kernels::DIFFUSE_ENDS;
    return r;
}
/// The photons on rough surfaces of a picture with settings `s`: as many as caustic ones, which they resemble, or an
/// eighth of all.
inline photon_request request_on_rough(const render_settings& s)
{
    auto r = request_of_caustics(s.map.caustic_photons > 0 ? s.map.caustic_photons : std::max(1u, s.map.photons / 8));
    r.ends = kernels::ROUGH_ENDS;
    r.most_paths = std::uint64_t{r.photons} * most_paths_per_other_photon; // each pass pays for them, too
    return r;
}
/// The photons of a picture with settings `s`, without those of a map of caustic photons.
inline photon_request request_of(const render_settings& s, const scene_layout& layout)
{
    const bool has_caustics = may_have_caustics(layout);
    const bool are_caustics_apart = s.map.caustic_photons > 0 && has_caustics;
    photon_request r;
    r.photons = s.map.photons;
    r.most_paths = std::clamp<std::uint64_t>(std::uint64_t{r.photons} * most_paths_per_photon, 1u << 16, 0xFFFF0000u);
    const bool shows_none = s.output.only == light_part::direct
        || (s.output.only == light_part::caustic && (are_caustics_apart || !has_caustics));
    if (shows_none) {
        r.photons = 0;
    } else if (gathers(s)) {
        r.kinds |= kernels::FIRST_HITS;
    } else if (follows_paths(s)) {
        r = request_of_caustics(are_caustics_apart || !has_caustics ? 0 : r.photons);
    } else if (are_caustics_apart) {
        r.kinds = kernels::OTHER_PHOTONS;
        r.most_paths = std::uint64_t{r.photons} * most_paths_per_other_photon;
    }
    if (!layout.is_matte)
        r.photons = 0;
    return r;
}
/// The photons of each map of a picture: the first; a map of caustic photons, if the settings ask for it and the scene
/// has caustics; those on rough surfaces, if the scene has light that only these show.
inline std::vector<photon_request> requests_of(const render_settings& s, const scene_layout& layout)
{
    std::vector<photon_request> all{request_of(s, layout)};
    if (has_caustic_map(s) && layout.is_matte && may_have_caustics(layout)) {
        all.push_back(request_of_caustics(s.map.caustic_photons));
        all.back().are_caustics_of_others = true;
    }
    if (layout.needs_photons_on_rough && s.output.only != light_part::direct && s.output.only != light_part::indirect)
        all.push_back(request_on_rough(s));
    return all;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
