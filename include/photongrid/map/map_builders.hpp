// All ways to build a photon map: grid maps, by sorting and by stencil routing (2.2), block maps, and whichever of them
// suits the photons.
#pragma once

#include <photongrid/map/block_map.hpp>
#include <photongrid/map/fitted_map.hpp>
#include <photongrid/map/grid_maps.hpp>
