// Meshes that are lights (scene/lights.hpp). Included by kernels after the INPUTs faces, planes and vertices
// (mesh_surface.glsl) and `shares`: of each triangle of a light the share of the light's area that is in it and in the
// light's earlier triangles, times 2^32. Records: at + 1: middle of a ball that holds it; at + 2: its first triangle;
// at + 3: how many it has; at + 4: the ball's radius.
SWITCH(11, MESH_LIGHTS)
const uint MESH_LIGHT = 11u;

// Single precision cannot hold the number of each triangle, so records have it in two parts.
uint from_halves(vec4 record)
{
    return uint(record.x) * 65536u + uint(record.y);
}

struct EmittingPoint {
    vec3 position;
    vec3 normal;  // unit; light leaves on this side
    float offset; // of rays, m
};

// A point that is even over the area for u, v and w from 0 to 1. `at`: the light's record.
EmittingPoint emitting_point(uint at, float u, float v, float w)
{
    uint goal = uint(u * 16777216.0f) * 256u;
    uint low = from_halves(scene(at + 2u));
    uint high = low + from_halves(scene(at + 3u)) - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (shares(middle) > goal)
            high = middle;
        else
            low = middle + 1u;
    }
    uvec4 face = faces(low);
    vec4 plane = planes(low);
    vec3 a = vec3(vertices(face.x));
    vec3 b = vec3(vertices(face.y));
    vec3 c = vec3(vertices(face.z));
    precise float root = sqrt(v);
    precise float of_b = root * (1.0f - w);
    precise float of_c = root * w;
    precise vec3 p = a + (b - a) * of_b + (c - a) * of_c;
    EmittingPoint e;
    e.normal = vec3(plane);
    precise float above = dot3(e.normal, p) - plane.w;
    e.position = ray_at(p, e.normal, -above);
    e.offset = ray_offset(abs(a) + abs(b) + abs(c), scene(SCENE_SIZES).x);
    return e;
}

Emitted mesh_emit(uint at, Emitted e, vec4 r, vec4 s)
{
    EmittingPoint p = emitting_point(at, s.y, r.z, r.w);
    e.direction = cosine_direction(p.normal, r.x, r.y);
    e.origin = ray_at(p.position, p.normal, p.offset);
    return e;
}

// A random point of the sample's own part of the area.
ArrivingLight mesh_sample(uint at, ArrivingLight a, SampleNumbers n, LitPoint lit)
{
    a.radiance_per_power = radiance_per_power(at);
    EmittingPoint e = emitting_point(at, n.along, n.r.z, n.r.w);
    LightWay way = way_to(e.position, lit);
    float leaving = -dot3(way.direction, e.normal);
    if (!(way.distance2 > 0.0f) || !(way.cosine > 0.0f) || !(leaving > 0.0f))
        return a;
    // Radiance times area is power / pi.
    precise float per_power = way.cosine * leaving / way.distance2 * 3.18309886e-1f * n.share;
    a.found = lit_from(ray_at(e.position, e.normal, e.offset), per_power, lit);
    return a;
}

float mesh_importance(uint at, float watts, LitPoint lit)
{
    return ball_importance(vec3(scene(at + 1u)), scene(at + 4u).x, watts, lit);
}
