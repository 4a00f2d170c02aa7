// Photon tracing on the serial backend, compiled once, in serial_pictures.cpp.
#pragma once

#include "serial_algorithms.hpp"

#include <photongrid/trace/trace_photons.hpp>

#ifndef PHOTONGRID_PICTURES_COMPILED_HERE
#define PHOTONGRID_PICTURES_COMPILED_HERE extern
#endif

namespace photongrid {

PHOTONGRID_PICTURES_COMPILED_HERE template device_scene<serial_backend> upload_scene(serial_backend&, const scene&);
PHOTONGRID_PICTURES_COMPILED_HERE template traced_photons<serial_backend> trace_photons(
    serial_backend&, const scene&, const device_scene<serial_backend>&, const render_settings&, const render_observer&);

} // namespace photongrid
