#version 450
// Draws one bit plane of the stencil pattern: slot s of a destination starts at capacity - 1 - s, so that each arriving
// point finds exactly one slot at capacity - 1. Slots past the capacity start at 255 and never match. It uses bit
// planes because ARB_shader_stencil_export is not always available.
layout(location = 0) uniform uvec4 plane_; // m, capacity, bit
void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy) % plane_.x;
    uint s = at.y * plane_.x + at.x;
    uint value = s < plane_.y ? plane_.y - 1u - s : 255u;
    if (((value >> plane_.z) & 1u) == 0u)
        discard;
}
