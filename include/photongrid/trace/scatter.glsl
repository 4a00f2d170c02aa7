// Scattering: how light leaves a surface, the same for photons and eye rays. Included by kernels after
// trace/materials.glsl, trace/optics.glsl, and the SWITCHes MIRRORS and GLASS.
//
// A ray meets a surface at a facet, facet_met(), whose normal is the shading normal unless the surface is rough. The
// facet reflects a share of the light, reflected_share(). The rest is refracted into the body, or scattered by the
// matte base. The caller chooses: leaving_by(). Of the surface for light that leaves that way,
//
//     scatter_sample()  draws a direction
//     scatter_eval()    is the BSDF of light that comes from a direction, divided by the reflectance
//     scatter_pdf()     is the density with which scatter_sample() draws a direction; of the base of a smooth mesh
//                       it is about the shading normal, by which light is received, not about the geometric one, by
//                       which photons leave. Where light rebounds between facets (trace/rebounds.glsl) it is that of
//                       samples by all ways together
//     is_delta()        whether there is but one direction: then the BSDF and the density are 0
#include <photongrid/trace/coat.glsl>
#include <photongrid/trace/microfacet.glsl>
#include <photongrid/trace/rebounds.glsl>
SWITCH(10, SMOOTH)
SWITCH(17, ROUGH)

// A surface that a ray meets.
struct Surface {
    Material material; // after leaving_by() its reflectance is that of the way
    uint number;       // of the material
    uint way;          // by which light leaves: see scene_layout.glsl
    vec3 d;            // unit: direction of the ray
    bool outside;      // the ray comes from outside
    vec3 geometric;    // unit: the normals on the ray's side
    vec3 shading;
};

bool is_coated(Surface s)
{
    return COATS && s.material.kind == COATED_SURFACE;
}

bool has_facets(Surface s)
{
    return ROUGH && s.material.alpha > 0.0f;
}

bool is_delta(Surface s)
{
    return s.way != BY_BASE && !has_facets(s);
}

// Whether light goes straight on, as through a smooth pane.
bool goes_straight_on(Surface s)
{
    return CLEAR && s.way == BY_REFRACTION && is_thin(s.material) && !has_facets(s);
}

// The surface for light that leaves by `way`. A coated one gets the reflectance of that way: white for the coat; for
// the base, the share that gets out through the coat. What a smooth pane reflects is white, too.
Surface leaving_by(Surface s, uint way)
{
    s.way = way;
    if (is_coated(s))
        s.material.reflectance
            = way == BY_BASE ? under_coat(coat_of(s.number), s.material.reflectance) : vec3(1.0f, 1.0f, 1.0f);
    if (CLEAR && is_thin(s.material) && way == BY_REFLECTION && !has_facets(s))
        s.material.reflectance = vec3(1.0f, 1.0f, 1.0f);
    return s;
}

// By which way light leaves, if the facet reflected it or did not.
uint way_of(Surface s, bool reflected)
{
    if (reflected)
        return BY_REFLECTION;
    return is_glass(s.material) ? BY_REFRACTION : BY_BASE;
}

// A surface that a ray of direction d meets at a hit. The shading normal is turned towards the ray where it looks away
// from it, as it does at the outline of a coarse mesh.
Surface surface_met(Hit hit, vec3 d, Material material)
{
    Surface s;
    s.material = material;
    s.number = hit.material;
    s.way = material.kind == LAMBERTIAN_SURFACE || !(MIRRORS || GLASS) ? BY_BASE : BY_REFLECTION;
    s.d = d;
    s.outside = !(dot3(hit.normal, d) > 0.0f);
    s.geometric = s.outside ? hit.normal : -hit.normal;
    s.shading = s.geometric;
    if (SMOOTH) {
        s.shading = s.outside ? hit.shading : -hit.shading;
        float cosine = -dot3(s.shading, d);
        if (cosine < 0.0078125f) {
            precise vec3 turned = s.shading - d * (0.0078125f - cosine);
            s.shading = normalized3(turned);
        }
    }
    return s;
}

// A facet of a surface that a ray meets.
struct Facet {
    vec3 normal; // unit, on the ray's side
    Fresnel f;   // how it divides the light
};

// What a pane does, if its front does f: both its faces, with all reflections between them (Stokes 1862). What passes
// a facet leaves as what it reflects would, on the other side.
Fresnel through_pane(Surface s, vec3 facet, Fresnel f)
{
    precise float both = 2.0f * f.reflected / (1.0f + f.reflected);
    f.reflected = both;
    f.radiance_scale = 1.0f;
    f.refracted = has_facets(s) ? reflect_direction(reflect_direction(s.d, facet), s.shading) : s.d;
    return f;
}

// `u`, `v` from 0 to 1 choose the facet of a rough surface.
Facet facet_met(Surface s, float u, float v)
{
    Facet facet;
    facet.normal = s.shading;
    if (has_facets(s) && s.material.kind != LAMBERTIAN_SURFACE)
        facet.normal = from_basis(visible_facet(in_basis(-s.d, s.shading), s.material.alpha, u, v), s.shading);
    facet.f = total_reflection(s.d);
    bool is_body = GLASS && s.material.kind == GLASS_SURFACE;
    bool is_pane = GLASS && is_thin(s.material);
    if (is_body || is_pane || is_coated(s)) // coats and panes are met from outside on both sides of the surface
        facet.f = fresnel(s.d, s.outside || !is_body ? facet.normal : -facet.normal, s.material.index_of_refraction);
    if (is_pane)
        facet.f = through_pane(s, facet.normal, facet.f);
    return facet;
}

// How light leaves a surface in a direction.
struct Scattered {
    vec3 direction;       // unit
    float unhidden;       // share of the light that no other facet hides
    uint way;             // by which it leaves: rebounds may lead to the other side
    vec3 tint;            // factor on the reflectance
    float radiance_scale; // factor on radiance
    float power_scale;    // factor on the power of photons, which shading normals need (Veach, Robust Monte Carlo
                          // Methods for Light Transport Simulation, 1997, section 5.3); 0: none leaves
};

// Veach's factor on power where the shading normal is not the geometric one, at most 8. `geometric`, `shading`: cosines
// of the leaving direction with these normals.
float shading_factor(Surface s, float geometric, float shading)
{
    precise float factor
        = abs(dot3(s.d, s.shading) * geometric) / abs(dot3(s.d, s.geometric) * shading);
    return factor < 8.0f ? factor : 8.0f;
}

bool starts_inside(Surface s)
{
    return GLASS && s.material.kind == GLASS_SURFACE && !s.outside;
}

// After rebounds between facets, for numbers from 0 to 1.
Scattered leave_rebounds(Surface s, float side, float u, float v)
{
    Rebounds r = rebounds_of(s.material);
    bool inside = starts_inside(s);
    bool crosses = GLASS && s.material.kind == GLASS_SURFACE
        && side < crossing_share(r, inside, s.material.index_of_refraction);
    float cosine = rebound_cosine(r, inside != crosses, u);
    precise float sine = sqrt(1.0f - cosine * cosine);
    vec2 circle = unit_circle(v);
    vec3 up = crosses ? -s.shading : s.shading;
    Scattered l;
    precise vec3 local = vec3(sine * circle.x, sine * circle.y, cosine);
    l.direction = from_basis(local, up);
    l.unhidden = 1.0f;
    l.way = crosses ? BY_REFRACTION : BY_REFLECTION;
    l.tint = rebound_tint(r, s.material);
    float eta = inside ? s.material.index_of_refraction : 1.0f / s.material.index_of_refraction;
    precise float eta2 = eta * eta;
    l.radiance_scale = crosses ? eta2 : 1.0f;
    l.power_scale = 1.0f;
    return l;
}

// By a facet of a rough surface. `r`: numbers from 0 to 1, if light rebounds.
Scattered leave_facet(Surface s, Facet facet, vec4 r)
{
    bool reflected = s.way == BY_REFLECTION;
    Scattered l;
    l.way = s.way;
    l.tint = vec3(1.0f, 1.0f, 1.0f);
    l.direction = reflected ? reflect_direction(s.d, facet.normal) : facet.f.refracted;
    l.radiance_scale = reflected ? 1.0f : facet.f.radiance_scale;
    float up = reflected ? 1.0f : -1.0f;
    float cosine = dot3(l.direction, s.shading) * up;
    l.unhidden = cosine > 0.0f ? unhidden(cosine, s.material.alpha) : 0.0f;
    l.power_scale = 1.0f;
    if (has_rebounds(s.material)) {
        if (r.x < l.unhidden)
            l.unhidden = 1.0f;
        else
            l = leave_rebounds(s, r.y, r.z, r.w);
        up = l.way == BY_REFLECTION ? 1.0f : -1.0f;
        cosine = dot3(l.direction, s.shading) * up;
    }
    if (SMOOTH) {
        float side = dot3(l.direction, s.geometric) * up;
        l.power_scale = shading_factor(s, side, cosine);
        if (!(side > 0.0f))
            l.unhidden = 0.0f; // it would be on the wrong side of the surface
    }
    return l;
}

// By a smooth mirror, coat or glass. Where the shading normal would lead to the wrong side of the surface, the
// geometric normal decides.
Scattered leave_smooth(Surface s, Facet facet)
{
    bool reflected = s.way == BY_REFLECTION;
    Scattered l;
    l.way = s.way;
    l.tint = vec3(1.0f, 1.0f, 1.0f);
    l.direction = reflected ? reflect_direction(s.d, s.shading) : facet.f.refracted;
    l.unhidden = 1.0f;
    l.radiance_scale = reflected ? 1.0f : facet.f.radiance_scale;
    l.power_scale = 1.0f;
    if (SMOOTH) {
        float side = dot3(l.direction, s.geometric);
        if (reflected ? side > 0.0f : side < 0.0f) {
            l.power_scale = shading_factor(s, side, dot3(l.direction, s.shading));
        } else {
            Fresnel g = fresnel(s.d, s.outside ? s.geometric : -s.geometric, s.material.index_of_refraction);
            bool turns_back = reflected || !(g.reflected < 1.0f);
            l.direction = turns_back ? reflect_direction(s.d, s.geometric) : g.refracted;
            l.radiance_scale = turns_back ? 1.0f : g.radiance_scale;
        }
    }
    return l;
}

// A photon that is reflected must go where an eye ray comes from. Reflected by the shading normal it does, if that
// leads out of the surface; and along the geometric reflection, if an eye ray that comes from there falls back to the
// geometric normal. Where both are possible, `u` chooses; where neither is, no power leaves. `l`: what leave_smooth()
// finds.
Scattered where_eye_rays_come_from(Surface s, Scattered l, float u)
{
    vec3 other = reflect_direction(s.d, s.geometric);
    bool by_shading = dot3(reflect_direction(s.d, s.shading), s.geometric) > 0.0f;
    bool by_geometric = !(dot3(reflect_direction(-other, s.shading), s.geometric) > 0.0f);
    if (by_shading && by_geometric) {
        if (u < 0.5f) {
            l.direction = other;
            l.power_scale = 1.0f;
        }
        precise float doubled = 2.0f * l.power_scale;
        l.power_scale = doubled;
    } else if (!by_shading && !by_geometric) {
        l.power_scale = 0.0f;
    }
    return l;
}

// By the base: cosine-distributed about the geometric normal. Below a coat such directions are drawn until one passes.
// At the largest index of refraction 0.36 of them do, so that 64 are enough but for fewer than 1 in 10^12. `stream`
// names their random numbers.
Scattered leave_base(Surface s, float u, float v, uvec4 stream)
{
    Scattered l;
    l.way = s.way;
    l.tint = vec3(1.0f, 1.0f, 1.0f);
    l.unhidden = 1.0f;
    l.radiance_scale = 1.0f;
    l.power_scale = 1.0f;
    if (is_coated(s)) {
        Coat c = coat_of(s.number);
        l.direction = s.geometric;
        bool inside = true;
        for (uint turn = 1u; inside && turn <= 64u; ++turn) {
            vec4 r = random4(uvec4(stream.x, stream.y, turn, stream.w));
            l.direction = cosine_direction(s.geometric, r.x, r.y);
            inside = !(r.z < passes_coat(c, dot3(l.direction, s.geometric)));
        }
    } else {
        l.direction = cosine_direction(s.geometric, u, v);
    }
    return l;
}

// `facet`: what facet_met() found; u, v from 0 to 1: numbers that found it; `r`: others, if has_rebounds().
Scattered scatter_sample(Surface s, Facet facet, float u, float v, vec4 r, uvec4 stream)
{
    if (s.way == BY_BASE)
        return leave_base(s, u, v, stream);
    if (has_facets(s))
        return leave_facet(s, facet, r);
    return leave_smooth(s, facet);
}

// The same of a photon.
Scattered scatter_photon(Surface s, Facet facet, float u, float v, uvec4 stream)
{
    vec4 r = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (has_rebounds(s.material))
        r = random4(uvec4(stream.x, stream.y, 100u, stream.w));
    Scattered l = scatter_sample(s, facet, u, v, r, stream);
    if (SMOOTH && s.way == BY_REFLECTION && is_delta(s))
        l = where_eye_rays_come_from(s, l, u);
    return l;
}

// The share of the light that a facet reflects, and that no other one hides: a coat passes that on to its base.
float reflected_share(Surface s, Facet facet)
{
    if (s.material.kind == LAMBERTIAN_SURFACE)
        return 0.0f;
    float share = facet.f.reflected;
    if (is_coated(s) && has_facets(s)) {
        s.way = BY_REFLECTION;
        precise float seen = share * leave_facet(s, facet, vec4(0.0f, 0.0f, 0.0f, 0.0f)).unhidden;
        share = seen;
    }
    return share;
}

// The factor on the power of a photon that a base receives: it has been measured about the geometric normal. It is at
// most 8.
float received_by_base(Surface s)
{
    if (!SMOOTH)
        return 1.0f;
    precise float share = dot3(s.shading, s.d) / dot3(s.geometric, s.d);
    return share < 8.0f ? share : 8.0f;
}

// The BSDF of radiance, divided by the reflectance, and the density of directions, both in sr^-1.
struct Scattering {
    vec3 bsdf;
    float density;
};

// Light comes from `towards` and leaves against s.d by facets: is reflected or refracted.
Scattering scattering_of_facets(Surface s, vec3 towards)
{
    Scattering none;
    none.bsdf = vec3(0.0f, 0.0f, 0.0f);
    none.density = 0.0f;
    float alpha = s.material.alpha;
    bool is_pane = is_thin(s.material);
    bool is_body = is_glass(s.material) && !is_pane;
    float side = dot3(towards, s.shading);
    bool reflected = s.way == BY_REFLECTION;
    float cosine = reflected ? side : -side;
    float seen_cosine = -dot3(s.d, s.shading);
    if (!(cosine > 0.0f) || !(seen_cosine > 0.0f) || (!reflected && !is_glass(s.material)))
        return none;
    bool passes_pane = is_pane && !reflected;
    if (passes_pane) { // see through_pane()
        towards = reflect_direction(towards, s.shading);
        reflected = true;
    }
    float eta = s.outside ? 1.0f / s.material.index_of_refraction : s.material.index_of_refraction;
    precise vec3 between = towards - s.d * (reflected ? 1.0f : eta);
    vec3 facet = normalized3(between);
    facet = dot3(facet, s.shading) < 0.0f ? -facet : facet;
    float seen = -dot3(s.d, facet);
    float lit = dot3(towards, facet);
    if (!(seen > 0.0f) || !(reflected ? lit > 0.0f : lit < 0.0f))
        return none;
    float share = 1.0f;
    if (s.material.kind != MIRROR_SURFACE) // a coat is met from outside on both sides of the surface
        share = fresnel(s.d, s.outside || !is_body ? facet : -facet, s.material.index_of_refraction).reflected;
    if (is_pane) {
        precise float both = 2.0f * share / (1.0f + share);
        share = passes_pane ? 1.0f - both : both;
    }
    // Half vectors per solid angle of `towards`, times the cosine by which a facet is seen.
    precise float sum = eta * seen + lit;
    precise float jacobian = reflected ? 0.25f : seen * abs(lit) / (sum * sum);
    precise float density
        = facets_with(in_basis(facet, s.shading), alpha) * unhidden(seen_cosine, alpha) * jacobian / seen_cosine;
    precise float scaled = reflected ? share : (1.0f - share) * eta * eta;
    precise float bsdf = density * scaled * unhidden(cosine, alpha) / cosine;
    Scattering found;
    found.bsdf = vec3(bsdf, bsdf, bsdf);
    found.density = density;
    return found;
}

// The same with light that rebounds. `single`: by one facet.
Scattering with_rebounds(Surface s, vec3 towards, Scattering single)
{
    bool reflected = s.way == BY_REFLECTION;
    float side = dot3(towards, s.shading);
    float cosine = reflected ? side : -side;
    float seen_cosine = -dot3(s.d, s.shading);
    if (!(cosine > 0.0f) || !(seen_cosine > 0.0f) || (!reflected && !is_glass(s.material)))
        return single;
    Rebounds r = rebounds_of(s.material);
    bool inside = starts_inside(s);
    float crosses = is_glass(s.material) ? crossing_share(r, inside, s.material.index_of_refraction) : 0.0f;
    float mean = inside != reflected ? r.outside : r.inside; // on the side of `towards`
    precise float by_rebounds = 0.318309886f * (reflected ? 1.0f - crosses : crosses)
        * hidden_share(r, inside, seen_cosine) * (hidden_share(r, inside == reflected, cosine) / mean);
    float eta = inside ? s.material.index_of_refraction : 1.0f / s.material.index_of_refraction;
    precise float eta2 = reflected ? 1.0f : eta * eta;
    precise vec3 bsdf = single.bsdf + rebound_tint(r, s.material) * (by_rebounds * eta2);
    precise float density = (single.bsdf.x / eta2 + by_rebounds) * cosine;
    Scattering found;
    found.bsdf = bsdf;
    found.density = density;
    return found;
}

// The same by the base.
Scattering scattering_of_base(Surface s, vec3 towards)
{
    float cosine = dot3(towards, s.shading);
    precise float even = cosine > 0.0f ? 0.318309886f : 0.0f;
    Scattering found;
    found.bsdf = vec3(even, even, even);
    if (is_coated(s)) {
        Coat c = coat_of(s.number);
        precise float passed = even * passes_coat(c, cosine);
        precise float both = passed * passes_coat(c, -dot3(s.d, s.shading)) / c.mean_passed;
        found.bsdf = vec3(both, both, both);
        precise float passing = passed / c.mean_passed;
        even = passing;
    }
    precise float density = even * cosine;
    found.density = density;
    return found;
}

Scattering scattering(Surface s, vec3 towards)
{
    if (s.way == BY_BASE)
        return scattering_of_base(s, towards);
    Scattering none;
    none.bsdf = vec3(0.0f, 0.0f, 0.0f);
    none.density = 0.0f;
    if (!has_facets(s))
        return none;
    Scattering found = scattering_of_facets(s, towards);
    if (has_rebounds(s.material))
        found = with_rebounds(s, towards, found);
    return found;
}

vec3 scatter_eval(Surface s, vec3 towards)
{
    return scattering(s, towards).bsdf;
}

float scatter_pdf(Surface s, vec3 towards)
{
    return scattering(s, towards).density;
}
