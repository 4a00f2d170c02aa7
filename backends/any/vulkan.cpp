#include <photongrid/backends/vulkan/vulkan.hpp>

#include <photongrid/backends/any/owning_renderer.hpp>

namespace photongrid::any {

namespace {
    std::unique_ptr<renderer> make(const renderer_options& o)
    {
        return std::make_unique<owning_renderer<vulkan_backend>>(
            vulkan_options{.device = o.device, .time_passes = o.time_passes, .cache_folder = o.shader_cache});
    }

    std::optional<std::string> hardware()
    {
        try {
            // The first discrete device, else the first hardware device.
            std::optional<std::string> found;
            for (const auto& d : vulkan_devices())
                if (!d.software && d.unusable.empty() && (!found || d.type == "discrete")) {
                    found = std::to_string(d.index);
                    if (d.type == "discrete")
                        break;
                }
            return found;
        } catch (const backend_error&) {
            return std::nullopt; // no Vulkan at all
        }
    }

    std::vector<device_report> devices()
    {
        std::vector<device_report> all;
        try {
            for (const auto& d : vulkan_devices()) {
                device_report r{.backend = "vulkan",
                    .device = std::to_string(d.index) + ": " + d.name + " (" + d.type + ", " + d.driver + ", Vulkan "
                        + d.api_version + ")"};
                r.works = d.unusable.empty();
                r.description = d.unusable;
                if (r.works)
                    try {
                        const vulkan_backend b(vulkan_options{.device = std::to_string(d.index)});
                        r.description = limits(b.caps());
                    } catch (const backend_error& e) {
                        r.works = false;
                        r.description = e.what();
                    }
                all.push_back(r);
            }
            if (all.empty())
                all.push_back({.backend = "vulkan",
                    .description = "vulkan: the drivers list no device (Debian: apt install mesa-vulkan-drivers)"});
        } catch (const backend_error& e) {
            all.push_back({.backend = "vulkan", .description = e.what()});
        }
        return all;
    }
} // namespace

backend_entry vulkan_entry() { return {make, devices, hardware}; }

} // namespace photongrid::any

#ifdef PHOTONGRID_COMPILES_ALGORITHMS
#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {
PHOTONGRID_ALGORITHMS(, vulkan_backend)
PHOTONGRID_PICTURES(, vulkan_backend)
} // namespace photongrid
#endif
