// Hits of rays on meshes, which passes before this one have found (trace/mesh_search.hpp). Included by kernels after
// trace/intersect.glsl and after the INPUTs mesh_places, mesh_normals and mesh_shadings, the outputs of
// mesh_surface.glsl.
SWITCH(9, MESHES)

// The closer one of a ray's hits: `hit` among the shapes, and that of ray `number` on a mesh.
Hit closer_hit(Hit hit, uint number)
{
    vec4 place = mesh_places(number);
    if (place.w < 0.0f || (hit.t >= 0.0f && hit.t <= place.w))
        return hit;
    vec4 normal = mesh_normals(number);
    hit.t = place.w;
    hit.material = NO_MATERIAL;
    hit.light = 0u;
    if (normal.w < 0.0f)
        hit.light = uint(-normal.w) - 1u;
    else
        hit.material = uint(normal.w);
    hit.position = vec3(place);
    hit.normal = vec3(normal);
    hit.shading = vec3(mesh_shadings(number));
    return hit;
}
