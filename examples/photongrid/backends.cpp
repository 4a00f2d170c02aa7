#include "backends.hpp"

#include <stdexcept>

namespace photongrid {

std::unique_ptr<renderer> make_renderer(const renderer_options& o)
{
    if (o.backend == "serial")
        return serial_renderer();
    if (o.backend == "cpu")
        return cpu_renderer(o);
    if (o.backend == "gl" || o.backend == "gl-osmesa")
        return gl_renderer(o);
    if (o.backend == "vulkan")
        return vulkan_renderer(o);
    throw std::logic_error("no backend is called \"" + o.backend + "\"");
}

} // namespace photongrid
