// Tracing and pictures on the serial backend, compiled once, in serial_pictures.cpp.
#pragma once

#include "serial_algorithms.hpp"

#include <photongrid/render/render.hpp>

#ifndef PHOTONGRID_PICTURES_COMPILED_HERE
#define PHOTONGRID_PICTURES_COMPILED_HERE extern
#endif

namespace photongrid {

PHOTONGRID_PICTURES_COMPILED_HERE template device_scene<serial_backend> upload_scene(serial_backend&, const scene&);
PHOTONGRID_PICTURES_COMPILED_HERE template traced_photons<serial_backend> trace_photons(
    serial_backend&, const scene&, const device_scene<serial_backend>&, const render_settings&, const render_observer&);
PHOTONGRID_PICTURES_COMPILED_HERE template void correct_edges(serial_backend&, const device_scene<serial_backend>&,
    const buffer_of<serial_backend, glm::vec4>&, const buffer_of<serial_backend, glm::vec4>&,
    knn_estimates<serial_backend>&, filter_kind, float);
PHOTONGRID_PICTURES_COMPILED_HERE template built_map<serial_backend> build_map(
    serial_backend&, const scene&, const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_PICTURES_COMPILED_HERE template image draw(serial_backend&, const built_map<serial_backend>&, const camera&,
    const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_PICTURES_COMPILED_HERE template class view_pass<serial_backend>;
PHOTONGRID_PICTURES_COMPILED_HERE template pass_pixels draw_pass(serial_backend&, const built_map<serial_backend>&,
    const camera&, const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_PICTURES_COMPILED_HERE template image render(
    serial_backend&, const scene&, const render_settings&, const render_observer&, render_stats&);

} // namespace photongrid

#undef PHOTONGRID_PICTURES_COMPILED_HERE
