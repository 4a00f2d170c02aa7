// OpenGL 4.5 core contexts by OSMesa, where that is installed. Without it the functions below find nothing, so that no
// other file asks whether it is.
#pragma once

#include <photongrid/backends/gl/context.hpp>

#include <memory>
#include <string>

#ifdef PHOTONGRID_HAS_OSMESA

#include <GL/osmesa.h>

#include <array>

namespace photongrid::gl {

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

inline void (*find_by_osmesa(const char* name))() { return OSMesaGetProcAddress(name); }

/// The context that OSMesa made current in this thread; nullptr: none.
inline const void* current_by_osmesa() { return OSMesaGetCurrentContext(); }

/// Creates an OSMesa context. Without one it returns nullptr and adds the reason to `tried`.
inline std::shared_ptr<context> make_osmesa_context(std::string& tried)
{
    try {
        auto c = std::make_shared<osmesa_context>();
        c->use();
        c->call.load(find_by_osmesa);
        return c;
    } catch (const backend_error& e) {
        tried += std::string("  OSMesa: ") + e.what() + " (Debian package libosmesa6)\n";
        return nullptr;
    }
}

} // namespace photongrid::gl

#else

namespace photongrid::gl {

inline void (*find_by_osmesa(const char*))() { return nullptr; }
inline const void* current_by_osmesa() { return nullptr; }
inline std::shared_ptr<context> make_osmesa_context(std::string& tried)
{
    tried += "  OSMesa: this program was built without it (Debian package libosmesa6-dev, then configure again)\n";
    return nullptr;
}

} // namespace photongrid::gl

#endif
