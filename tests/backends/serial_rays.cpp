// Rays on the serial backend, as tests of all backends compare with: compiled once, optimized.
#include "../trace/probe_rays.hpp"

template photongrid::testing::ray_hits photongrid::testing::trace_rays(serial_backend&, const scene&, const rays&);
