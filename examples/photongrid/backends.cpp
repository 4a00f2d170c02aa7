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

std::string limits(const capabilities& c)
{
    const auto yes_no = [](bool b) { return b ? "yes" : "no"; };
    return std::string(c.software ? "software" : "hardware") + ", buffers of up to " + std::to_string(c.max_elements)
        + " elements, routing with up to " + std::to_string(c.max_route_slots) + " x "
        + std::to_string(c.max_route_slots) + " slots, division rounds correctly: " + yes_no(c.exact_division)
        + ", square root: " + yes_no(c.exact_sqrt)
        + (c.loop_limit > 0 ? ", loops end after " + std::to_string(c.loop_limit) + " iterations" : "");
}

} // namespace photongrid
