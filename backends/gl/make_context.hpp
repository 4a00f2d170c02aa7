// Creates the context of a backend: by EGL, by OSMesa, or the caller's current one.
#pragma once

#include <photongrid/backends/gl/egl_context.hpp>
#include <photongrid/backends/gl/options.hpp>
#include <photongrid/backends/gl/osmesa_context.hpp>

namespace photongrid::gl {

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
        return current_by_osmesa();
    }
    const void* token_;
};

/// Creates a context of the given kind, loads its functions and makes it current. `find`: for the kind `current`, the
/// caller's function loader; empty: that of EGL or OSMesa, whichever has a current context.
/// \throws backend_error that says what was tried, what failed and which package to install.
inline std::shared_ptr<context> make_context(gl_context_kind kind, bool debug, loader find)
{
    if (kind == gl_context_kind::current) {
        auto c = std::make_shared<callers_context>();
        c->use();
        if (find == nullptr) {
            const bool by_osmesa = current_by_osmesa() != nullptr && eglGetCurrentContext() == EGL_NO_CONTEXT;
            find = by_osmesa ? find_by_osmesa : find_by_egl;
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
    if (kind != gl_context_kind::egl)
        if (auto c = make_osmesa_context(tried))
            return c;
    throw backend_error("gl: no OpenGL 4.5 core context could be created. Tried:\n" + tried
        + "Install a driver: apt install libegl1 libgl1-mesa-dri (Mesa, also without a GPU), or libosmesa6");
}

} // namespace photongrid::gl
