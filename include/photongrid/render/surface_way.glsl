// Ways along the surface at a point, for short rays. Included by kernels after core/random.glsl and
// trace/scene_layout.glsl, and after their INPUTs scene, points and normals.
const float HEIGHT = 0.02f; // of rays along the surface, in radii, at least

// The height of rays along the surface at p.
float height_at(vec3 p, float radius)
{
    return max(HEIGHT * radius, 2.0f * ray_offset(p, scene(SCENE_SIZES).x));
}

// Direction `number` of `count` even ones along the surface at point i, turned by a random angle.
vec3 way_along(uint i, float number, float count)
{
    vec4 p = points(i);
    vec4 r = random4(uvec4(floatBitsToUint(p.x), floatBitsToUint(p.y), floatBitsToUint(p.z), 7000u));
    precise float turn = (number + r.x) / count;
    vec2 circle = unit_circle(turn < 1.0f ? turn : 0.0f);
    return from_basis(vec3(circle.x, circle.y, 0.0f), vec3(normals(i)));
}

const float STEEP = 0.12f;      // height of a slanted ray's origin, in radii: what is lower there is unseen
const float BEYOND_RIM = 1.25f; // it goes on past the rim, for surfaces that bend away
const float AT_RIM = 0.9f;      // in radii: what it hits there is at the rim

// A ray from above the point down to the rim of its disc. If it hits the same surface there, it has passed no wall and
// no edge.
struct Slanted {
    vec3 from;
    vec3 d;
    float far;
};

// In direction `number` of `count`.
Slanted slanted_ray(uint i, float number, float count, float radius)
{
    vec3 p = vec3(points(i));
    vec3 n = vec3(normals(i));
    precise float steep = STEEP * radius;
    float height = max(steep, height_at(p, radius));
    precise vec3 down = way_along(i, number, count) * radius - n * height;
    precise float length = sqrt(dot3(down, down));
    precise vec3 d = down / length;
    precise float far = BEYOND_RIM * length;
    Slanted s;
    s.from = ray_at(p, n, height);
    s.d = d;
    s.far = far;
    return s;
}

// Whether a slanted ray's hit is at the rim.
bool is_at_rim(uint i, vec3 hit, float radius)
{
    precise vec3 way = hit - vec3(points(i));
    precise float rim = AT_RIM * radius;
    precise float rim2 = rim * rim;
    return dot3(way, way) >= rim2;
}
