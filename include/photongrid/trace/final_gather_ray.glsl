// Starts rays of a final gather (Reichert 1992; Jensen 1996): from the points on diffuse surfaces where eye rays ended,
// in directions distributed as the cosine with the normal, so that pi times the mean of their radiance is the
// irradiance. They go on as eye rays do (eye_bounce.glsl).
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uvec2 strata;     // of the directions of a point's rays: columns and rows, one ray in each
    uint number;      // of this ray among those of its point
    uint first;       // eye ray of element 0
    uint first_pixel; // pixel of eye ray 0
    uint nth;         // of the eye rays of a pixel, in all passes
    uint seed;
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, vec4, ends)       // xyz, m; w > 0: on a diffuse surface, see point_code() of trace/inside_code.glsl
INPUT(2, vec4, surfaces)   // xyz: normal; w: material
// As eye_ray.glsl starts eye rays.
OUTPUT(0, vec4, point)
OUTPUT(1, vec4, direction)
OUTPUT(2, vec4, throughput) // rgb: below a coat, the share of the light that passes it
OUTPUT(3, vec4, surface)
OUTPUT(4, vec4, emitted)
OUTPUT(5, uint, branches)

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/coat.glsl>
#include <photongrid/trace/inside_code.glsl>

void kernel(uint i)
{
    vec4 end = ends(args.first + i);
    vec4 lit = surfaces(args.first + i);
    point = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    throughput = vec4(1.0f, 1.0f, 1.0f, 0.0f);
    surface = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    emitted = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    branches = 1u;
    if (!(end.w > 0.0f))
        return;
    vec3 normal = vec3(lit);
    vec2 r = sequence2(args.nth,
        uvec4(args.first + i + args.first_pixel, args.number, 5000u, args.seed));
    uint row = args.number / args.strata.x;
    uint column = args.number - row * args.strata.x;
    precise float u = (float(column) + r.x) / float(args.strata.x);
    precise float v = (float(row) + r.y) / float(args.strata.y);
    vec3 d = cosine_direction(normal, u, v);
    vec3 start = ray_at(vec3(end), normal, ray_offset(vec3(end), scene(SCENE_SIZES).x));
    point = vec4(start.x, start.y, start.z, 0.0f);
    surface = vec4(0.0f, 0.0f, 1.0f, float(inside_of_point(end.w)));
    direction = vec4(d.x, d.y, d.z, 0.0f);
    if (COATS && lit.w >= 0.0f && material_of(uint(lit.w)).kind == COATED_SURFACE) {
        float passed = passes_coat(coat_of(uint(lit.w)), dot3(d, normal));
        throughput = vec4(passed, passed, passed, 0.0f);
    }
}
