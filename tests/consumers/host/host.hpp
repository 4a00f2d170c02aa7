// Declarations shared by the host's files. The host has macros with names that photongrid's kernels
// and its SIMD code use.
#pragma once

#define INPUT 1
#define OUTPUT 2
#define STATE 3
#define SWITCH 4
#define PARAMS 5
#define GROUP_LANES 6
#define EACH_LANE 7
#define IN_GROUPS 8
#define precise 9
#define VISIT 10
#define PHOTON_OF 11
#define EACH_PHOTON 12
#define LANE_VARIABLE 13
#define HWY_TARGET_INCLUDE "host.hpp"

#include HOST_HEADER

#include "../nearest.hpp"

#include <string_view>

static_assert(INPUT == 1 && OUTPUT == 2 && STATE == 3 && SWITCH == 4 && PARAMS == 5 && GROUP_LANES == 6
    && EACH_LANE == 7 && IN_GROUPS == 8 && precise == 9 && VISIT == 10 && PHOTON_OF == 11 && EACH_PHOTON == 12
    && LANE_VARIABLE == 13 && std::string_view(HWY_TARGET_INCLUDE) == "host.hpp");

namespace host {

using device = HOST_DEVICE;
using map = photongrid::map_buffers<device>;

map map_of_photons(device& d);
glm::vec4 estimate_at_point(device& d, const map& m);

} // namespace host
