// Settings and results of the reference renderer. Include <photongrid/reference/reference.hpp>.
#pragma once

#include <photongrid/render/image.hpp>
#include <photongrid/scene/scene.hpp>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// How the reference renderer finds the caustics of rectangle lights. Those of point lights always need bins.
enum class caustics_by {
    paths, ///< eye paths that hit the light by chance: unbiased
    bins,  ///< light paths into bins: less noise, blurred over a bin
};

/// Settings of the reference renderer.
struct reference_settings {
    std::uint32_t width = 512;  ///< pixels, 1 to 16384
    std::uint32_t height = 512; ///< pixels, 1 to 16384
    std::uint32_t spp
        = 256; ///< eye paths per pixel, at least 2; with bins rounded up to a multiple of 16, the number of groups
    std::uint64_t paths = 1u << 24; ///< light paths, if bins are needed; rounded up in the same way
    double bin = 0;                 ///< edge of a bin, m; 0: chosen from the diffuse area and the number of paths
    std::uint32_t threads = 0;      ///< 0: as many as the machine has; the picture does not depend on the number
    std::uint64_t seed = 1;         ///< seed of all random numbers
    std::uint32_t depth = 8;        ///< the most specular surfaces of an eye path before the first diffuse one
    std::uint32_t photon_depth
        = 32; ///< the most surfaces of a light path up to and including the first diffuse one seen from the camera
    caustics_by area_light_caustics = caustics_by::paths; ///< method for rectangle lights
    pixel_filter filter = pixel_filter::box;              ///< weight of an eye path by its place in the picture
};

/// Reference settings with the size, seed, filter and depths of a scene's render settings.
inline reference_settings reference_settings_for(const render_settings& s)
{
    reference_settings r;
    r.width = s.output.width;
    r.height = s.output.height;
    r.seed = s.seed;
    r.depth = s.view.depth;
    r.filter = s.view.filter;
    r.photon_depth = s.map.photon_depth;
    return r;
}

/// \throws std::invalid_argument "member: what is wrong" for a setting out of its range.
inline void check(const reference_settings& s)
{
    detail::require(s.width >= 1 && s.height >= 1 && s.width <= 16384 && s.height <= 16384,
        "size: width and height must be from 1 to 16384 pixels");
    detail::require(s.filter <= pixel_filter::tent, "filter: must be one of the enumerators");
    detail::require(
        s.spp >= 2 && s.spp <= (1u << 24), "spp: must be from 2 to 2^24, since one path has no standard error");
    detail::require(s.paths >= 1 && s.paths <= (std::uint64_t{1} << 40), "paths: must be from 1 to 2^40");
    detail::require(std::isfinite(s.bin) && s.bin >= 0, "bin: must be finite and not negative");
    detail::require(s.threads <= 1024, "threads: must be at most 1024");
    detail::require(s.depth <= 4096, "depth: must be at most 4096");
    detail::require(s.photon_depth >= 1 && s.photon_depth <= 4096, "photon_depth: must be from 1 to 4096");
}

/// Statistics of a reference render.
struct reference_stats {
    std::uint32_t spp = 0;             ///< eye paths per pixel
    std::uint32_t threads = 0;         ///< threads used
    std::uint64_t light_paths = 0;     ///< 0 without bins
    std::uint64_t caustic_hits = 0;    ///< light paths that reached a diffuse surface by mirrors or glass
    std::uint64_t bins = 0;            ///< on both sides of all diffuse surfaces
    double bin_size = 0;               ///< edge of a bin, m, over which caustics are blurred; 0 without bins
    double mean_standard_error = 0;    ///< over pixels and channels, W/(m^2 sr)
    std::uint64_t invalid_samples = 0; ///< samples that were NaN or infinite; they count as black
    double light_seconds = 0;          ///< time for the light paths
    double eye_seconds = 0;            ///< time for the eye paths
};

/// A reference picture with its standard error.
struct reference_picture {
    image mean;            ///< W/(m^2 sr)
    image standard_error;  ///< of each pixel and channel, W/(m^2 sr)
    reference_stats stats; ///< statistics
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
