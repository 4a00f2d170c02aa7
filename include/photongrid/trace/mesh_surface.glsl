// The surface at a ray's hit on a triangle, for kernels that follow paths (mesh_hit.glsl).
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/instance.glsl>
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/tree_node.glsl>

struct Params {
    uint count; // of instances
};
PARAMS(Params)
SWITCH(10, SMOOTH)
INPUT(0, vec4, scene)
INPUT(1, vec4, origins)    // of the rays
INPUT(2, vec4, directions)
INPUT(3, uvec4, hits)      // see ray_state.glsl
INPUT(4, uvec4, faces)     // of each triangle, xyz: its vertices; w: 2 x material + 1 if they have normals, or
                           // FACE_OF_LIGHT + number of the light
INPUT(5, vec4, planes)     // of each triangle, xyz: unit normal; w: offset
INPUT(6, vec4, vertices)   // xyz, m
INPUT(7, vec4, normals)    // of each vertex, xyz, of any length; only with SMOOTH
INPUT(8, uvec4, instances) // see instance.glsl; only with INSTANCES
OUTPUT(0, vec4, place)     // xyz: of the hit, m; w: its distance; -1: no hit
OUTPUT(1, vec4, normal)    // xyz: geometric normal, unit; w: material, or of a light its number, times -1, less 1
// xyz: interpolated normal, unit, on the side of the geometric one, or without normals that; w: what ray_offset adds
// for this hit, m
OUTPUT(2, vec4, shading)

#include <photongrid/trace/intersect/plane.glsl>
#include <photongrid/trace/placed_face.glsl>
#include <photongrid/trace/triangle_weights.glsl>

// A point of a triangle by the weights of its corners: their sum is not 1.
struct Weighted {
    vec3 weights;
    vec3 point;
    float round_share; // of the triangle, m: see ray_offset
};

// Moves a point of a triangle off its edges, by four offsets of rays or a quarter of the triangle's height. Where
// surfaces meet at an edge, rays that leave the point then start on its side of the other surface, and surely inside of
// the triangle (is_behind in trace/ray_tests.glsl).
//
// Far from edges a plane's rounding depends on the point's coordinates alone. Within 2^-10 of the longest edge of one,
// the offset is at least 32 units of 2^-24 of that length, because corners are rounded by their distance from a ray.
Weighted off_edges(vec3 p, PlacedFace f, vec3 n, float round_share)
{
    vec3 a = f.a;
    vec3 b = f.b;
    vec3 c = f.c;
    float offset = ray_offset(p, round_share);
    Weighted at;
    at.weights = triangle_weights(p, a, b, c, n);
    at.point = p;
    at.round_share = 0.0f;
    precise vec3 opposite_a = c - b;
    precise vec3 opposite_b = a - c;
    precise vec3 opposite_c = b - a;
    precise vec3 lengths = vec3(sqrt(dot3(opposite_a, opposite_a)), sqrt(dot3(opposite_b, opposite_b)),
        sqrt(dot3(opposite_c, opposite_c)));
    float longest = largest3(lengths);
    precise float more = longest * 1.9073486e-6f - offset; // 2^-19
    precise vec3 close = lengths * (longest * 9.765625e-4f); // 2^-10
    if (more > 0.0f && (at.weights.x < close.x || at.weights.y < close.y || at.weights.z < close.z))
        at.round_share = more;
    precise float off = offset + at.round_share;
    precise vec3 least = lengths * (4.0f * off);
    precise float quarter = 0.25f * dot3(cross3(opposite_c, -opposite_b), n);
    least = vec3(min(least.x, quarter), min(least.y, quarter), min(least.z, quarter));
    if (!(quarter > 0.0f)) {
        at.weights = vec3(1.0f, 1.0f, 1.0f); // a line or a point
        return at;
    }
    if (!(at.weights.x < least.x || at.weights.y < least.y || at.weights.z < least.z))
        return at;
    vec3 w = vec3(max(at.weights.x, least.x), max(at.weights.y, least.y), max(at.weights.z, least.z));
    precise vec3 moved = (a * w.x + b * w.y + c * w.z) / (w.x + w.y + w.z);
    at.weights = w;
    at.point = moved;
    return at;
}

// The normals of a triangle's vertices, weighted; the geometric normal where they cancel out.
vec3 shading_normal(PlacedFace f, vec3 weights, vec3 geometric)
{
    precise vec3 sum = normal_in_scene(f, vec3(normals(f.face.x))) * weights.x
        + normal_in_scene(f, vec3(normals(f.face.y))) * weights.y
        + normal_in_scene(f, vec3(normals(f.face.z))) * weights.z;
    precise vec3 scaled = sum / largest3(vec3(abs(sum.x), abs(sum.y), abs(sum.z)));
    vec3 n = normalized3(scaled);
    if (!is_finite3(n))
        return geometric;
    return dot3(n, geometric) < 0.0f ? -n : n;
}

void kernel(uint i)
{
    uvec4 found = hits(i);
    uint triangle = triangle_of(found);
    place = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    normal = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    shading = normal;
    if (triangle == NO_TRIANGLE)
        return;
    PlacedFace f = placed_face(triangle);
    vec4 plane = planes(f.number);
    if (INSTANCES && f.instance != NO_INSTANCE) {
        vec3 n = normal_in_scene(f, vec3(plane));
        plane = vec4(n.x, n.y, n.z, dot3(n, f.a));
    }
    float t = distance_of_hit(found);
    float of_placing = 0.0f;
    if (INSTANCES && f.instance != NO_INSTANCE)
        of_placing = uintBitsToFloat(instances(INSTANCE_RECORDS * f.instance + 7u).w);
    precise float round_share = scene(SCENE_SIZES).x + of_placing;
    Weighted at = off_edges(ray_at(vec3(origins(i)), vec3(directions(i)), t), f, vec3(plane), round_share);
    precise float more = of_placing + at.round_share;
    vec3 p = onto_plane(plane, at.point);
    place = vec4(p.x, p.y, p.z, t);
    bool of_light = f.face.w >= FACE_OF_LIGHT;
    float code = of_light ? -1.0f - float(f.face.w - FACE_OF_LIGHT) : float(f.face.w >> 1u);
    normal = vec4(plane.x, plane.y, plane.z, code);
    shading = vec4(plane.x, plane.y, plane.z, more);
    if (SMOOTH && !of_light && (f.face.w & 1u) != 0u) {
        vec3 n = shading_normal(f, at.weights, vec3(plane));
        shading = vec4(n.x, n.y, n.z, more);
    }
}
