// The tally of gather_bias.glsl: x: 1: done.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline uvec4 bias_tally(bool is_done)
{
    return uvec4(is_done ? 1u : 0u, 0u, 0u, 0u);
}
inline bool has_bias(uvec4 tally)
{
    return tally.x != 0u;
}

#endif
