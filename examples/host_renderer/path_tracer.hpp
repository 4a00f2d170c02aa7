// The host's renderer: path tracing with next event estimation.
#pragma once

#include "scene.hpp"

#include <functional>

namespace host {

/// A point that light paths visit, whose caustic light the renderer cannot find itself.
struct gather_point {
    vec3 where, normal; ///< normal: unit vector, towards the side that is looked at
    vec3 weight;        ///< what the pixel gains by irradiance 1 here: throughput x albedo / pi, 1/sr
    int pixel;
};
/// Irradiance, W/m^2, at each of some points, of light that reaches them by mirrors and glass alone.
using irradiance_source = std::function<std::vector<vec3>(const std::vector<gather_point>&)>;

struct render_settings {
    int size = 400;   ///< pixels a side
    int samples = 64; ///< paths a pixel
    int threads = 1;
    std::uint64_t seed = 1;
    /// Count the lamp where a path meets it by mirrors and glass after a diffuse surface. True to nature, but so few
    /// paths do that they show as bright specks.
    bool keeps_specks = false;
};

/// Runs f(0) to f(n - 1) on threads.
void in_parallel(int n, int threads, const std::function<void(int)>& f);

/// The picture, radiance (W/(m^2 sr)) row by row from the top. The same at any number of threads.
std::vector<vec3> render(const scene& s, const render_settings& settings, const irradiance_source& caustics = {});

} // namespace host
