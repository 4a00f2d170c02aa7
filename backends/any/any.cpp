#include <photongrid/backends/any/backend_entry.hpp>

#include <algorithm>

namespace photongrid {

namespace any {
    namespace {
        /// All backends, and the packages and options that a build without them lacks.
        struct known_backend {
            const char* name;
            const char* lacks;
        };
        constexpr known_backend known[]
            = {{"serial", ""}, {"cpu", "libtbb-dev and libhwy-dev, then configure with -DPHOTONGRID_CPU=ON"},
                {"gl", "libegl-dev, libopengl-dev and libgl-dev, then configure with -DPHOTONGRID_GL=ON"},
                {"gl-osmesa",
                    "libegl-dev, libopengl-dev, libgl-dev and libosmesa6-dev, then configure with -DPHOTONGRID_GL=ON"},
                {"vulkan",
                    "libvulkan-dev, glslang-dev, glslang-tools and spirv-tools, then configure with "
                    "-DPHOTONGRID_VULKAN=ON"}};

        const backend_entry* find(const std::string& name)
        {
            for (const auto& e : built_backends())
                if (std::find(e.names.begin(), e.names.end(), name) != e.names.end())
                    return &e;
            return nullptr;
        }
        std::string not_built(const known_backend& b)
        {
            return std::string(b.name) + ": photongrid was built without it; install " + b.lacks;
        }
    } // namespace

    std::string limits(const capabilities& c)
    {
        const auto yes_no = [](bool b) { return b ? "yes" : "no"; };
        return std::string(c.software ? "software" : "hardware") + ", buffers of up to "
            + std::to_string(c.max_elements) + " elements, routing with up to " + std::to_string(c.max_route_slots)
            + " x " + std::to_string(c.max_route_slots) + " slots, division rounds correctly: "
            + yes_no(c.exact_division) + ", square root: " + yes_no(c.exact_sqrt)
            + (c.loop_limit > 0 ? ", loops end after " + std::to_string(c.loop_limit) + " iterations" : "");
    }
} // namespace any

renderer_options chosen(renderer_options o)
{
    if (o.backend != "auto")
        return o;
    for (const auto& e : any::built_backends())
        if (e.hardware)
            if (const auto device = e.hardware()) {
                o.backend = e.names.front();
                o.device = *device;
                return o;
            }
    o.backend = any::find("cpu") ? "cpu" : "serial";
    return o;
}

std::unique_ptr<renderer> make_renderer(const renderer_options& asked)
{
    const auto o = chosen(asked);
    if (const auto* e = any::find(o.backend))
        return e->make(o);
    std::string names = "auto";
    for (const auto& b : any::known) {
        if (o.backend == b.name)
            throw backend_error(any::not_built(b));
        names += std::string(", ") + b.name;
    }
    throw std::invalid_argument("make_renderer: backend: there is no backend \"" + o.backend + "\"; use " + names);
}

std::vector<device_report> find_devices()
{
    std::vector<device_report> all;
    for (const auto& b : any::known) {
        const auto* e = any::find(b.name);
        if (!e)
            all.push_back({.backend = b.name, .description = any::not_built(b)});
        else if (e->names.front() == b.name) // an entry with several names reports on all of them
            for (auto& d : e->devices())
                all.push_back(std::move(d));
    }
    return all;
}

} // namespace photongrid
