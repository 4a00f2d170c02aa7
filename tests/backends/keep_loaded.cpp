// Preloaded by tests/run.sh --full: keeps the libraries named in PHOTONGRID_KEEP_LOADED (separated by colons) in memory
// until the process ends. The Vulkan loader unloads drivers and layers, after which LeakSanitizer can no longer name,
// and so not suppress, what they leak. Opened privately: preloading a layer itself would put its functions before the
// loader's.
#include <cstdlib>
#include <dlfcn.h>
#include <string>

[[gnu::constructor]] static void keep_loaded()
{
    const char* list = std::getenv("PHOTONGRID_KEEP_LOADED");
    std::string rest = list != nullptr ? list : "";
    while (!rest.empty()) {
        const auto end = rest.find(':');
        dlopen(rest.substr(0, end).c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
        rest.erase(0, end == std::string::npos ? end : end + 1);
    }
}
