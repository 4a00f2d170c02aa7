// Tracing and pictures on the serial backend, compiled once, in serial_pictures.cpp.
#pragma once

#include "serial_tracing.hpp"

#include <photongrid/render/render.hpp>

namespace photongrid {

PHOTONGRID_PICTURES_COMPILED_HERE template void correct_edges(serial_backend&, const device_scene<serial_backend>&,
    const buffer_of<serial_backend, glm::vec4>&, const buffer_of<serial_backend, glm::vec4>&,
    knn_estimates<serial_backend>&, filter_kind, float);
PHOTONGRID_PICTURES_COMPILED_HERE template built_map<serial_backend> build_map(
    serial_backend&, const scene&, const render_settings&, const render_observer&);
PHOTONGRID_PICTURES_COMPILED_HERE template rendered draw(
    serial_backend&, const built_map<serial_backend>&, const camera&, const render_settings&, const render_observer&);
PHOTONGRID_PICTURES_COMPILED_HERE template class view_pass<serial_backend>;
PHOTONGRID_PICTURES_COMPILED_HERE template pass_pixels draw_pass(serial_backend&, const built_map<serial_backend>&,
    const camera&, const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_PICTURES_COMPILED_HERE template rendered render(
    serial_backend&, const scene&, const render_settings&, const render_observer&);

} // namespace photongrid

#undef PHOTONGRID_PICTURES_COMPILED_HERE
