// What may surprise people in a scene or a picture, in sentences for stderr.
#pragma once

#include <photongrid/render/renderer.hpp>
#include <photongrid/scene/scene.hpp>

#include <string>
#include <vector>

namespace photongrid {

/// A scene in a line: numbers of parts, size and power.
std::string summary_of(const scene& s);

/// What is odd in a scene that renders: its size, materials that no shape has, a camera that looks away.
std::vector<std::string> oddities(const scene& s);

/// What may surprise in a picture that was drawn: invalid or black pixels, no photons, and for a PNG an exposure at
/// which next to nothing is seen.
std::vector<std::string> warnings(
    const scene& s, const render_settings& settings, const render_stats& stats, const image& picture, bool is_png);

} // namespace photongrid
