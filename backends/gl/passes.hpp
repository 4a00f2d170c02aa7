// One pass: binds a kernel's Params and textures, sets its render targets, and draws a launch.
#pragma once

#include <photongrid/backends/gl/device.hpp>
#include <photongrid/backends/gl/regions.hpp>

namespace photongrid::gl {

/// Binds what kernel K reads: its Params, its inputs, and the old values of its states. `reads` and `writes` are the
/// textures of its inputs and of its outputs.
template <class K, std::size_t Reads, std::size_t Writes>
void bind(device& on, const typename K::Params& args, const std::array<GLuint, Reads>& reads,
    const std::array<GLuint, Writes>& writes)
{
    static_assert(input_count<K> <= max_inputs && output_count<K> <= max_outputs,
        "OpenGL passes have at most 10 inputs and 8 outputs");
    on.prepare_passes();
    on.set_uniforms(&args, sizeof args);
    for (std::size_t i = 0; i < Reads; ++i)
        on.bind_texture(static_cast<GLuint>(i), reads[i]);
    if constexpr (Writes != 0)
        photongrid::detail::for_each_slot<Writes>([&](auto s) {
            if constexpr (K::is_state(s))
                on.bind_texture(state_unit + s.index, writes[s.index]);
        });
}

/// Sets the textures of kernel K's outputs as render targets. Returns whether the pass also reads one of them.
template <class K, std::size_t Reads, std::size_t Writes>
bool set_targets(device& on, const std::array<GLuint, Reads>& reads, const std::array<GLuint, Writes>& writes)
{
    static_assert(output_count<K> != 0, "a kernel needs an OUTPUT or STATE to run");
    bool feedback = false;
    if constexpr (Writes != 0)
        photongrid::detail::for_each_slot<Writes>([&](auto s) { feedback = feedback || K::is_state(s); });
    for (const GLuint read : reads)
        feedback = feedback || std::find(writes.begin(), writes.end(), read) != writes.end();
    on.draw_into(writes);
    return feedback;
}

/// Uses the program, and sets the elements that a draw computes.
inline void set_launch(device& on, GLuint program, const launch& l)
{
    // The triangle covers exactly the viewport, so only fragments in the launch's rectangle are computed.
    // gl_FragCoord is relative to the target's corner, so it is the texel.
    const region r = region_of(l);
    on.set_viewport(r.x, r.y, r.width, r.height);
    on.call.UseProgram(program);
    on.call.ProgramUniform4ui(program, 0, l.first, l.elements, 0, 0);
}

inline void draw(device& on, GLuint program, const launch& l)
{
    set_launch(on, program, l);
    on.call.DrawArrays(GL_TRIANGLES, 0, 3);
}

/// Counts in `query` the elements that the program does not discard, by a pass that writes nothing.
inline void draw_counted(device& on, GLuint program, const launch& l, GLuint query)
{
    const region r = region_of(l);
    on.draw_into_nothing(static_cast<uint>(r.y + r.height));
    on.call.BeginQuery(GL_SAMPLES_PASSED, query);
    draw(on, program, l);
    on.call.EndQuery(GL_SAMPLES_PASSED);
}

} // namespace photongrid::gl
