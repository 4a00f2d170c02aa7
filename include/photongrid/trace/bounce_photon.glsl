// One bounce of all photons (2.1): computes frame f of the photon texture from frame f - 1. It records the photon that
// hits a surface. Russian roulette by reflectance decides whether the path continues, so that photons change in colour
// only.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint paths;      // elements of a frame
    uint first_path; // id of the path of a frame's element 0
    uint last_frame; // the last bounce allowed
    uint seed;
    uint to_diffuse; // 1: paths end at the first diffuse surface, as those of a map of caustic photons
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, positions)
INPUT(2, vec4, powers)
INPUT(3, vec4, directions)
INPUT(4, vec4, next_origins)
INPUT(5, vec4, next_directions)
INPUT(6, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(7, vec4, mesh_normals)
INPUT(8, vec4, mesh_shadings)
INPUT(9, vec4, mesh_colors) // see mesh_color.glsl
OUTPUT(0, vec4, position)       // xyz, m; w: event
// w of power, next_origin and next_direction: x, y and z of the normal.
OUTPUT(1, vec4, power)          // rgb of the incoming photon, W, not yet divided by the number of paths
// xyz: direction of the incoming photon; w: material; with TEXTURES, COATS, MIXTURES or CLEAR a color_code
OUTPUT(2, vec4, direction)
OUTPUT(3, vec4, next_origin)
OUTPUT(4, vec4, next_direction)

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/shading_normals.glsl>
#include <photongrid/trace/rough_leaving.glsl>
#include <photongrid/trace/coat.glsl>
#include <photongrid/trace/color_code.glsl>
#include <photongrid/trace/met_surface.glsl>

// The share of a photon that a coat reflects by the facet that it meets.
float coat_reflects(FacingNormals sides, Material coat, vec3 d, float u, float v)
{
    if (!ROUGH || !(coat.alpha > 0.0f))
        return fresnel(d, sides.shading, coat.index_of_refraction).reflected;
    vec3 facet = facet_met(sides, coat.alpha, d, u, v);
    precise float share = fresnel(d, facet, coat.index_of_refraction).reflected
        * leave_rough(sides, facet, coat.alpha, total_reflection(d), true, d).share;
    return share;
}

// Where a photon leaves that was scattered below a coat: cosine-distributed directions are drawn until one passes. At
// the largest index of refraction 0.36 of them do, so that 64 are enough but for fewer than 1 in 10^12 photons.
vec3 direction_out_of_coat(Coat c, vec3 normal, uint id, uint frame)
{
    vec3 next = normal;
    bool inside = true;
    for (uint turn = 1u; inside && turn <= 64u; ++turn) {
        vec4 r = random4(uvec4(id, frame, turn, args.seed));
        next = cosine_direction(normal, r.x, r.y);
        inside = !(r.z < passes_coat(c, dot3(next, normal)));
    }
    return next;
}

void kernel(uint i)
{
    uint frame = i / args.paths;
    uint before = i - args.paths;
    uint id = args.first_path + (i - frame * args.paths);
    position = vec4(0.0f, 0.0f, 0.0f, event_code(NO_SURFACE, ENDED_BEFORE, NOTHING_BEFORE));
    power = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = power;
    next_origin = power;
    next_direction = power;
    vec4 last = positions(before);
    if (event_end(last) != GOES_ON)
        return;

    uint hit_before = event_before(last);
    bool from_both = MIXTURES && event_kind(last) == BOTH_SURFACES;
    if ((event_kind(last) == SPECULAR_SURFACE || from_both) && hit_before == NOTHING_BEFORE)
        hit_before = SPECULAR_BEFORE;
    if (event_kind(last) == DIFFUSE_SURFACE)
        hit_before = DIFFUSE_BEFORE;

    // The photon that left the last surface: its power there times the colour of the material. Roulette accounts for
    // the absorbed part.
    vec4 arrived = powers(before);
    if (frame > 1u) {
        vec3 colour;
        if (TEXTURES || COATS || MIXTURES || CLEAR)
            colour = color_of_code(directions(before).w);
        else
            colour = material_of(uint(directions(before).w)).reflectance;
        float survival = largest3(colour);
        precise vec4 tinted = vec4(arrived.x * (colour.x / survival), arrived.y * (colour.y / survival),
            arrived.z * (colour.z / survival), 0.0f);
        arrived = tinted;
        if (from_both) {
            precise vec4 left = arrived * event_leaving(last);
            arrived = left;
        }
    }
    vec3 o = vec3(next_origins(before));
    vec3 d = vec3(next_directions(before));
    direction = vec4(d.x, d.y, d.z, 0.0f);
    power = arrived;

    if (!is_finite3(o) || !is_finite3(d) || !is_finite3(vec3(arrived))) {
        position.w = event_code(NO_SURFACE, NOT_A_NUMBER, NOTHING_BEFORE);
        return;
    }
    Hit hit = intersect_closest(o, d);
    uint number = i - frame * args.paths; // of the hit on a mesh
    bool on_mesh = MESHES && mesh_is_closer(hit, number);
    if (on_mesh)
        hit = mesh_hit(number);
    if (hit.t < 0.0f) {
        position.w = event_code(NO_SURFACE, ESCAPED, NOTHING_BEFORE);
        return;
    }
    position = vec4(hit.position.x, hit.position.y, hit.position.z, event_code(NO_SURFACE, ABSORBED, hit_before));
    if (!is_finite3(hit.position)) {
        position.w = event_code(NO_SURFACE, NOT_A_NUMBER, NOTHING_BEFORE);
        return;
    }
    if (hit.material == NO_MATERIAL)
        return; // the surfaces of lights are black

    uint end = frame < args.last_frame ? GOES_ON : CUT_OFF;
    vec4 chance = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (MIXTURES || CLEAR)
        chance = random4(uvec4(id, frame, 1000u, args.seed));
    if (CLEAR && !(chance.x < opacity_at(hit.material, on_mesh, number))) {
        vec3 beyond = ray_start(hit.position, hit.normal, d);
        direction.w = color_code(vec3(1.0f, 1.0f, 1.0f));
        next_origin = vec4(beyond.x, beyond.y, beyond.z, 0.0f);
        next_direction = vec4(d.x, d.y, d.z, 0.0f);
        position.w = event_code(NO_SURFACE, end, hit_before);
        return;
    }
    uint part = 0u;
    uint other = NO_MATERIAL; // the part of a mixture that the photon does not leave as from
    if (MIXTURES && is_mixture(hit.material)) {
        Parts parts = parts_of(hit.material);
        part = chance.y < share_at(parts, on_mesh, number) ? 1u : 0u;
        hit.material = part == 0u ? parts.first : parts.second;
        other = part == 0u ? parts.second : parts.first;
    }
    Material material = material_at(hit.material, part, on_mesh, number);
    direction.w = float(hit.material);
    vec4 r = random4(uvec4(id, frame, 0u, args.seed));
    FacingNormals sides = facing_normals(hit, d);
    vec3 facing = sides.shading;
    bool coated = COATS && material.kind == COATED_SURFACE;
    bool below = false; // whether the photon passes the coat
    if (coated) {
        below = !(r.w < coat_reflects(sides, material, d, r.y, r.z));
        material.reflectance = below ? under_coat(coat_of(hit.material), material.reflectance) : vec3(1.0f, 1.0f, 1.0f);
    }
    if (TEXTURES || COATS || MIXTURES || CLEAR)
        direction.w = largest3(material.reflectance) > 0.0f ? color_code(material.reflectance) : 0.0f;
    uint surface = material.kind == LAMBERTIAN_SURFACE || below ? DIFFUSE_SURFACE : SPECULAR_SURFACE;
    if (MIXTURES && surface == SPECULAR_SURFACE && other != NO_MATERIAL) {
        Material base = material_of(other);
        bool is_met = stores_photons(base) && !stores_photons(material);
        if (COATS && base.kind == COATED_SURFACE)
            is_met = is_met && !(r.w < coat_reflects(sides, base, d, r.y, r.z));
        if (is_met)
            surface = BOTH_SURFACES;
    }
    float received = 1.0f;
    if (SMOOTH && surface != SPECULAR_SURFACE) {
        // What the surface receives about its shading normal; it sends that out about its geometric normal.
        precise float share = dot3(facing, d) / dot3(sides.geometric, d);
        received = share < 8.0f ? share : 8.0f;
        precise vec3 scaled = vec3(power) * received;
        power = vec4(scaled.x, scaled.y, scaled.z, 0.0f);
    }
    power.w = facing.x;
    next_origin.w = facing.y;
    next_direction.w = facing.z;
    bool is_end = args.to_diffuse != 0u && surface == DIFFUSE_SURFACE;
    if (is_end || !(r.x < largest3(material.reflectance))) {
        position.w = event_code(surface, ABSORBED, hit_before);
        return;
    }
    position.w = event_code(surface, end, hit_before);
    vec3 next = facing;
    float leaving = 1.0f; // the factor on the power of what leaves a specular surface
    if (material.kind == LAMBERTIAN_SURFACE)
        next = cosine_direction(sides.geometric, r.y, r.z);
    if (below) {
        next = direction_out_of_coat(coat_of(hit.material), sides.geometric, id, frame);
    } else if (ROUGH && material.alpha > 0.0f) {
        vec3 facet = facet_met(sides, material.alpha, d, r.y, r.z);
        Fresnel f = total_reflection(d);
        if (GLASS && material.kind == GLASS_SURFACE)
            f = fresnel(d, outward_facet(hit, facet, d), material.index_of_refraction);
        RoughLeaving l = leave_rough(sides, facet, material.alpha, f, r.w < f.reflected, d);
        // Roulette by what other facets hide, too: r.x is even below the reflectance. Of a coat, that passes it.
        precise float survival = largest3(material.reflectance) * l.share;
        if (!coated && !(r.x < survival)) {
            position.w = event_code(surface, ABSORBED, hit_before);
            return;
        }
        next = l.direction;
        leaving = l.adjoint;
    } else if (material.kind != LAMBERTIAN_SURFACE && (MIRRORS || GLASS)) {
        Fresnel f = total_reflection(d);
        if (GLASS && material.kind == GLASS_SURFACE)
            f = fresnel(d, outward_normal(hit, sides, d), material.index_of_refraction);
        Leaving l = photon_leaves(hit, sides, f, r.w < f.reflected, material.index_of_refraction, d, r.y);
        next = l.direction;
        if (SMOOTH) {
            if (!(l.adjoint > 0.0f)) {
                position.w = event_code(surface, ABSORBED, hit_before);
                return;
            }
            leaving = l.adjoint;
        }
    }
    if (MIXTURES && surface == BOTH_SURFACES) {
        precise float share = leaving / received;
        position.w = event_of_both(end, hit_before, share, chance.z);
    } else if (SMOOTH && surface == SPECULAR_SURFACE) {
        precise vec3 scaled = vec3(power) * leaving;
        power = vec4(scaled.x, scaled.y, scaled.z, facing.x);
    }
    vec3 start = ray_start(hit.position, hit.normal, next);
    next_origin = vec4(start.x, start.y, start.z, facing.y);
    next_direction = vec4(next.x, next.y, next.z, facing.z);
}

// Whether this path needs no further frames.
bool done()
{
    return event_end(position) != GOES_ON;
}
