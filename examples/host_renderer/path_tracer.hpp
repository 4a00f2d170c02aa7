// The host's renderer: path tracing with next event estimation.
#pragma once

#include "scene.hpp"

#include <functional>

namespace host {

/// Irradiance, W/m^2, of light that reaches a point by mirrors and glass alone. `normal`: unit vector, towards the
/// visible side. Called from many threads at once.
using irradiance_source = std::function<vec3(vec3 position, vec3 normal)>;

struct render_settings {
    int size = 400;   ///< width and height, pixels
    int samples = 64; ///< paths per pixel
    int threads = 1;
    std::uint64_t seed = 1;
    /// Count the lamp where a path reaches it by mirrors and glass after a diffuse surface. This is correct, but so few
    /// paths do it that they show as bright specks.
    bool keeps_specks = false;
};

/// Runs f(0) to f(n - 1) on threads.
void in_parallel(int n, int threads, const std::function<void(int)>& f);

/// The picture, radiance (W/(m^2 sr)) row by row from the top. The same at any number of threads.
std::vector<vec3> render(const scene& s, const render_settings& settings, const irradiance_source& caustics = {});

} // namespace host
