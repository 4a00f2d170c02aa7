#version 450
// One bit plane of the stencil pattern: slot s of a destination begins at capacity - 1 - s, so that each arriving point
// finds one slot at capacity - 1; a slot past the capacity begins at 255 and is never found. Bit planes, because
// ARB_shader_stencil_export is not everywhere.
layout(location = 0) uniform uvec4 plane_; // m, capacity, bit
void main()
{
    uvec2 at = uvec2(gl_FragCoord.xy) % plane_.x;
    uint s = at.y * plane_.x + at.x;
    uint value = s < plane_.y ? plane_.y - 1u - s : 255u;
    if (((value >> plane_.z) & 1u) == 0u)
        discard;
}
