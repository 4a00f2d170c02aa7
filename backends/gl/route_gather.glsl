#version 450
// Copies the drawn footprints, m x m pixels per destination, to the linear list of slots.
layout(location = 0) uniform uvec4 shape_; // destinations per row, all destinations, m, capacity
layout(binding = 0) uniform usampler2D drawn_;
layout(location = 0) out uint slot_;
void main()
{
    uint i = uint(gl_FragCoord.y) << 11u | uint(gl_FragCoord.x);
    uint d = i / shape_.w;
    uint s = i % shape_.w;
    slot_ = 0xFFFFFFFFu;
    if (d < shape_.y) {
        uvec2 at = uvec2(d % shape_.x, d / shape_.x) * shape_.z + uvec2(s % shape_.z, s / shape_.z);
        slot_ = texelFetch(drawn_, ivec2(at), 0).x;
    }
}
