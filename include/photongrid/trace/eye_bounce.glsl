// Traces an eye ray to the next surface (2.4), through mirrors and glass until it ends on a diffuse surface, on a
// light, or in the environment. The first `splits` times a ray splits: at glass into its two Fresnel branches; at a
// coat into one that it reflects and one that ends on the diffuse surface below; at a rough surface into one that ends
// there, for samples of lights, and one that goes on; at a mixture into its parts; and where a surface is clear in part
// into one that meets it and one that passes. The bits of `branch` select the one that this pass follows at
// each. Later a random number selects it, stratified over the eye rays of a pixel.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint branch;     // bit n, at the n-th split; at glass: 1 reflected, 0 refracted; at a coat: 1 reflected, 0 base;
                     // at a rough surface: 1 ends, 0 goes on; of a mixture: 1 the second part, 0 the first; where a
                     // surface is clear in part: 1 meets it, 0 passes
    uint splits;     // how often a ray splits at most
    uint depth;      // surfaces a ray passes at most
    float light_samples; // of each light with a size at rough surfaces; 0: such lights are left to rays
    uint nth;        // of the eye rays of a pixel, in all passes
    uint seed;
    uint first_pixel; // pixel of element 0
    uint first;       // the eye ray of mesh hit 0
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
SWITCH(15, ENVIRONMENT_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(2, vec4, mesh_normals)
INPUT(3, vec4, mesh_shadings)
INPUT(4, vec4, environment) // see environment.glsl
INPUT(5, vec4, mesh_colors) // see mesh_color.glsl
// xyz: origin, at the end the point hit, m; w: 0 in flight, a point_code() on a diffuse surface, -2 - alpha on a rough
// one (rough_points.glsl), else -1
STATE(0, vec4, point)
// xyz: unit vector; at the end on a diffuse surface its geometric normal towards the eye; w: surfaces hit
STATE(1, vec4, direction)
// rgb: factor between radiance here and at the eye; at the end on a diffuse surface between pi times its irradiance, or
// below a coat the part of that which passed, and radiance at the eye. w: splits so far
STATE(2, vec4, throughput)
// xyz: normal towards the eye; w: material. In flight, x: the density of the direction in which the ray left a rough
// surface, the last one that it met, sr^-1, else 0; y: how far it has come from there through clear ones, m; w: the
// media that it is in (media.glsl)
STATE(3, vec4, surface)
STATE(4, vec4, emitted)    // rgb: radiance of the light that the ray ended on, times throughput
STATE(5, uint, branches)   // bit b: branch b must be traced for this pixel; branch 0 sets the other bits

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/light_record.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/met_surface.glsl>
#include <photongrid/trace/media.glsl>
#include <photongrid/trace/end_code.glsl>

bool done()
{
    return point.w != 0.0f;
}

// The weight of a light that the ray hits. If it comes from a rough surface, samples of lights may find this one there,
// too (balance heuristic); `density`: that of such a sample's direction, sr^-1.
float weight_of_hit(float density)
{
    if (!ROUGH || !(surface.x > 0.0f) || args.light_samples == 0.0f)
        return 1.0f;
    precise float weight = surface.x / (surface.x + args.light_samples * density);
    return weight;
}

// The density of the samples of this light, which the ray hits on its front.
float sampled_density(uint light, Hit hit, vec3 d)
{
    vec3 from = vec3(point);
    float far = hit.t;
    if (CLEAR) { // as seen from the rough surface
        precise vec3 start = from - d * surface.y;
        from = start;
        precise float whole = far + surface.y;
        far = whole;
    }
    return light_density(light, from, far, d, hit.normal);
}

// The ray ends on the front of this light.
void see_light(Hit hit, vec3 d)
{
    uint light = light_at(hit.light);
    vec3 power = light_power(light);
    float scale = radiance_per_power(light);
    if (ROUGH) {
        precise float weighted = scale * weight_of_hit(sampled_density(light, hit, d));
        scale = weighted;
    }
    emitted = vec4(throughput.x * power.x * scale, throughput.y * power.y * scale,
        throughput.z * power.z * scale, 0.0f);
}

// The ray sees the environment.
void see_environment(vec3 d)
{
    EnvironmentSeen e = environment_seen(environment_light(), d);
    vec3 seen = e.radiance;
    if (ROUGH) {
        precise vec3 weighted = seen * weight_of_hit(e.density);
        seen = weighted;
    }
    emitted = vec4(throughput.x * seen.x, throughput.y * seen.y, throughput.z * seen.z, 0.0f);
}

// A random number that is stratified over the eye rays of a pixel.
float stratified_number(uint i, uint what)
{
    return sequence2(args.nth, uvec4(i + args.first_pixel, args.branch, what, args.seed)).x;
}

// The branch that a ray takes where it may be one of two, and the factor on its throughput. At glass and coats the
// first one is what they reflect; of a mixture the second part; of what is clear in part, what meets it.
struct Branch {
    bool first;
    float share;
};

// A ray that has split fewer than args.splits times is the same in several passes. It counts in one of them, the one
// whose unused branch bits are 0.
bool is_counted()
{
    return args.branch >> min(uint(throughput.w), 31u) == 0u; // a device that computes garbage may shift by anything
}

bool may_split()
{
    return uint(throughput.w) < args.splits;
}

// At a split, where other passes follow the other branch: the one that this pass follows. `share`: of the first branch.
Branch split_branch(float share)
{
    uint splits = uint(throughput.w);
    if (is_counted())
        branches = branches | 1u << min(args.branch | 1u << splits, 31u);
    throughput.w = float(splits + 1u);
    Branch b;
    b.first = ((args.branch >> splits) & 1u) != 0u;
    b.share = b.first ? share : 1.0f - share;
    return b;
}

// The largest factor between light that the surface sends here and that at the eye. Within glass radiance is larger by
// the square of its index, and the throughput smaller, though no light is lost.
float brightness_at(Surface s)
{
    float brightness = largest3(vec3(throughput));
    if (GLASS && s.material.kind == GLASS_SURFACE && !s.outside) {
        precise float outside = brightness * s.material.index_of_refraction * s.material.index_of_refraction;
        brightness = outside;
    }
    return brightness;
}

// Sampled with its probability, a 4 % reflection that reaches a lamp is a firefly. Sample the rarer branch more often
// as `brightness` falls, up to 1/4, and weight it accordingly. `what`: of the random number.
Branch sampled_branch(uint i, uint what, float share, float brightness)
{
    Branch b;
    b.first = true; // no other branch
    b.share = 1.0f;
    if (!(share >= 1.0f)) {
        precise float least = 0.25f - 0.25f * min(brightness, 1.0f);
        float probability = min(max(share, least), 1.0f - least);
        b.first = stratified_number(i, what) < probability;
        precise float corrected = b.first ? share / probability : (1.0f - share) / (1.0f - probability);
        b.share = corrected;
    }
    return b;
}

// The branch that this pass follows, at a split or beyond the last one.
Branch branch_of(uint i, uint what, float share, float brightness)
{
    if (may_split())
        return split_branch(share);
    return sampled_branch(i, what, share, brightness);
}

// The same where a share of 0 or 1 leaves no choice.
Branch branch_if_any(uint i, uint what, float share)
{
    Branch b;
    b.first = share > 0.0f;
    b.share = 1.0f;
    if (share > 0.0f && share < 1.0f)
        b = branch_of(i, what, share, largest3(vec3(throughput)));
    return b;
}

// What random numbers are for; the number of surfaces hit is added.
const uint REFLECTS = 2000u;
const uint ENDS = 2500u;
const uint FACET = 4000u; // stratified too, and the same in all branches
const uint REBOUND = 5000u;
const uint PASSES = 10000u;
const uint PART = 20000u;
const uint FAINT = 15000u;

const uint SURELY_FOLLOWED = 8u; // surfaces

// Russian roulette (Arvo and Kirk, Particle Transport and Image Synthesis, 1990): past some surfaces faint rays end by
// chance, and those that go on stand for them.
bool ends_by_chance(uint i, uint hits, float brightness)
{
    if (hits <= SURELY_FOLLOWED || !(brightness < 1.0f))
        return false;
    if (!(stratified_number(i, FAINT + hits) < brightness))
        return true;
    precise vec3 for_all = vec3(throughput) / brightness;
    throughput = vec4(for_all.x, for_all.y, for_all.z, throughput.w);
    return false;
}

// The ray passes a surface that is clear in part, or a pane.
void pass_clear(Hit hit, vec3 d, vec3 share)
{
    uint hits = uint(direction.w) + 1u;
    if (hits > args.depth) {
        point.w = -1.0f;
        return;
    }
    vec3 beyond = ray_start(hit, d);
    point = vec4(beyond.x, beyond.y, beyond.z, 0.0f);
    direction.w = float(hits);
    precise vec3 passed = vec3(throughput) * share;
    throughput = vec4(passed.x, passed.y, passed.z, throughput.w);
    if (ROUGH) {
        precise float come = surface.y + hit.t;
        surface.y = come;
    }
}

// The coat of a surface reflects the ray (the first branch) or passes it to the base. The share leaves out the facet's
// reflectance, which scatter() multiplies by.
Branch coat_branch(uint i, uint hits, Surface s)
{
    Coat coat = coat_of(s.number);
    precise float passed = passes_coat(coat, -dot3(s.shading, s.d));
    precise float reflected = 1.0f - passed;
    Branch b = branch_of(i, REFLECTS + hits, reflected, brightness_at(s));
    precise float weight = b.first ? (reflected > 0.0f ? b.share / reflected : 0.0f) : b.share / coat.mean_passed;
    b.share = weight;
    return b;
}

// The ray ends on a matte surface, bare or below a coat.
void end_on_base(Hit hit, Surface s, vec3 reflected)
{
    vec3 p = hit.position;
    precise float more = hit.round_share - scene(SCENE_SIZES).x;
    if (SMOOTH) // shadow rays start off the surface about its shading normal
        p = ray_start(hit, s.geometric);
    else if (more > 0.0f) // than the offset of shadow rays at any surface
        p = ray_at(p, s.geometric, more);
    point = vec4(p.x, p.y, p.z, is_counted() ? point_code(uint(surface.w)) : -1.0f);
    throughput = vec4(reflected.x, reflected.y, reflected.z, throughput.w);
    direction = vec4(s.geometric.x, s.geometric.y, s.geometric.z, direction.w);
    surface = vec4(s.shading.x, s.shading.y, s.shading.z, float(s.number));
}

// The ray ends on a rough surface, for samples of lights (rough_points.glsl). w of direction, throughput and emitted:
// the geometric normal.
void end_on_rough(Hit hit, Surface s, vec3 reflected)
{
    precise float code = -2.0f - s.material.alpha;
    point = vec4(hit.position.x, hit.position.y, hit.position.z, is_counted() ? code : -1.0f);
    direction.w = hit.normal.x;
    throughput = vec4(reflected.x, reflected.y, reflected.z, hit.normal.y);
    emitted.w = end_code(hit.normal.z, s.material.reflectance, uint(surface.w));
    surface = vec4(s.shading.x, s.shading.y, s.shading.z, float(s.number));
}

// Some rays end on a rough surface for samples of lights: in a pass of their own, or every other one; where no facet
// loses light, rays in glass meet many surfaces, so that of later ones fewer end, and the factors of those that go on
// make up no power of 2, but their number. In the first branch the ray ends here.
Branch rough_branch(uint i, uint hits, bool rebounds)
{
    Branch b;
    b.share = 1.0f;
    if (may_split()) {
        b.first = split_branch(1.0f).first;
    } else {
        precise float ending = rebounds && hits > 2u ? 1.0f / float(hits) : 0.5f;
        b.first = stratified_number(i, ENDS + hits) < ending;
        precise float share = 1.0f / (b.first ? ending : 1.0f - ending);
        b.share = share;
    }
    return b;
}

// The ray meets a surface, and ends on it or leaves it. `met`: the factor on throughput for what it meets of the hit;
// `behind`: the media on the other side.
void scatter(uint i, Hit hit, Surface s, float met, uint behind)
{
    uint hits = uint(direction.w);
    if (is_coated(s)) {
        Branch b = coat_branch(i, hits, s);
        s = leaving_by(s, way_of(s, b.first));
        precise float both = b.share * met;
        met = both;
    }
    precise vec3 reflected = vec3(throughput) * s.material.reflectance * met;
    if (s.way == BY_BASE) {
        end_on_base(hit, s, reflected);
        return;
    }
    if (hits + 1u > args.depth) {
        point.w = -1.0f;
        return;
    }
    float share = 1.0f;
    vec2 r = vec2(0.0f, 0.0f);
    if (has_facets(s)) {
        Branch b = rough_branch(i, hits, has_rebounds(s.material));
        share = b.share;
        if (b.first) {
            precise vec3 ending = reflected * share;
            end_on_rough(hit, s, ending);
            return;
        }
        r = sequence2(args.nth, uvec4(i + args.first_pixel, 0u, FACET + hits, args.seed));
    }
    Facet facet = facet_met(s, r.x, r.y);
    if (is_coated(s)) {
        precise float scaled = share * facet.f.reflected;
        share = scaled;
    }
    float branch_share = 1.0f;
    if (GLASS && is_glass(s.material)) {
        Branch b = branch_of(i, REFLECTS + hits, facet.f.reflected, brightness_at(s));
        s = leaving_by(s, way_of(s, b.first));
        branch_share = b.share;
        if (goes_straight_on(s)) {
            precise float passing = branch_share * met;
            pass_clear(hit, s.d, s.material.reflectance * passing);
            return;
        }
        if (CLEAR && is_thin(s.material)) {
            precise vec3 of_way = vec3(throughput) * s.material.reflectance * met;
            reflected = of_way;
        }
    }
    vec4 again = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (has_rebounds(s.material))
        again = sequence4(args.nth, uvec4(i + args.first_pixel, 0u, REBOUND + hits, args.seed));
    Scattered l = scatter_sample(s, facet, r.x, r.y, again, uvec4(0u, 0u, 0u, 0u));
    precise float leaving = share * (branch_share * l.radiance_scale) * l.unhidden;
    if (!(leaving > 0.0f)) {
        point.w = -1.0f;
        return;
    }
    if (ROUGH) {
        s.way = l.way;
        surface.x = scatter_pdf(s, l.direction);
        surface.y = 0.0f;
    }
    vec3 start = ray_start(hit, l.direction);
    point = vec4(start.x, start.y, start.z, 0.0f);
    direction = vec4(l.direction.x, l.direction.y, l.direction.z, float(hits + 1u));
    if (has_rebounds(s.material)) {
        precise vec3 tinted = reflected * l.tint;
        reflected = tinted;
    }
    throughput = vec4(reflected.x * leaving, reflected.y * leaving, reflected.z * leaving, throughput.w);
    if (MEDIA && l.way == BY_REFRACTION)
        surface.w = float(behind);
}

// What the medium on the way has left.
void attenuate(float t)
{
    precise vec3 left = vec3(throughput) * left_after(uint(surface.w), t);
    throughput = vec4(left.x, left.y, left.z, throughput.w);
}

void kernel(uint i)
{
    vec3 d = vec3(direction);
    Hit hit = intersect_closest(vec3(point), d);
    uint number = i - args.first; // of the hit on a mesh
    bool on_mesh = MESHES && mesh_is_closer(hit, number);
    if (on_mesh)
        hit = mesh_hit(number);
    uint hits = uint(direction.w);
    if (MEDIA)
        attenuate(hit.t < 0.0f ? 3.0e38f : hit.t);
    if (hit.t < 0.0f) {
        point.w = -1.0f;
        if (ENVIRONMENT_LIGHTS && is_counted())
            see_environment(d);
        return;
    }
    if (hit.material == NO_MATERIAL) {
        point.w = -1.0f;
        if (is_counted() && dot3(d, hit.normal) < 0.0f) // on the front only
            see_light(hit, d);
        return;
    }
    float met = 1.0f;
    if (CLEAR) {
        Branch b = branch_if_any(i, PASSES + hits, opacity_at(hit.material, on_mesh, number));
        if (!b.first) {
            pass_clear(hit, d, vec3(b.share, b.share, b.share));
            return;
        }
        met = b.share;
    }
    uint part = 0u;
    if (MIXTURES && is_mixture(hit.material)) {
        Parts parts = parts_of(hit.material);
        Branch b = branch_if_any(i, PART + hits, share_at(parts, on_mesh, number));
        part = b.first ? 1u : 0u;
        hit.material = b.first ? parts.second : parts.first;
        precise float both = met * b.share;
        met = both;
    }
    Surface s = surface_met(hit, d, material_at(hit.material, part, on_mesh, number));
    uint behind = 0u;
    if (MEDIA && s.material.kind == GLASS_SURFACE) {
        Crossing c = crossing(uint(surface.w), s.number, s.outside, s.material.index_of_refraction);
        surface.w = float(c.is_real ? c.in_front : c.behind);
        behind = c.behind;
        s.material = between_media(s.material, c);
        if (!c.is_real) {
            pass_clear(hit, d, vec3(met, met, met));
            return;
        }
    }
    if (ends_by_chance(i, hits, brightness_at(s))) {
        point.w = -1.0f;
        return;
    }
    scatter(i, hit, s, met, behind);
}
