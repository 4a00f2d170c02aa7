// Surfaces that are clear in places, and mixtures of two materials. Included by kernels after trace/materials.glsl.
SWITCH(21, MIXTURES)

// How many vectors mesh_color.glsl writes for a hit: one; in scenes with mixtures or clear surfaces one for each of two
// parts, and one for opacity and share.
uint colors_per_hit()
{
    return MIXTURES || CLEAR ? 3u : 1u;
}

// Of a material, opacity; of a mixture too, the share of its second part and the materials of both.
struct Parts {
    float opacity;
    float share;
    uint first;
    uint second;
};

Parts parts_of(uint material)
{
    vec4 record = scene(FIRST_MATERIAL + MATERIAL_RECORDS * material + 2u);
    Parts p;
    p.opacity = record.x;
    p.share = record.y;
    p.first = uint(record.z);
    p.second = uint(record.w);
    return p;
}

bool is_mixture(uint material)
{
    return uint(scene(FIRST_MATERIAL + MATERIAL_RECORDS * material).w) == MIXED_SURFACE;
}
