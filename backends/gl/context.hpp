// An OpenGL context, of any origin.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

#include <mutex>
#include <set>
#include <string_view>

namespace photongrid::gl {

/// A context. `use()` makes it current. A context belongs to one thread at a time.
class context {
public:
    functions call;
    std::string name = "gl"; ///< the backend's name: "gl" or "gl-osmesa"

    context()
    {
        const std::lock_guard lock(living().mutex);
        living().contexts.insert(this);
    }
    context(const context&) = delete;
    context& operator=(const context&) = delete;
    virtual ~context()
    {
        const std::lock_guard lock(living().mutex);
        living().contexts.erase(this);
    }

    /// \throws backend_error if the context cannot be made current.
    void use()
    {
        // It has no destructor, so that backends in static storage can be destroyed after the thread-local variables.
        thread_local context* last = nullptr;
        if (last == this && is_current())
            return;
        // Mesa's EGL and OSMesa share one current context per thread but do not notify each other, so the previous
        // context must be released.
        if (last != nullptr && last != this && !is_callers() && is_living(last))
            last->release();
        bind();
        last = this;
    }

    /// Whether it is the caller's context, whose state may have changed since the last call.
    virtual bool is_callers() const { return false; }

protected:
    virtual bool is_current() const = 0;
    virtual void bind() = 0;
    virtual void release() noexcept = 0;

private:
    struct registry {
        std::mutex mutex;
        std::set<const context*> contexts;
    };
    /// All contexts. Never destroyed, for the same reason.
    static registry& living()
    {
        static auto* const all = new registry;
        return *all;
    }
    static bool is_living(const context* c)
    {
        const std::lock_guard lock(living().mutex);
        return living().contexts.contains(c);
    }
};

/// Whether a renderer is one of Mesa's that run on the CPU.
inline bool is_software(std::string_view renderer)
{
    for (const char* name : {"llvmpipe", "softpipe", "SWR", "Software Rasterizer"})
        if (renderer.find(name) != std::string_view::npos)
            return true;
    return false;
}

} // namespace photongrid::gl
