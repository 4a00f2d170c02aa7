// Points of meshes that are lights. Included by kernels after trace/lights.glsl and after the INPUTs faces, planes and
// vertices (mesh_surface.glsl) and `shares`: of each triangle of a light the share of the light's area that is in it
// and in those of the light before it, times 2^32.
SWITCH(11, MESH_LIGHTS)

bool is_mesh_light(uint at)
{
    return MESH_LIGHTS && uint(scene(at).x) == MESH_LIGHT;
}

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
