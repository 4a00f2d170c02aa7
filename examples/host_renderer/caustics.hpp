// Caustics for the host; caustics.cpp gets them from photongrid.
#pragma once

#include "path_tracer.hpp"

namespace host {

/// Caustic light of the scene, from this number of photons emitted by the lamp.
irradiance_source caustics_of(const scene& s, int photons, std::uint64_t seed);

} // namespace host
