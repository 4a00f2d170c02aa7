// Progress and resume state of progressive rendering, as plain data.
#pragma once

#include <photongrid/render/film.hpp>

#include <cstdint>
#include <string_view>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// The progress of a progressive_render.
struct render_progress {
    std::string_view stage;       ///< "trace_photons", "build_map", "preview", "radiance_estimate", "finished"
    double fraction = 0;          ///< of the stage, 0 to 1
    std::uint64_t unfinished = 0; ///< pixels whose estimates are not finished
    std::uint32_t divisor = 1;    ///< side of the pixels being drawn, in pixels of the picture
    std::uint32_t photons = 0;    ///< of the map in use or being built
    std::uint32_t passes = 0;     ///< passes in the picture
};

/// An unfinished pass: its finished rows, and the light of the first rays of the band of rows after them.
struct unfinished_pass {
    std::uint32_t number = 0; ///< which pass
    std::uint32_t rows = 0;   ///< finished
    std::uint32_t rays = 0; ///< eye rays per pixel of the band, counting each combination of Fresnel branches; 0: none
    pass_pixels light{};    ///< of the finished rows
    pass_pixels band{};     ///< of the band; its searches are there without layers too

    /// Whether nothing of it is drawn.
    bool empty() const { return rows == 0 && rays == 0; }
};

/// The state of an unfinished picture, from which progressive_render::resume continues.
struct render_state {
    photongrid::film film;
    unfinished_pass pass;

    /// Whether there is nothing to resume.
    bool empty() const { return film.passes() == 0 && pass.empty(); }
};

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
