#include <photongrid/backends/any/module.hpp>

#include <filesystem>
#include <mutex>

#include <dlfcn.h>

namespace photongrid::any {

namespace {
    /// Debian's packages with the libraries of a module.
    const char* packages_of(const std::string& module)
    {
        return module == "gl" ? "libegl1 libosmesa6" : module == "vulkan" ? "libvulkan1" : "libglfw3 libopengl0";
    }

    void* load(const std::string& name)
    {
        const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
        const auto built = program / "photongrid-modules" / (name + ".so"),
                   installed = program / PHOTONGRID_MODULES / (name + ".so");
        const auto& path = std::filesystem::exists(built) ? built : installed;
        if (!std::filesystem::exists(path))
            throw backend_error(name + ": there is neither " + built.string() + " nor "
                + installed.lexically_normal().string() + "; keep the program with its modules, or install it again");
        // Never unloaded: drivers leave threads and handlers behind.
        if (void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
            return module;
        const char* const reason = dlerror();
        throw backend_error(name + ": " + (reason ? reason : "its module cannot be loaded")
            + "; install its libraries (Debian: apt install " + packages_of(name) + ")");
    }
} // namespace

void* function_of_module(const std::string& name, const std::string& function)
{
    static std::mutex one_at_a_time; // dlerror() is of the last call
    const std::lock_guard lock(one_at_a_time);
    void* const module = load(name);
    const auto version = reinterpret_cast<long (*)()>(dlsym(module, "photongrid_module_version"));
    void* const found = dlsym(module, function.c_str());
    if (!version || version() != library_version || !found)
        throw backend_error(name + ": its module is of another version than the program; install photongrid again");
    return found;
}

backend_entry entry_of_module(const std::string& name)
{
    return *reinterpret_cast<const backend_entry* (*)()>(function_of_module(name, "photongrid_backend_entry"))();
}

} // namespace photongrid::any
