// Which photons a picture needs.
#pragma once

#include <photongrid/trace/photon_event.kernel.hpp>
#include <photongrid/trace/scene_records.hpp>

#include <cstdint>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// Which photons tracing stores.
struct photon_request {
    uint photons = 0; ///< to store
    /// Sum of kernels::FIRST_HITS, CAUSTICS and OTHER_PHOTONS.
    uint kinds = kernels::CAUSTICS | kernels::OTHER_PHOTONS;
    /// After so many paths tracing ends, with fewer photons if they did not store as many; 0: no limit.
    std::uint64_t most_paths = 0;

    /// Whether paths can end at the first diffuse surface.
    bool to_diffuse() const { return (kinds & kernels::OTHER_PHOTONS) == 0; }
    bool operator==(const photon_request&) const = default;
};

/// The photons of a picture with settings `s`, without those of a map of caustic photons.
inline photon_request request_of(const render_settings& s)
{
    constexpr uint paths_per_photon = 8; // at most, else other light would take long where there is little of it
    photon_request r;
    const bool none
        = s.output.only == light_part::direct || (s.map.caustic_photons > 0 && s.output.only == light_part::caustic);
    r.photons = none ? 0u : s.map.photons;
    if (gathers(s)) {
        r.kinds |= kernels::FIRST_HITS;
    } else if (s.map.caustic_photons > 0) {
        r.kinds = kernels::OTHER_PHOTONS;
        r.most_paths = std::uint64_t{r.photons} * paths_per_photon;
    }
    return r;
}
/// Those of a map of caustic photons; none if the picture has no such map, or the scene no caustics.
inline photon_request caustic_request_of(const render_settings& s, const scene_layout& layout)
{
    constexpr uint paths_per_photon = 64; // at most
    const bool none = !has_caustic_map(s) || (layout.features & (has_mirrors | has_glass)) == 0;
    photon_request r;
    r.photons = none ? 0u : s.map.caustic_photons;
    r.kinds = kernels::CAUSTICS;
    r.most_paths = std::uint64_t{r.photons} * paths_per_photon;
    return r;
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
