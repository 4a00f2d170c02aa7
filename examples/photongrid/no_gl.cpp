// Stands for render_gl.cpp where CMake found no OpenGL.
#include "backends.hpp"

namespace photongrid {

namespace {
    const char* const reason = "gl: this photongrid was built without the OpenGL backend; install libegl-dev, "
                               "libopengl-dev and libgl-dev, then configure with -DPHOTONGRID_GL=ON";
}

std::unique_ptr<renderer> gl_renderer(const renderer_options&) { throw backend_error(reason); }

std::vector<device_report> gl_devices()
{
    return {{.backend = "gl", .about = reason}, {.backend = "gl-osmesa", .about = reason}};
}

} // namespace photongrid
