// The media that a ray is in (trace/media.hpp): a set of them, as bits. Medium n has bit n; the highest one is there.
// Included by kernels after their scene buffer, core/natural_exp.glsl and trace/materials.glsl.
#include <photongrid/trace/inside_code.glsl>

// Records of MEDIA_TABLE, rgb: absorption, 1/m; w: index of refraction.
vec4 medium_record(uint inside)
{
    // A float's exponent says which its highest bit is.
    uint highest = (floatBitsToUint(float(inside)) >> 23u) - 127u;
    return scene(table_of(scene(MEDIA_TABLE)).first + highest);
}

// The share of light that is left after a way of t metres.
vec3 left_after(uint inside, float t)
{
    if (inside == 0u)
        return vec3(1.0f, 1.0f, 1.0f);
    vec4 medium = medium_record(inside);
    precise vec3 depth = vec3(medium) * t;
    return vec3(exp_of_minus(depth.x), exp_of_minus(depth.y), exp_of_minus(depth.z));
}

// A surface of glass that a ray meets.
struct Crossing {
    bool is_real;    // else a medium of higher priority is on both sides
    float index;     // of refraction of the inside, relative to the outside
    uint in_front;   // the media on the ray's side ...
    uint behind;     // ... and on the other one
};

// A material between other media than air: its facets then scatter light once, since the table of what they hide is
// that of its own index.
Material between_media(Material m, Crossing c)
{
    if (c.index != m.index_of_refraction)
        m.rebounds = 0u;
    m.index_of_refraction = c.index;
    return m;
}

// The ray is in the media `inside`, and meets a material with this index of refraction.
Crossing crossing(uint inside, uint material, bool outside, float index)
{
    Crossing c;
    c.is_real = true;
    c.index = index;
    c.in_front = inside;
    c.behind = inside;
    // 1 + the number of the material's medium; negative: an interface; 0: its bodies are alone in the air
    float medium = scene(FIRST_MATERIAL + MATERIAL_RECORDS * material + 3u).w;
    if (medium == 0.0f)
        return c;
    uint bit = 1u << ((uint(abs(medium)) - 1u) & 31u);
    uint others = inside & ~bit;
    c.in_front = outside ? others : others | bit;
    c.behind = outside ? others | bit : others;
    if (medium > 0.0f) {
        c.is_real = bit > others;
        precise float relative = index / (others == 0u ? 1.0f : medium_record(others).w);
        c.index = relative;
    }
    return c;
}
