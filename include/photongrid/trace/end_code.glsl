// What the end of an eye ray on a rough surface keeps in place of the geometric normal's z, of which only the sign is
// left; the rest follows from x and y. In scenes with MEDIA, those that the ray is in. In others with textures the
// reflectance, in 8 bits a channel: rebounds (trace/rebounds.glsl) take on its colour once more than throughput has.
// Included by kernels after trace/inside_code.glsl, trace/rebounds.glsl and the SWITCH TEXTURES.

bool keeps_color()
{
    return REBOUNDS && TEXTURES && !MEDIA;
}

float end_code(float z, vec3 color, uint inside)
{
    if (!keeps_color())
        return inside_code(inside, z);
    precise vec3 rounded = color * 255.0f + vec3(0.5f, 0.5f, 0.5f);
    uint bits = (min(uint(rounded.x), 255u) * 256u + min(uint(rounded.y), 255u)) * 256u + min(uint(rounded.z), 255u);
    float code = float(bits + 1u);
    return z < 0.0f ? -code : code;
}

vec3 color_at_end(float code)
{
    uint bits = uint(abs(code)) - 1u;
    precise vec3 color
        = vec3(float(bits >> 16u), float((bits >> 8u) & 255u), float(bits & 255u)) * 3.92156863e-3f;
    return color;
}

float z_at_end(float x, float y, float code)
{
    return keeps_color() || MEDIA ? z_beside(x, y, code) : code;
}
