// The shortest way for files that link photongrid::cpu_compiled: the type cpu_backend, photon_map and point_index on
// it, whose members the library holds. Such a file takes the compiler half as long as with cpu.hpp. Files that render
// with code of their own include cpu.hpp, which has the overrides of the renderer too. Without the library it is
// cpu.hpp.
#pragma once

#if defined(PHOTONGRID_CPU_COMPILED)
#include <photongrid/backends/cpu/cpu_backend.hpp>
#else
#include <photongrid/backends/cpu/cpu.hpp>
#endif
#include <photongrid/photon_map.hpp>
#include <photongrid/point_index.hpp>

#if defined(PHOTONGRID_CPU_COMPILED)
namespace photongrid {

// The override of the renderer is declared even where it is not defined (overrides/trace_batch.hpp): a file that
// renders without cpu.hpp does not link, and none uses another algorithm than the other files of its program.
template <backend B>
struct device_scene;
template <backend B>
struct path_batch;
struct render_settings;
namespace detail {
    template <backend B>
    struct photon_frames;
}
template <backend B>
requires std::same_as<B, cpu_backend> uint trace_batch(B& device, const device_scene<B>& s, detail::photon_frames<B>& f,
    const path_batch<B>& batch, const render_settings& settings);

extern template class photon_map<cpu_backend>;
extern template class point_index<cpu_backend>;

} // namespace photongrid
#endif
