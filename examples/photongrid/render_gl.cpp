
#include "renderer_on.hpp"

#include <photongrid/backends/gl/gl.hpp>

namespace photongrid {

std::unique_ptr<renderer> gl_renderer(const renderer_options& o)
{
    return std::make_unique<renderer_on<gl_backend>>(
        gl_options{.context = o.backend == "gl-osmesa" ? gl_context_kind::osmesa : gl_context_kind::egl,
            .time_passes = o.time_passes});
}

std::vector<device_report> gl_devices()
{
    std::vector<device_report> all;
    for (const bool osmesa : {false, true}) {
        device_report r{.backend = osmesa ? "gl-osmesa" : "gl"};
        try {
            const gl_backend b(gl_options{.context = osmesa ? gl_context_kind::osmesa : gl_context_kind::egl});
            r.device = b.caps().device;
            r.works = true;
            r.about = limits(b.caps());
        } catch (const backend_error& e) {
            r.about = e.what();
        }
        all.push_back(r);
    }
    return all;
}

} // namespace photongrid
