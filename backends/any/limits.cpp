#include <photongrid/backends/any/backend_entry.hpp>

std::string photongrid::any::limits(const capabilities& c)
{
    const auto yes_no = [](bool b) { return b ? "yes" : "no"; };
    return std::string(c.software ? "software" : "hardware") + ", buffers of up to " + std::to_string(c.max_elements)
        + " elements, routing with up to " + std::to_string(c.max_route_slots) + " x "
        + std::to_string(c.max_route_slots) + " slots, division rounds correctly: " + yes_no(c.exact_division)
        + ", square root: " + yes_no(c.exact_sqrt)
        + (c.loop_limit > 0 ? ", loops end after " + std::to_string(c.loop_limit) + " iterations" : "");
}
