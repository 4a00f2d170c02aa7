// OpenGL 4.5 core contexts by EGL, without a surface.
#pragma once

#include <photongrid/backends/gl/context.hpp>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <memory>

namespace photongrid::gl {

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

inline void (*find_by_egl(const char* name))() { return eglGetProcAddress(name); }

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

} // namespace photongrid::gl
