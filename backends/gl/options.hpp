// Options of the OpenGL backend.
#pragma once

#include <photongrid/backends/gl/functions.hpp>
#include <photongrid/core/exact_arithmetic.hpp>

namespace photongrid {

/// The origin of the OpenGL context.
enum class gl_context_kind {
    any,     ///< EGL, else OSMesa
    egl,     ///< EGL without a surface
    osmesa,  ///< OSMesa: always software
    current, ///< the caller's context, which must be current at construction and at every call
};

/// Options of the OpenGL backend.
/// \headerfile backends/gl/gl.hpp <photongrid/backends/gl/gl.hpp>
struct gl_options {
    gl_context_kind context = gl_context_kind::any; ///< the origin of the context
    gl::loader find = nullptr; ///< for gl_context_kind::current: function loader; null: EGL's or OSMesa's
    uint tile = 64;            ///< run_until_done skips finished tiles of tile x tile elements (3.3); 1 to 2048
    bool time_passes = false;  ///< measure verbs by the device's clock, for costs(), and wait for each; slower
    arithmetic_kind arithmetic = arithmetic_kind::automatic; ///< how kernels compute quotients and square roots
    bool debug = false; ///< check for errors after every pass, with the driver's own messages; slow
};

} // namespace photongrid
