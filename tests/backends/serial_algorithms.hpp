// The serial backend with maps and searches on it, which most test programs compare with. They are compiled once: in
// photongrid::renderer, or, for the installed photongrid::backend_tests, in serial_algorithms.cpp.
#pragma once

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/hashed_route.hpp>
#include <photongrid/map/map_builders.hpp>

#ifndef PHOTONGRID_COMPILED_HERE
#define PHOTONGRID_COMPILED_HERE extern
#endif

namespace photongrid {

PHOTONGRID_COMPILED_HERE template map_buffers<serial_backend> sorted_map(
    serial_backend&, photons<serial_backend>, const grid&, uint);
PHOTONGRID_COMPILED_HERE template map_buffers<serial_backend> routed_map(
    serial_backend&, photons<serial_backend>, const grid&, const routing&);
PHOTONGRID_COMPILED_HERE template map_buffers<serial_backend> block_map(serial_backend&, photons<serial_backend>, uint);
PHOTONGRID_COMPILED_HERE template routed_cells<serial_backend> stencil_route(
    serial_backend&, const photons<serial_backend>&, const grid&, uint, uint, uint);
PHOTONGRID_COMPILED_HERE template routed_survivors<serial_backend> hashed_route(
    serial_backend&, photons<serial_backend>, const virtual_grid&, const hashed_route_settings&);
PHOTONGRID_COMPILED_HERE template grid fitting_grid(serial_backend&, const photons<serial_backend>&, uint, float);
PHOTONGRID_COMPILED_HERE template map_buffers<serial_backend> fitted_map(
    serial_backend&, photons<serial_backend>, uint, uint);
PHOTONGRID_COMPILED_HERE template sort_report bitonic_sort(serial_backend&, buffer_of<serial_backend, glm::uvec2>&);
PHOTONGRID_COMPILED_HERE template class knn_radius<serial_backend>;
PHOTONGRID_COMPILED_HERE template class knn_search_by_kernels<serial_backend>;
PHOTONGRID_COMPILED_HERE template class knn_search<serial_backend>;

} // namespace photongrid

#undef PHOTONGRID_COMPILED_HERE
