// Hits of rays on meshes, which passes before this one have found (trace/mesh_search.hpp). Included by kernels after
// trace/intersect.glsl and after the INPUTs mesh_places, mesh_normals and mesh_shadings, the outputs of
// mesh_surface.glsl, and mesh_colors, that of mesh_color.glsl.
SWITCH(9, MESHES)
SWITCH(16, TEXTURES)

// Whether the hit of ray `number` on a mesh is closer than `hit` among the shapes.
bool mesh_is_closer(Hit hit, uint number)
{
    float t = mesh_places(number).w;
    return !(t < 0.0f) && !(hit.t >= 0.0f && hit.t <= t);
}

// The hit of ray `number` on a mesh.
Hit mesh_hit(uint number)
{
    vec4 place = mesh_places(number);
    vec4 normal = mesh_normals(number);
    Hit hit;
    hit.t = place.w;
    hit.material = NO_MATERIAL;
    hit.light = 0u;
    if (normal.w < 0.0f)
        hit.light = uint(-normal.w) - 1u;
    else
        hit.material = uint(normal.w);
    hit.position = vec3(place);
    hit.normal = vec3(normal);
    vec4 shading = mesh_shadings(number);
    hit.shading = vec3(shading);
    precise float round_share = scene(SCENE_SIZES).x + shading.w;
    hit.round_share = round_share;
    return hit;
}
