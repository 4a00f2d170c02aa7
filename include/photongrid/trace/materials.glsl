// Materials, read from the scene buffer. Included by kernels after their scene buffer. How light leaves surfaces:
// trace/scatter.glsl.
SWITCH(22, CLEAR) // some light goes straight on through surfaces

struct Material {
    vec3 reflectance;          // of glass: transmittance per crossing
    uint kind;                 // LAMBERTIAN_SURFACE, MIRROR_SURFACE, GLASS_SURFACE, COATED_SURFACE, THIN_SURFACE
    float index_of_refraction; // of glass and coats
    float alpha;               // of rough surfaces (trace/microfacet.glsl); 0: smooth
    uint rebounds;             // of those, the record of their table (trace/rebounds.glsl); 0: none
};

// 1 + the number of the material's texture, or 0.
uint texture_of(uint number)
{
    return uint(scene(FIRST_MATERIAL + MATERIAL_RECORDS * number + 1u).y);
}

Material material_of(uint number)
{
    uint at = FIRST_MATERIAL + MATERIAL_RECORDS * number;
    vec4 record = scene(at);
    Material m;
    m.reflectance = vec3(record);
    m.kind = uint(record.w);
    vec4 more = scene(at + 1u);
    m.index_of_refraction = more.x;
    m.alpha = more.z;
    m.rebounds = m.kind == COATED_SURFACE ? 0u : uint(more.w);
    return m;
}

bool is_thin(Material m)
{
    return m.kind == THIN_SURFACE;
}

// Whether light leaves on both sides of the surface.
bool is_glass(Material m)
{
    return m.kind == GLASS_SURFACE || is_thin(m);
}

bool stores_photons(Material m)
{
    return m.kind == LAMBERTIAN_SURFACE || m.kind == COATED_SURFACE;
}
