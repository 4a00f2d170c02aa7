// The colour of the surface that a photon left, in one number: what the next frame of bounce_photon.glsl needs of it
// and a frame has room for. It says which channel is largest, and has the others divided by it, in 11 bits each.
// Included by kernels after core/vector.glsl.

float color_code(vec3 color)
{
    float most = largest3(color);
    uint which = color.x == most ? 0u : (color.y == most ? 1u : 2u);
    vec2 others = vec2(which == 0u ? color.y : color.x, which == 2u ? color.y : color.z);
    precise vec2 scaled = others / most;
    precise vec2 rounded = vec2(scaled.x * 2047.0f + 0.5f, scaled.y * 2047.0f + 0.5f);
    return float(which * 4194304u + uint(rounded.x) * 2048u + uint(rounded.y));
}

// The colour, divided by its largest channel.
vec3 color_of_code(float code)
{
    uint bits = uint(code);
    uint which = bits >> 22u;
    precise vec2 others = vec2(float((bits >> 11u) & 2047u) / 2047.0f, float(bits & 2047u) / 2047.0f);
    return which == 0u ? vec3(1.0f, others.x, others.y)
                       : (which == 1u ? vec3(others.x, 1.0f, others.y) : vec3(others.x, others.y, 1.0f));
}
