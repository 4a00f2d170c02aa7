// Takes shadow rays (shadow_ray.glsl) through surfaces that are clear in part, and through panes, from one hit on a
// mesh to the next: what arrives falls by the share of light that each surface stops.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
INPUT(0, vec4, scene)
INPUT(1, vec4, directions)  // xyz: unit vector
INPUT(2, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(3, vec4, mesh_normals)
INPUT(4, vec4, mesh_shadings)
INPUT(5, vec4, mesh_colors) // see mesh_color.glsl
STATE(0, vec4, origin)      // xyz, m; w: length, m; 0 at the end
STATE(1, vec4, arriving)    // rgb: irradiance if nothing else blocks the ray, W/m^2

#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/met_surface.glsl>

bool done()
{
    return !(origin.w > 0.0f);
}

// The light that goes straight on through a surface of a material; `part`: see material_at().
vec3 straight_through(Hit hit, uint i, uint material, uint part)
{
    hit.material = material;
    Surface s = surface_met(hit, vec3(directions(i)), material_at(material, part, true, i));
    s.way = BY_REFRACTION;
    if (!goes_straight_on(s))
        return vec3(0.0f, 0.0f, 0.0f);
    precise vec3 passing = s.material.reflectance * (1.0f - facet_met(s, 0.0f, 0.0f).f.reflected);
    return passing;
}

// The light that passes the surface of the hit.
vec3 light_past(Hit hit, uint i)
{
    float opacity = opacity_at(hit.material, true, i);
    precise float clear = 1.0f - opacity;
    vec3 past = vec3(clear, clear, clear);
    if (!GLASS)
        return past;
    if (MIXTURES && is_mixture(hit.material)) {
        Parts parts = parts_of(hit.material);
        float share = share_at(parts, true, i);
        precise vec3 mixed = straight_through(hit, i, parts.first, 0u) * (opacity * (1.0f - share))
            + straight_through(hit, i, parts.second, 1u) * (opacity * share);
        precise vec3 both = past + mixed;
        return both;
    }
    precise vec3 whole = past + straight_through(hit, i, hit.material, 0u) * opacity;
    return whole;
}

void kernel(uint i)
{
    if (mesh_places(i).w < 0.0f) { // nothing
        origin.w = 0.0f;
        return;
    }
    Hit hit = mesh_hit(i);
    vec3 passes = vec3(0.0f, 0.0f, 0.0f);
    if (hit.material != NO_MATERIAL)
        passes = light_past(hit, i);
    precise vec3 left = vec3(arriving) * passes;
    arriving = vec4(left.x, left.y, left.z, arriving.w);
    vec3 d = vec3(directions(i));
    float side = dot3(hit.normal, d) > 0.0f ? 1.0f : -1.0f;
    vec3 beyond = ray_at(hit.position, hit.normal, side * ray_offset(hit.position, hit.round_share));
    precise float rest = origin.w - dot3(beyond - vec3(origin), d);
    origin = vec4(beyond.x, beyond.y, beyond.z, largest3(passes) > 0.0f && rest > 0.0f ? rest : 0.0f);
}
