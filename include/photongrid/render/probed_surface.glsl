// Whether what a short ray hits belongs to the surface of an estimate's disc. Included by kernels after
// trace/mesh_hit.glsl and trace/materials.glsl, after their INPUTs points and normals. Their Params have min_cosine.
#include <photongrid/estimate/off_surface.glsl>

// Whether a ray of direction d hits the surface of point i, with photons that would count.
bool holds_photons(uint i, Hit hit, vec3 d)
{
    if (hit.material == NO_MATERIAL)
        return false;
    Material there = material_of(hit.material);
    if (there.kind == MIRROR_SURFACE || is_glass(there))
        return false;
    vec4 p = points(i);
    vec4 n = normals(i);
    vec3 m = dot3(hit.normal, d) < 0.0f ? hit.normal : -hit.normal;
    precise vec3 way = hit.position - vec3(p);
    float cosine = dot3(m, vec3(n));
    return cosine >= args.min_cosine
        && !is_off_surface(way.x, way.y, way.z, dot3(way, way), vec4(m.x, m.y, m.z, 0.0f), n, cosine, p);
}
