// One bounce of all photons (2.1): computes frame f of the photon texture from frame f - 1. It records the photon that
// hits a surface. Russian roulette by reflectance decides whether the path continues, so that photons change in colour
// only.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint paths;      // elements of a frame
    uint first_path; // id of the path of a frame's element 0
    uint last_frame; // the last bounce allowed
    uint seed;
    uint ends;       // what ends paths besides absorption: see photon_event.glsl
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
// w of power, next_origin and next_direction: x, y and z of the geometric normal; with MEDIA the last is an
// inside_code.
OUTPUT(1, vec4, power)          // rgb of the incoming photon, W, not yet divided by the number of paths
// xyz: direction of the incoming photon; w: material; with codes_colors() a color_code
OUTPUT(2, vec4, direction)
OUTPUT(3, vec4, next_origin)
OUTPUT(4, vec4, next_direction)

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/color_code.glsl>
#include <photongrid/trace/met_surface.glsl>
#include <photongrid/trace/media.glsl>

// A photon on its way.
struct Photon {
    uint id;
    uint frame;
    vec4 power;  // W, of this photon
    uint before; // what it hit before: see photon_event.glsl
    uint end;    // how it goes on if it leaves a surface
    uint inside; // the media that it is in: see trace/media.glsl
};

// Whether the colour of the surface that a photon left is not always that of its material.
bool codes_colors()
{
    return TEXTURES || COATS || MIXTURES || CLEAR || REBOUNDS || MEDIA;
}

// What a path has hit, with the surface of its last event.
uint hit_before(vec4 last)
{
    uint kind = event_kind(last);
    if (kind == DIFFUSE_SURFACE)
        return DIFFUSE_BEFORE;
    uint before = event_before(last);
    bool specular = kind == SPECULAR_SURFACE || (kind == BOTH_SURFACES && !event_goes_straight_on(last));
    return specular && before == NOTHING_BEFORE ? SPECULAR_BEFORE : before;
}

// The photon that left the last surface: its power there times the colour of the material. Roulette accounts for the
// absorbed part.
vec4 arriving_power(uint before, vec4 last)
{
    vec3 colour;
    if (codes_colors())
        colour = color_of_code(directions(before).w);
    else
        colour = material_of(uint(directions(before).w)).reflectance;
    float survival = largest3(colour);
    vec4 arrived = powers(before);
    precise vec4 tinted = vec4(arrived.x * (colour.x / survival), arrived.y * (colour.y / survival),
        arrived.z * (colour.z / survival), 0.0f);
    arrived = tinted;
    if ((MIXTURES || CLEAR) && event_kind(last) == BOTH_SURFACES) {
        precise vec4 left = arrived * event_leaving(last);
        arrived = left;
    }
    return arrived;
}

// The kind of surface for a map of photons on rough ones: diffuse stands for rough. A path begins at smooth surfaces,
// since eye rays find the others. `other`: see surface_for().
uint rough_surface_for(Surface s, uint other, uint before)
{
    if (before == NOTHING_BEFORE)
        return is_delta(s) ? SPECULAR_SURFACE : NO_SURFACE;
    if (s.material.alpha > 0.0f)
        return DIFFUSE_SURFACE;
    bool is_stored = MIXTURES && other != NO_MATERIAL && material_of(other).alpha > 0.0f;
    if (is_stored)
        return is_delta(s) ? BOTH_SURFACES : DIFFUSE_SURFACE;
    return is_delta(s) ? SPECULAR_SURFACE : NO_SURFACE;
}

// The kind of surface that a photon meets. `other`: the part of the mixture that was not drawn; it may still store the
// photon. `r`: its random numbers.
uint surface_for(Surface s, uint other, vec4 r)
{
    if (s.way == BY_BASE)
        return DIFFUSE_SURFACE;
    if (!MIXTURES || other == NO_MATERIAL || stores_photons(s.material))
        return SPECULAR_SURFACE;
    s.material = material_of(other);
    s.number = other;
    bool is_stored = stores_photons(s.material) && !(r.w < reflected_share(s, facet_met(s, r.y, r.z)));
    return is_stored ? BOTH_SURFACES : SPECULAR_SURFACE;
}

// Writes power and normal of the photon that the surface receives; `inside`: the media on its side.
void receive(vec3 received, vec3 normal, uint inside)
{
    power = vec4(received.x, received.y, received.z, normal.x);
    next_origin.w = normal.y;
    next_direction.w = inside_code(inside, normal.z);
}

// The photon leaves into the media `inside`.
void leave(Hit hit, vec3 d, vec3 normal, uint inside)
{
    vec3 start = ray_start(hit, d);
    next_origin = vec4(start.x, start.y, start.z, normal.y);
    next_direction = vec4(d.x, d.y, d.z, inside_code(inside, normal.z));
}

void go_straight_on(Hit hit, vec3 d, Photon photon)
{
    power = photon.power;
    direction.w = color_code(vec3(1.0f, 1.0f, 1.0f));
    leave(hit, d, vec3(0.0f, 0.0f, 0.0f), photon.inside);
    position.w = event_code(NO_SURFACE, photon.end, photon.before);
}

// The photon passes a surface that is clear in part, which has stored it if `surface` is one that does: stored with its
// opacity alone, a map would have that share of the irradiance, of which the eye would see that share once more.
void pass_clear(Hit hit, Surface s, uint surface, Photon photon, float round_by)
{
    if (surface < DIFFUSE_SURFACE) {
        go_straight_on(hit, s.d, photon);
        return;
    }
    direction.w = color_code(vec3(1.0f, 1.0f, 1.0f));
    precise float leaving = 1.0f / received_by_base(s);
    position.w = event_of_both(photon.end, photon.before, leaving, round_by, true);
    leave(hit, s.d, s.geometric, photon.inside);
}

// The photon meets a surface, which may store it, and leaves it or is absorbed. `other`: see surface_for(); `round_by`:
// a random number; `passes`: it goes straight on; `behind`: the media on the other side.
void scatter(Hit hit, Surface s, uint other, Photon photon, float round_by, bool passes, uint behind)
{
    vec4 r = random4(uvec4(photon.id, photon.frame, 0u, args.seed));
    Facet facet = facet_met(s, r.y, r.z);
    s = leaving_by(s, way_of(s, r.w < reflected_share(s, facet)));
    float survival = largest3(s.material.reflectance);
    direction.w = float(s.number);
    if (codes_colors())
        direction.w = survival > 0.0f ? color_code(s.material.reflectance) : 0.0f;
    bool for_rough = ROUGH && args.ends == ROUGH_ENDS;
    uint surface = for_rough ? rough_surface_for(s, other, photon.before) : surface_for(s, other, r);
    float received = surface == SPECULAR_SURFACE ? 1.0f : received_by_base(s);
    precise vec3 at_base = vec3(photon.power) * received; // which sends it out about its geometric normal
    receive(at_base, s.geometric, photon.inside);
    position.w = event_code(surface, ABSORBED, photon.before);
    if (CLEAR && passes) {
        pass_clear(hit, s, surface, photon, round_by);
        return;
    }
    bool ends = surface == NO_SURFACE || (args.ends != NOTHING_ENDS && surface == DIFFUSE_SURFACE);
    if (ends || !(r.x < survival))
        return;
    if (goes_straight_on(s)) {
        pass_clear(hit, s, surface, photon, round_by);
        direction.w = color_code(s.material.reflectance);
        return;
    }
    Scattered l = scatter_photon(s, facet, r.y, r.z, uvec4(photon.id, photon.frame, 0u, args.seed));
    if (has_rebounds(s.material)) {
        precise vec3 tinted = s.material.reflectance * l.tint;
        survival = largest3(tinted); // of what r.x leaves; no larger than before
        direction.w = color_code(tinted);
    }
    // r.x is uniform below `survival`, so the same number also decides whether another facet hides the photon. What
    // hides it from a coat's reflection goes to the base.
    precise float unhidden_survival = survival * (is_coated(s) ? 1.0f : l.unhidden);
    if (!(r.x < unhidden_survival) || !(l.power_scale > 0.0f))
        return;
    position.w = event_code(surface, photon.end, photon.before);
    if (MIXTURES && surface == BOTH_SURFACES) {
        precise float leaving = l.power_scale / received;
        position.w = event_of_both(photon.end, photon.before, leaving, round_by, false);
    } else if (surface == SPECULAR_SURFACE) {
        precise vec3 scaled = at_base * l.power_scale;
        receive(scaled, s.geometric, photon.inside);
    }
    leave(hit, l.direction, s.geometric, l.way == BY_REFRACTION ? behind : photon.inside);
}

void kernel(uint i)
{
    Photon photon;
    photon.frame = i / args.paths;
    uint number = i - photon.frame * args.paths; // of the path in a frame, and of its hit on a mesh
    uint before = i - args.paths;
    photon.id = args.first_path + number;
    photon.end = photon.frame < args.last_frame ? GOES_ON : CUT_OFF;
    photon.inside = 0u;
    position = vec4(0.0f, 0.0f, 0.0f, event_code(NO_SURFACE, ENDED_BEFORE, NOTHING_BEFORE));
    power = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    direction = power;
    next_origin = power;
    next_direction = power;
    vec4 last = positions(before);
    if (event_end(last) != GOES_ON)
        return;
    photon.before = hit_before(last);
    photon.power = photon.frame > 1u ? arriving_power(before, last) : powers(before);
    photon.inside = inside_of(next_directions(before).w);
    power = photon.power;
    vec3 o = vec3(next_origins(before));
    vec3 d = vec3(next_directions(before));
    direction = vec4(d.x, d.y, d.z, 0.0f);
    position.w = event_code(NO_SURFACE, NOT_A_NUMBER, NOTHING_BEFORE);
    if (!is_finite3(o) || !is_finite3(d) || !is_finite3(vec3(photon.power)))
        return;
    Hit hit = intersect_closest(o, d);
    bool on_mesh = MESHES && mesh_is_closer(hit, number);
    if (on_mesh)
        hit = mesh_hit(number);
    if (hit.t < 0.0f) {
        position.w = event_code(NO_SURFACE, ESCAPED, NOTHING_BEFORE);
        return;
    }
    position = vec4(hit.position.x, hit.position.y, hit.position.z, position.w);
    if (!is_finite3(hit.position))
        return;
    position.w = event_code(NO_SURFACE, ABSORBED, photon.before);
    if (hit.material == NO_MATERIAL)
        return; // the surfaces of lights are black
    if (MEDIA && photon.inside != 0u) { // Russian roulette: photons change in colour only
        vec3 left = left_after(photon.inside, hit.t);
        float survival = largest3(left);
        if (!(random4(uvec4(photon.id, photon.frame, 1001u, args.seed)).x < survival))
            return;
        precise vec3 tinted = vec3(photon.power) * (left / survival);
        photon.power = vec4(tinted.x, tinted.y, tinted.z, 0.0f);
        power = photon.power;
    }

    vec4 chance = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (MIXTURES || CLEAR)
        chance = random4(uvec4(photon.id, photon.frame, 1000u, args.seed));
    bool passes = false;
    if (CLEAR) {
        float opacity = opacity_at(hit.material, on_mesh, number);
        passes = !(chance.x < opacity);
        if (!(opacity > 0.0f)) {
            go_straight_on(hit, d, photon);
            return;
        }
    }
    uint part = 0u;
    uint other = NO_MATERIAL;
    if (MIXTURES && is_mixture(hit.material)) {
        Parts parts = parts_of(hit.material);
        part = chance.y < share_at(parts, on_mesh, number) ? 1u : 0u;
        hit.material = part == 0u ? parts.first : parts.second;
        other = part == 0u ? parts.second : parts.first;
    }
    Surface s = surface_met(hit, d, material_at(hit.material, part, on_mesh, number));
    uint behind = 0u;
    if (MEDIA && s.material.kind == GLASS_SURFACE) {
        Crossing c = crossing(photon.inside, s.number, s.outside, s.material.index_of_refraction);
        photon.inside = c.is_real ? c.in_front : c.behind;
        behind = c.behind;
        s.material = between_media(s.material, c);
        if (!c.is_real) {
            go_straight_on(hit, d, photon);
            return;
        }
    }
    scatter(hit, s, other, photon, chance.z, passes, behind);
}

// Whether this path needs no further frames.
bool done()
{
    return event_end(position) != GOES_ON;
}
