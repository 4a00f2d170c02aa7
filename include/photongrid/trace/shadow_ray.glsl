// The shadow rays of one sample of a light, at the ends of eye rays, for a search among meshes: rays that no shape
// blocks. It knows all kinds of lights; direct_light.glsl, which is like it otherwise, knows points and rectangles.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uvec2 strata;     // strata along the two edges of an area light; their product is the number of samples
    uint light;       // number of the light
    uint sample_id;   // number of its sample
    uint first;       // the eye ray of element 0
    uint branch;      // Fresnel branch of the eye rays (eye_bounce.glsl)
    uint nth;         // of the eye rays of a pixel, in all passes
    uint seed;
    uint first_pixel; // pixel of eye ray 0
    uint choice;      // with `choices` the number of a sample, whose light is chosen (chosen_light.glsl)
    uint choices;     // 0: none is chosen
    uint whole;       // 1: parts of a rectangle that are close are taken whole, by their form factor
    uint sky;         // 0: the environment is sampled by its light; 1: by sky_guide; 2 and more: look sky - 2 at it
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)     // w > 0: compute direct light; see point_code() of trace/inside_code.glsl
INPUT(2, vec4, surfaces)   // xyz: normal; w: material, or -1
INPUT(3, uvec4, faces)     // these four: see lights/mesh_light.glsl
INPUT(4, vec4, planes)
INPUT(5, vec4, vertices)
INPUT(6, uint, shares)
INPUT(7, vec4, environment)        // see environment.glsl ...
INPUT(8, uint, environment_shares) // ... and lights/environment_light.glsl
INPUT(9, vec4, sky_guide)          // see sky_guide.glsl
OUTPUT(0, vec4, origin)    // xyz, m; w: length, m; 0 where nothing need be searched
OUTPUT(1, vec4, direction) // xyz: unit vector
// rgb: irradiance if no mesh blocks the ray, below a coat if there is one, W/m^2; w: density of the direction among all
// samples of the light, sr^-1; 0 of lights without size
OUTPUT(2, vec4, arriving)

#include <photongrid/trace/lights.glsl>
#include <photongrid/trace/sky_bins.glsl>
#include <photongrid/trace/sky_guide.glsl>
#include <photongrid/trace/light_sample.glsl>
#include <photongrid/trace/chosen_light.glsl>
#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/coat.glsl>
#include <photongrid/trace/media.glsl>

// The random numbers of this sample.
SampleNumbers sample_numbers(uint i)
{
    SampleNumbers n;
    n.r = sequence4(args.nth,
        uvec4(i + args.first_pixel, args.branch, 3000u + args.light, args.seed ^ (args.sample_id * 0x9E3779B1u)));
    precise float share = 1.0f / float(args.strata.x * args.strata.y);
    n.share = share;
    precise float along = (float(args.sample_id) + n.r.x) * share;
    n.along = min(along, 0.99999994f);
    uint row = args.sample_id / args.strata.x;
    uint column = args.sample_id - row * args.strata.x;
    precise vec2 place
        = vec2((float(column) + n.r.x) / float(args.strata.x), (float(row) + n.r.y) / float(args.strata.y));
    n.place = vec2(min(place.x, 0.99999994f), min(place.y, 0.99999994f));
    return n;
}

// The sample of light `number`, for eye ray i. `whole`: see Params.
ArrivingLight light_sampled(uint number, uint i, bool whole, LitPoint lit)
{
    uint at = light_at(number);
    uint kind = kind_of_light(at);
    ArrivingLight a;
    if ((POINT_LIGHTS && kind == POINT_LIGHT) || (AREA_LIGHTS && kind == RECTANGLE_LIGHT)) {
        SeenLight seen = seen_light(at, lit);
        seen.some_close = seen.some_close && whole;
        a.found = light_sample(seen, number, args.sample_id, i, lit);
        a.power = seen.light.power;
        a.radiance_per_power = seen.area ? seen.radiance_per_power : 0.0f;
        a.is_rectangle = seen.area;
        return a;
    }
    if (ENVIRONMENT_LIGHTS && kind == ENVIRONMENT_LIGHT && args.sky == 1u)
        return guided_sky(at, sample_numbers(i), lit);
    if (ENVIRONMENT_LIGHTS && kind == ENVIRONMENT_LIGHT && args.sky > 1u)
        return sky_in_bin(at, sky_bin_of_look(args.sky - 2u, i), sample_numbers(i), lit);
    return arriving_light(at, sample_numbers(i), lit);
}

void kernel(uint i)
{
    origin = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    arriving = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    vec4 point = points(args.first + i);
    if (!(point.w > 0.0f))
        return;
    vec4 surface = surfaces(args.first + i);
    LitPoint lit = lit_point(vec3(point), vec3(surface));
    bool coated = COATS && surface.w >= 0.0f && material_of(uint(surface.w)).kind == COATED_SURFACE;
    uint number = args.light;
    float scale = 1.0f;
    if (args.choices > 0u) {
        vec2 r = sequence2(args.nth, uvec4(args.first + i + args.first_pixel, args.branch, 2999u, args.seed));
        precise float u = (float(args.choice) + r.x) / float(args.choices);
        ChosenLight c = chosen_light(lit, u);
        if (!(c.probability > 0.0f))
            return;
        number = c.number;
        precise float weight = 1.0f / (c.probability * float(args.choices));
        scale = weight;
    }
    ArrivingLight light = light_sampled(number, args.first + i, args.whole != 0u && !coated, lit);
    LightSample found = light.found;
    if (!(found.per_power > 0.0f)
        || (found.has_ray
            && occluded(lit.origin, found.direction, found.far,
                light.is_rectangle ? all_before_rectangles() : everything())))
        return;
    origin = vec4(lit.origin.x, lit.origin.y, lit.origin.z, found.has_ray ? found.far : 0.0f);
    direction = vec4(found.direction.x, found.direction.y, found.direction.z, 0.0f);
    if (coated) {
        precise float passed = scale * passes_coat(coat_of(uint(surface.w)), dot3(found.direction, lit.normal));
        scale = passed;
    }
    precise float received = found.per_power * scale;
    precise float density = light.radiance_per_power * dot3(found.direction, lit.normal) / found.per_power;
    arriving = vec4(light.power.x * received, light.power.y * received, light.power.z * received, density);
    if (MEDIA && found.has_ray) { // glass stops the ray, so that it is in one medium all the way
        precise vec3 left = vec3(arriving) * left_after(inside_of_point(point.w), found.far);
        arriving = vec4(left.x, left.y, left.z, density);
    }
}
