#include <photongrid/backends/any/backend_entry.hpp>

#include <algorithm>

namespace photongrid {

namespace any {
    namespace {
        /// A name that renderer_options can have, the entry that it belongs to, and the packages and options that a
        /// build without it lacks.
        struct known_backend {
            const char* name;
            const char* entry;
            const char* lacks;
        };
        constexpr known_backend known[] = {{"serial", "serial", ""},
            {"cpu", "cpu", "libtbb-dev and libhwy-dev, then configure with -DPHOTONGRID_CPU=ON"},
            {"gl", "gl", "libegl-dev, libopengl-dev and libgl-dev, then configure with -DPHOTONGRID_GL=ON"},
            {"gl-osmesa", "gl",
                "libegl-dev, libopengl-dev, libgl-dev and libosmesa6-dev, then configure with -DPHOTONGRID_GL=ON"},
            {"vulkan", "vulkan",
                "libvulkan-dev, glslang-dev, glslang-tools and spirv-tools, then configure with "
                "-DPHOTONGRID_VULKAN=ON"}};

        const built_backend* find(const std::string& entry)
        {
            const auto all = built_backends();
            const auto at = std::find_if(all.begin(), all.end(), [&](const auto& b) { return b.name == entry; });
            return at != all.end() ? &*at : nullptr;
        }
        std::string not_built(const known_backend& b)
        {
            return std::string(b.name) + ": photongrid was built without it; install " + b.lacks;
        }
        std::optional<std::string> hardware_of(const built_backend& b)
        {
            try {
                const auto e = b.entry();
                return e.hardware ? e.hardware() : std::nullopt;
            } catch (const backend_error&) {
                return std::nullopt; // its module cannot be loaded
            }
        }
    } // namespace
} // namespace any

std::vector<renderer_options> candidates(const renderer_options& o)
{
    if (o.backend != "auto")
        return {o};
    std::vector<renderer_options> all;
    const auto add = [&](const char* backend, const std::string& device) {
        all.push_back(o);
        all.back().backend = backend;
        all.back().device = device;
    };
    for (const auto& b : any::built_backends())
        if (const auto device = any::hardware_of(b))
            add(b.name, *device);
    add(any::find("cpu") ? "cpu" : "serial", o.device);
    return all;
}

std::unique_ptr<renderer> make_renderer(const renderer_options& asked)
{
    const auto o = candidates(asked).front();
    std::string names = "auto";
    for (const auto& k : any::known) {
        if (o.backend == k.name) {
            if (const auto* b = any::find(k.entry))
                return b->entry().make(o);
            throw backend_error(any::not_built(k));
        }
        names += std::string(", ") + k.name;
    }
    throw std::invalid_argument("make_renderer: backend: there is no backend \"" + o.backend + "\"; use " + names);
}

std::vector<device_report> find_devices()
{
    std::vector<device_report> all;
    for (const auto& k : any::known) {
        const auto* b = any::find(k.entry);
        try {
            if (!b)
                throw backend_error(any::not_built(k));
            const auto e = b->entry();
            if (k.name == std::string(k.entry)) // an entry with several names reports on all of them
                for (auto& d : e.devices())
                    all.push_back(std::move(d));
        } catch (const backend_error& e) {
            all.push_back({.backend = k.name, .description = e.what()});
        }
    }
    return all;
}

} // namespace photongrid
