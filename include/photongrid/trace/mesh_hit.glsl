// Hits of rays on the triangles of meshes, which a search has found before the pass (trace/mesh_search.hpp). Included
// by kernels after trace/intersect.glsl and after the INPUTs
//     mesh_hits: of each ray, see ray_state.glsl
//     faces:     of each triangle, xyz: its vertices; w: material
//     planes:    of each triangle, xyz: unit normal; w: offset
//     vertices:  xyz, m
SWITCH(9, MESHES)

// Twice the area of the triangle of p and an edge, negative where p is on the edge's other side.
float area_at_edge(vec3 p, vec3 from, vec3 to, vec3 normal)
{
    precise vec3 edge = to - from;
    precise vec3 way = p - from;
    return dot3(cross3(edge, way), normal);
}

// Moves a point of a triangle off its edges, by the offset of rays or a quarter of the triangle's height. Where
// surfaces meet at an edge, rays that leave the point then start on its side of the other surface.
vec3 off_edges(vec3 p, uvec4 face, vec3 normal)
{
    vec3 a = vec3(vertices(face.x));
    vec3 b = vec3(vertices(face.y));
    vec3 c = vec3(vertices(face.z));
    float off = ray_offset(p, scene(SCENE_SIZES).x);
    vec3 areas = vec3(area_at_edge(p, b, c, normal), area_at_edge(p, c, a, normal), area_at_edge(p, a, b, normal));
    precise vec3 opposite_a = c - b;
    precise vec3 opposite_b = a - c;
    precise vec3 opposite_c = b - a;
    precise vec3 least = vec3(sqrt(dot3(opposite_a, opposite_a)), sqrt(dot3(opposite_b, opposite_b)),
                             sqrt(dot3(opposite_c, opposite_c)))
        * off;
    precise float quarter = 0.25f * dot3(cross3(opposite_c, -opposite_b), normal);
    least = vec3(min(least.x, quarter), min(least.y, quarter), min(least.z, quarter));
    if (!(areas.x < least.x || areas.y < least.y || areas.z < least.z) || !(quarter > 0.0f))
        return p;
    areas = vec3(max(areas.x, least.x), max(areas.y, least.y), max(areas.z, least.z));
    precise vec3 moved = (a * areas.x + b * areas.y + c * areas.z) / (areas.x + areas.y + areas.z);
    return moved;
}

// The closer one of a ray's hits: `hit` among the shapes, and the hit that a search found for ray `number`.
Hit closer_hit(Hit hit, uint number, vec3 o, vec3 d)
{
    uvec4 found = mesh_hits(number);
    uint triangle = triangle_of(found);
    float t = distance_of_hit(found);
    if (triangle == NO_TRIANGLE || (hit.t >= 0.0f && hit.t <= t))
        return hit;
    uvec4 face = faces(triangle);
    vec4 plane = planes(triangle);
    hit.t = t;
    hit.material = face.w;
    hit.light = 0u;
    hit.position = onto_plane(plane, off_edges(ray_at(o, d, t), face, vec3(plane)));
    hit.normal = vec3(plane);
    return hit;
}
