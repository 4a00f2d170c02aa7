// The kernels of the tracer and the picture, read as C++.
#pragma once

#include <photongrid/kernels.hpp>
#include <photongrid/kernels/begin.hpp>

namespace photongrid::kernels {

// 2.1
struct emit_photon {
#include <photongrid/kernels/emit_photon.glsl>
};
struct bounce_photon {
#include <photongrid/kernels/bounce_photon.glsl>
};
struct path_goes_on {
#include <photongrid/kernels/path_goes_on.glsl>
};
struct tally_path {
#include <photongrid/kernels/tally_path.glsl>
};
struct sum_tallies {
#include <photongrid/kernels/sum_tallies.glsl>
};
struct path_is_emitted {
#include <photongrid/kernels/path_is_emitted.glsl>
};
struct is_found {
#include <photongrid/kernels/is_found.glsl>
};
struct gather_photon {
#include <photongrid/kernels/gather_photon.glsl>
};
struct gather_normal {
#include <photongrid/kernels/gather_normal.glsl>
};
struct divide_power {
#include <photongrid/kernels/divide_power.glsl>
};

// 2.4
struct eye_ray {
#include <photongrid/kernels/eye_ray.glsl>
};
struct eye_bounce {
#include <photongrid/kernels/eye_bounce.glsl>
};
struct direct_light {
#include <photongrid/kernels/direct_light.glsl>
};
struct no_light {
#include <photongrid/kernels/no_light.glsl>
};
struct copy_light {
#include <photongrid/kernels/copy_light.glsl>
};
struct tally_error {
#include <photongrid/kernels/tally_error.glsl>
};
struct covered_share {
#include <photongrid/kernels/covered_share.glsl>
};
struct divide_by_share {
#include <photongrid/kernels/divide_by_share.glsl>
};
struct shade {
#include <photongrid/kernels/shade.glsl>
};

} // namespace photongrid::kernels

#include <photongrid/kernels/end.hpp>
