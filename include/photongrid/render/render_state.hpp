// Progress and resume state of progressive rendering, as plain data.
#pragma once

#include <photongrid/render/film.hpp>
#include <photongrid/render/row_bands.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// An error that a picture does not have yet (output_settings::until_error), and what it would take.
struct foreseen_error {
    double error = 0;
    double passes = 0;  ///< in the picture then
    double seconds = 0; ///< from now on, by the measured times
};

/// The progress of a progressive_render.
struct render_progress {
    /// "prepare_scene", "choose_settings", "trace_photons", "build_map", "preview", "radiance_estimate", "finished"
    std::string_view stage;
    double fraction = 0;          ///< of the stage, 0 to 1
    std::uint64_t unfinished = 0; ///< pixels whose estimates are not finished
    std::uint32_t divisor = 1;    ///< side of the pixels being drawn, in pixels of the picture
    std::uint32_t photons = 0;    ///< of the map in use or being built
    std::uint32_t passes = 0;     ///< passes in the picture
    double whole = 0;             ///< of the whole picture, 0 to 1, as far as that can be foreseen
    double seconds_left = std::numeric_limits<double>::infinity(); ///< by the measured times; infinity: not known yet
    std::vector<foreseen_error> errors{}; ///< the next smaller errors; none as long as nothing is known of them
};

/// An unfinished pass: its finished rows, and the light of the first rays of the band of rows after them.
struct unfinished_pass {
    std::uint32_t number = 0; ///< which pass
    std::uint32_t rows = 0;   ///< finished
    std::uint32_t rays = 0; ///< eye rays per pixel of the band, counting each combination of Fresnel branches; 0: none
    pass_pixels light{};    ///< of the finished rows
    pass_pixels band{};     ///< of the band; its searches are there without layers too

    /// True before its first ray.
    bool empty() const { return rows == 0 && rays == 0; }
};

/// The state of an unfinished picture, from which progressive_render::resume continues.
struct render_state {
    photongrid::film film;
    unfinished_pass pass;
    double seconds = 0; ///< of drawing so far, which output_settings::seconds counts

    /// Whether there is nothing to resume.
    bool empty() const { return film.passes() == 0 && pass.empty(); }
};

/// Checks that `s` is the state of a picture with these settings. The number of rays of its unfinished pass has a limit
/// that depends on the scene; view_pass checks it.
/// \throws std::invalid_argument for the state of another picture.
inline void check(const render_state& s, const render_settings& settings)
{
    const auto& o = settings.output;
    const auto passes = o.passes_at_most();
    const auto fail = [&](const std::string& what) {
        throw std::invalid_argument("render_state: " + what + "; the picture has " + std::to_string(o.width) + " x "
            + std::to_string(o.height) + " pixels" + (o.aov ? " with layers" : "") + " and passes 0 to "
            + std::to_string(passes - 1));
    };
    if (!(s.seconds >= 0) || std::isinf(s.seconds))
        fail("seconds: must be finite and not negative");
    if (s.film.size() > 0 && !s.film.is_for(o.width, o.height, o.aov, reports_bias(settings)))
        fail("film: its size or its layers differ");
    std::uint32_t known = 0; // of the film's passes
    for (std::uint32_t number = 0; number < passes; ++number)
        known += s.film.holds(number) ? 1u : 0u;
    if (known != s.film.passes())
        fail("film: " + std::to_string(s.film.passes() - known) + " of its " + std::to_string(s.film.passes())
            + " passes are not the picture's");

    const auto& p = s.pass;
    if (p.empty() && std::ranges::all_of(p.light.parts(), [](const auto* part) { return part->empty(); }))
        return;
    if (p.number >= passes || s.film.holds(p.number))
        fail("pass: number " + std::to_string(p.number) + " is finished or not the picture's");
    const auto has = [&](const pass_pixels& pixels, std::size_t rows, bool searches) {
        const std::size_t n = rows * o.width;
        return pixels.pixels.size() == n && pixels.searches.size() == (searches ? n : 0)
            && pixels.errors.size() == (o.aov ? n : 0) && pixels.biases.have(reports_bias(settings) ? n : 0);
    };
    const auto bands = bands_of(o);
    const auto next = std::find_if(bands.begin(), bands.end(), [&](auto b) { return b.first == p.rows; });
    const bool drawn = p.rows == o.height && p.rays == 0;
    if ((next == bands.end() && !drawn) || !has(p.light, p.rows, o.aov))
        fail("pass: " + std::to_string(p.rows)
            + " finished rows are no whole number of bands, or differ in their layers");
    if (p.rays > 0 && !has(p.band, next->rows, true))
        fail("pass: the band after row " + std::to_string(p.rows) + " has another size");
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
