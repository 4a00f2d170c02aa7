// Diffuse surfaces under a coat of a clear dielectric, as plastic and varnished wood are. The coat reflects; light
// that passes is scattered below, and thrown back and forth between coat and base, until it leaves or is absorbed. Both
// sides of such a surface have the coat. Included by kernels after trace/materials.glsl and trace/optics.glsl.
//
// trace/coat_layout.hpp writes the records of coats. The first one: mean share of even light that passes the coat from
// outside; share of diffuse light below that the coat throws back. Of a rough coat, COAT_STEPS / 2 more: the shares
// that pass at three of the cosines 0, 1 / COAT_STEPS, 2 / COAT_STEPS, ... 1; the last is the next record's first.
SWITCH(19, COATS)

struct Coat {
    float index_of_refraction;
    float alpha;       // 0: smooth
    float mean_passed;
    float thrown_back;
    uint shares;       // the record of the shares of a rough coat
};

Coat coat_of(uint material)
{
    vec4 record = scene(FIRST_MATERIAL + MATERIAL_RECORDS * material + 1u);
    vec4 means = scene(uint(record.w));
    Coat c;
    c.index_of_refraction = record.x;
    c.alpha = record.z;
    c.mean_passed = means.x;
    c.thrown_back = means.y;
    c.shares = uint(record.w) + 1u;
    return c;
}

// The share of the light that passes the coat from outside, or to there, in a direction with this cosine outside.
float passes_coat(Coat c, float cosine)
{
    float bounded = cosine < 1.0f ? cosine : 1.0f;
    if (!(c.alpha > 0.0f)) {
        vec3 up = vec3(0.0f, 0.0f, 1.0f);
        precise float passed = 1.0f - fresnel(up * -bounded, up, c.index_of_refraction).reflected;
        return passed;
    }
    precise float at = bounded * float(COAT_STEPS);
    uint step = min(uint(at), COAT_STEPS - 1u);
    vec4 three = scene(c.shares + step / 2u);
    bool odd = (step & 1u) != 0u;
    float low = odd ? three.y : three.x;
    float high = odd ? three.z : three.y;
    precise float passed = low + (high - low) * (at - float(step));
    return passed;
}

// Of the light that passed the coat, the share that leaves again.
vec3 under_coat(Coat c, vec3 base)
{
    precise vec3 left = base * (1.0f - c.thrown_back);
    precise vec3 share = vec3(left.x / (1.0f - base.x * c.thrown_back), left.y / (1.0f - base.y * c.thrown_back),
        left.z / (1.0f - base.z * c.thrown_back));
    return share;
}
