#include <photongrid/backends/any/module.hpp>

#include <filesystem>
#include <mutex>

#include <dlfcn.h>

namespace photongrid::any {

namespace {
    /// Debian's packages with the libraries of a module.
    const char* packages_of(const std::string& module)
    {
        return module == "gl"    ? "libegl1 libosmesa6"
            : module == "vulkan" ? "libvulkan1"
            : module == "window" ? "libglfw3 libopengl0"
                                 : "libc6 libstdc++6";
    }

    /// Where a module is, or would be.
    struct places {
        std::filesystem::path built, installed;

        explicit places(const std::string& name)
        {
            const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
            built = program / "photongrid-modules" / (name + ".so");
            installed = program / PHOTONGRID_MODULES / (name + ".so");
        }
        /// Empty: nowhere.
        std::filesystem::path found() const { return exists(built) ? built : exists(installed) ? installed : ""; }
        std::string why_not(const std::string& name) const
        {
            if (!exists(built.parent_path()))
                return "there is neither " + built.string() + " nor " + installed.lexically_normal().string()
                    + "; keep the program with its modules, or install them (with photongrid's Debian packages: "
                      "photongrid"
                    + (name == "serial" ? "" : "-" + name) + ")";
            // CMake makes the folder, and the modules in it are built when they are asked for.
            return "its module has not been built; in the folder of the sources, `examples/run.sh "
                + (name == "window" ? "--view" : "--backend " + name)
                + "` installs what it needs, builds it and uses it (with everything installed: `cmake --build "
                + built.parent_path().parent_path().string() + " --target photongrid_module_" + name + "`)";
        }
    };

    void* load(const std::string& name)
    {
        const places where(name);
        const auto path = where.found();
        if (path.empty())
            throw backend_error(name + ": " + where.why_not(name));
        // Never unloaded: drivers leave threads and handlers behind.
        if (void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
            return module;
        const char* const reason = dlerror();
        throw backend_error(name + ": " + (reason ? reason : "its module cannot be loaded")
            + "; install its libraries (Debian: apt install " + packages_of(name) + ")");
    }
} // namespace

bool has_module(const std::string& name) { return !places(name).found().empty(); }

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
