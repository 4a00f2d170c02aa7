#include <photongrid/backends/any/owning_renderer.hpp>
#include <photongrid/backends/gl/gl.hpp>

namespace photongrid::any {

namespace {
    std::unique_ptr<renderer> make(const renderer_options& o)
    {
        return std::make_unique<owning_renderer<gl_backend>>(
            gl_options{.context = o.backend == "gl-osmesa" ? gl_context_kind::osmesa : gl_context_kind::egl,
                .time_passes = o.time_passes});
    }

    std::vector<device_report> devices()
    {
        std::vector<device_report> all;
        for (const bool osmesa : {false, true}) {
            device_report r{.backend = osmesa ? "gl-osmesa" : "gl"};
            try {
                const gl_backend b(gl_options{.context = osmesa ? gl_context_kind::osmesa : gl_context_kind::egl});
                r.device = b.caps().device;
                r.works = true;
                r.description = limits(b.caps());
            } catch (const backend_error& e) {
                r.description = e.what();
            }
            all.push_back(r);
        }
        return all;
    }
} // namespace

backend_entry gl_entry() { return {make, devices, nullptr}; }

} // namespace photongrid::any

#ifdef PHOTONGRID_COMPILES_ALGORITHMS
#include <photongrid/backends/any/compiled_algorithms.hpp>

namespace photongrid {
PHOTONGRID_ALGORITHMS(, gl_backend)
PHOTONGRID_PICTURES(, gl_backend)
} // namespace photongrid
#endif
