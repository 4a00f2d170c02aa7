// How light leaves rough surfaces. Included by kernels after trace/shading_normals.glsl.
#include <photongrid/trace/microfacet.glsl>
SWITCH(17, ROUGH)

// The normal of a facet that light of direction d meets, on the side where the light comes from.
vec3 facet_met(FacingNormals sides, float alpha, vec3 d, float u, float v)
{
    return from_basis(visible_facet(in_basis(-d, sides.shading), alpha, u, v), sides.shading);
}

// A normal on the side where the light comes from, as the outward one.
vec3 outward_facet(Hit hit, vec3 facet, vec3 d)
{
    return dot3(hit.normal, d) > 0.0f ? -facet : facet;
}

// How light leaves a rough surface.
struct RoughLeaving {
    vec3 direction;
    float share;   // that is not hidden by other facets
    float adjoint; // see Leaving
};

// Light of direction d is reflected or refracted by a facet; `f`: what fresnel() finds with the facet's normal.
RoughLeaving leave_rough(FacingNormals sides, vec3 facet, float alpha, Fresnel f, bool reflected, vec3 d)
{
    RoughLeaving l;
    l.direction = reflected ? reflect_direction(d, facet) : f.refracted;
    float up = reflected ? 1.0f : -1.0f;
    float cosine = dot3(l.direction, sides.shading) * up;
    l.share = cosine > 0.0f ? unhidden(cosine, alpha) : 0.0f;
    l.adjoint = 1.0f;
    if (SMOOTH) {
        float side = dot3(l.direction, sides.geometric) * up;
        precise float factor = abs(dot3(d, sides.shading) * side) / abs(dot3(d, sides.geometric) * cosine);
        l.adjoint = factor < 8.0f ? factor : 8.0f;
        if (!(side > 0.0f))
            l.share = 0.0f; // it would be on the wrong side of the surface
    }
    return l;
}
