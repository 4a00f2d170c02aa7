// The serial backend and the algorithms on it, which every test program compares with. They are compiled once, in
// serial_algorithms.cpp, and not again in each of these.
#pragma once

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/fitting_grid.hpp>
#include <photongrid/render.hpp>

#ifndef PHOTONGRID_COMPILED_HERE
#define PHOTONGRID_COMPILED_HERE extern
#endif

namespace photongrid {

PHOTONGRID_COMPILED_HERE template photon_map<serial_backend> sorted_map(
    serial_backend&, photons<serial_backend>, const grid&, uint);
PHOTONGRID_COMPILED_HERE template photon_map<serial_backend> routed_map(
    serial_backend&, photons<serial_backend>, const grid&, uint, uint, uint);
PHOTONGRID_COMPILED_HERE template routed_cells<serial_backend> stencil_route(
    serial_backend&, const photons<serial_backend>&, const grid&, uint, uint, uint);
PHOTONGRID_COMPILED_HERE template grid fitting_grid(serial_backend&, const photons<serial_backend>&, uint, float);
PHOTONGRID_COMPILED_HERE template sort_report bitonic_sort(serial_backend&, buffer_of<serial_backend, glm::uvec2>&);
PHOTONGRID_COMPILED_HERE template class knn_search_by_kernels<serial_backend>;
PHOTONGRID_COMPILED_HERE template class knn_search<serial_backend>;
PHOTONGRID_COMPILED_HERE template device_scene<serial_backend> upload_scene(serial_backend&, const scene&);
PHOTONGRID_COMPILED_HERE template traced_photons<serial_backend> trace_photons(
    serial_backend&, const scene&, const device_scene<serial_backend>&, const render_settings&, const render_observer&);
PHOTONGRID_COMPILED_HERE template void correct_edges(serial_backend&, const device_scene<serial_backend>&,
    const buffer_of<serial_backend, glm::vec4>&, const buffer_of<serial_backend, glm::vec4>&,
    knn_estimates<serial_backend>&, filter_kernel, float);
PHOTONGRID_COMPILED_HERE template built_map<serial_backend> build_map(
    serial_backend&, const scene&, const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_COMPILED_HERE template image draw(serial_backend&, const built_map<serial_backend>&, const camera&,
    const render_settings&, const render_observer&, render_stats&);
PHOTONGRID_COMPILED_HERE template image render(
    serial_backend&, const scene&, const render_settings&, const render_observer&, render_stats&);

} // namespace photongrid

#undef PHOTONGRID_COMPILED_HERE
