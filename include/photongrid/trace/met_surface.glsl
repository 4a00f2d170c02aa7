// The material that a ray meets at a hit, with its textures. Included by kernels after trace/mesh_hit.glsl,
// trace/materials.glsl, trace/mixture.glsl and the SWITCH ROUGH.

// The opacity of hit `number`.
float opacity_at(uint material, bool on_mesh, uint number)
{
    float opacity = parts_of(material).opacity;
    if (TEXTURES && on_mesh) {
        precise float scaled = opacity * mesh_colors(colors_per_hit() * number + 2u).x;
        opacity = scaled;
    }
    return opacity;
}

// The share of the second part of a mixture at hit `number`.
float share_at(Parts parts, bool on_mesh, uint number)
{
    float share = parts.share;
    if (TEXTURES && on_mesh) {
        precise float scaled = share * mesh_colors(colors_per_hit() * number + 2u).y;
        share = scaled;
    }
    return share;
}

// A material at hit `number`; `part`: which one it is of a mixture, else 0.
Material material_at(uint material, uint part, bool on_mesh, uint number)
{
    Material m = material_of(material);
    if (TEXTURES && on_mesh) {
        vec4 factors = mesh_colors(colors_per_hit() * number + part);
        precise vec3 colored = m.reflectance * vec3(factors);
        m.reflectance = colored;
        if (ROUGH) {
            precise float alpha = m.alpha * (factors.w * factors.w);
            m.alpha = alpha;
        }
    }
    return m;
}
