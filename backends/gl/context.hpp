// OpenGL 4.5 core contexts without a window: EGL surfaceless, OSMesa, or the caller's current context.
#pragma once

#include <photongrid/backends/gl/functions.hpp>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#ifdef PHOTONGRID_HAS_OSMESA
#include <GL/osmesa.h>
#endif

#include <array>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>
#include <vector>

namespace photongrid {

/// The origin of the OpenGL context.
enum class gl_context_kind {
    any,     ///< EGL, else OSMesa
    egl,     ///< EGL without a surface
    osmesa,  ///< OSMesa: always software
    current, ///< the caller's context, which must be current at construction and at every call
};

} // namespace photongrid

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

inline std::string egl_error_name(EGLint code)
{
    constexpr std::array names{"EGL_SUCCESS", "EGL_NOT_INITIALIZED", "EGL_BAD_ACCESS", "EGL_BAD_ALLOC",
        "EGL_BAD_ATTRIBUTE", "EGL_BAD_CONFIG", "EGL_BAD_CONTEXT", "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
        "EGL_BAD_MATCH", "EGL_BAD_NATIVE_PIXMAP", "EGL_BAD_NATIVE_WINDOW", "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",
        "EGL_CONTEXT_LOST"};
    const auto index = static_cast<std::size_t>(code - EGL_SUCCESS);
    return index < names.size() ? names[index] : "EGL error " + std::to_string(code);
}

class egl_context final : public context {
public:
    /// Creates an OpenGL 4.5 core context on `display`. The exception says which step failed.
    egl_context(EGLDisplay display, bool debug) : display_(display)
    {
        const auto fail = [](const char* step) {
            throw backend_error(std::string(step) + " failed with " + egl_error_name(eglGetError()));
        };
        if (display == EGL_NO_DISPLAY)
            fail("eglGetPlatformDisplay");
        if (!eglInitialize(display, nullptr, nullptr))
            fail("eglInitialize");
        const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
        for (const char* extension : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"})
            if (extensions == nullptr || std::string_view(extensions).find(extension) == std::string_view::npos)
                throw backend_error(std::string("the EGL display has no ") + extension);
        if (!eglBindAPI(EGL_OPENGL_API))
            fail("eglBindAPI(EGL_OPENGL_API)");
        const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
            EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_CONTEXT_OPENGL_DEBUG,
            debug ? EGL_TRUE : EGL_FALSE, EGL_NONE};
        context_ = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        if (context_ == EGL_NO_CONTEXT)
            fail("eglCreateContext (OpenGL 4.5 core)");
    }
    ~egl_context() override
    {
        egl_context::release();
        eglDestroyContext(display_, context_); // do not terminate the display: other contexts may use it
    }

protected:
    bool is_current() const override { return eglBindAPI(EGL_OPENGL_API) && eglGetCurrentContext() == context_; }
    void bind() override
    {
        eglBindAPI(EGL_OPENGL_API);
        if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            throw backend_error("gl: eglMakeCurrent failed with " + egl_error_name(eglGetError())
                + "; is the context current in another thread?");
    }
    void release() noexcept override
    {
        if (is_current())
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

private:
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
};

#ifdef PHOTONGRID_HAS_OSMESA
class osmesa_context final : public context {
public:
    osmesa_context()
    {
        name = "gl-osmesa";
        const std::array<int, 13> attributes{OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_STENCIL_BITS, 8,
            OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION, 4, OSMESA_CONTEXT_MINOR_VERSION, 5, 0};
        context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        if (context_ == nullptr)
            throw backend_error("OSMesaCreateContextAttribs (OpenGL 4.5 core) returned no context");
    }
    ~osmesa_context() override
    {
        osmesa_context::release();
        OSMesaDestroyContext(context_);
    }

protected:
    bool is_current() const override { return OSMesaGetCurrentContext() == context_; }
    void bind() override
    {
        // OSMesa needs memory for a window, though nothing is drawn into it.
        if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 4, 4))
            throw backend_error("gl-osmesa: OSMesaMakeCurrent failed");
    }
    void release() noexcept override
    {
        if (is_current())
            OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    }

private:
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 64> window_{};
};
#endif

/// The caller's context. Every call checks that it is current, if EGL or OSMesa can tell.
class callers_context final : public context {
public:
    callers_context() : token_(current_token()) {}
    bool is_callers() const override { return true; }

protected:
    bool is_current() const override { return false; } // so that every call uses bind()
    void bind() override
    {
        if (current_token() != token_)
            throw backend_error("gl: the context that was current when this backend was created is not current now; "
                                "make it current before every call");
    }
    void release() noexcept override {}

private:
    static const void* current_token()
    {
        eglBindAPI(EGL_OPENGL_API);
        if (const void* c = eglGetCurrentContext())
            return c;
#ifdef PHOTONGRID_HAS_OSMESA
        return OSMesaGetCurrentContext();
#else
        return nullptr;
#endif
    }
    const void* token_;
};

inline void (*find_by_egl(const char* name))() { return eglGetProcAddress(name); }
#ifdef PHOTONGRID_HAS_OSMESA
inline void (*find_by_osmesa(const char* name))() { return OSMesaGetProcAddress(name); }
#endif

/// Whether a renderer is one of Mesa's that run on the CPU.
inline bool is_software(std::string_view renderer)
{
    for (const char* name : {"llvmpipe", "softpipe", "SWR", "Software Rasterizer"})
        if (renderer.find(name) != std::string_view::npos)
            return true;
    return false;
}

/// Creates an EGL context on a hardware device if there is one, else on Mesa's software renderer.
inline std::shared_ptr<context> make_egl_context(bool debug, std::string& tried)
{
    const auto find = [](auto& f, const char* name) {
        f = reinterpret_cast<std::remove_reference_t<decltype(f)>>(eglGetProcAddress(name));
    };
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view extensions = client != nullptr ? client : "";
    std::shared_ptr<context> software;
    const auto attempt = [&](const std::string& what, EGLDisplay display) -> std::shared_ptr<context> {
        try {
            auto c = std::make_shared<egl_context>(display, debug);
            c->use();
            c->call.load(find_by_egl);
            if (!is_software(reinterpret_cast<const char*>(c->call.GetString(GL_RENDERER))))
                return c;
            if (!software)
                software = c;
        } catch (const backend_error& e) {
            tried += "  EGL, " + what + ": " + e.what() + "\n";
        }
        return nullptr;
    };
    if (extensions.find("EGL_MESA_platform_surfaceless") != std::string_view::npos) {
        if (auto c = attempt("surfaceless (eglGetPlatformDisplay)",
                eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)))
            return c;
    } else {
        tried += "  EGL, surfaceless: the library has no EGL_MESA_platform_surfaceless (Debian packages libegl1, "
                 "libegl-mesa0)\n";
    }
    // Drivers without the surfaceless platform have the device platform.
    PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC query_string = nullptr;
    find(query_devices, "eglQueryDevicesEXT");
    find(query_string, "eglQueryDeviceStringEXT");
    if (query_devices != nullptr && query_string != nullptr
        && extensions.find("EGL_EXT_platform_device") != std::string_view::npos) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint n = 0;
        query_devices(static_cast<EGLint>(devices.size()), devices.data(), &n);
        for (EGLint d = 0; d < n; ++d) {
            const char* abilities = query_string(devices[static_cast<std::size_t>(d)], EGL_EXTENSIONS);
            if (abilities != nullptr
                && std::string_view(abilities).find("EGL_MESA_device_software") != std::string_view::npos && software)
                continue;
            if (auto c = attempt("device " + std::to_string(d),
                    eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(d)], nullptr)))
                return c;
        }
    }
    return software;
}

/// Creates a context of the given kind, loads its functions and makes it current. `find`: for the kind `current`, the
/// caller's function loader; empty: that of EGL or OSMesa, whichever has a current context.
/// \throws backend_error that says what was tried, what failed and which package to install.
inline std::shared_ptr<context> make_context(gl_context_kind kind, bool debug, loader find)
{
    if (kind == gl_context_kind::current) {
        auto c = std::make_shared<callers_context>();
        c->use();
        if (find == nullptr) {
            find = find_by_egl;
#ifdef PHOTONGRID_HAS_OSMESA
            if (OSMesaGetCurrentContext() != nullptr && eglGetCurrentContext() == EGL_NO_CONTEXT)
                find = find_by_osmesa;
#endif
        }
        c->call.load(find);
        const auto* version = reinterpret_cast<const char*>(c->call.GetString(GL_VERSION));
        if (version == nullptr)
            throw backend_error("gl: no OpenGL context is current in this thread; make yours current before "
                                "constructing the backend, or use gl_context_kind::any");
        GLint major = 0, minor = 0;
        c->call.GetIntegerv(GL_MAJOR_VERSION, &major);
        c->call.GetIntegerv(GL_MINOR_VERSION, &minor);
        if (major * 10 + minor < 45)
            throw backend_error(std::string("gl: the current context is OpenGL ") + version + "; 4.5 core is needed");
        return c;
    }
    std::string tried;
    if (kind != gl_context_kind::osmesa)
        if (auto c = make_egl_context(debug, tried)) {
            c->use();
            return c;
        }
    if (kind != gl_context_kind::egl) {
#ifdef PHOTONGRID_HAS_OSMESA
        try {
            auto c = std::make_shared<osmesa_context>();
            c->use();
            c->call.load(find_by_osmesa);
            return c;
        } catch (const backend_error& e) {
            tried += std::string("  OSMesa: ") + e.what() + " (Debian package libosmesa6)\n";
        }
#else
        tried += "  OSMesa: this program was built without it (Debian package libosmesa6-dev, then configure again)\n";
#endif
    }
    throw backend_error("gl: no OpenGL 4.5 core context could be created. Tried:\n" + tried
        + "Install a driver: apt install libegl1 libgl1-mesa-dri (Mesa, also without a GPU), or libosmesa6");
}

} // namespace photongrid::gl
