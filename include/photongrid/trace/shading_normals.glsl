// Where light is reflected and refracted by a shading normal. Included by kernels after trace/optics.glsl.
SWITCH(10, SMOOTH)

// The normals at a hit on the side of a ray of direction d. The shading normal is turned towards the ray where it looks
// away from it, as it does at the outline of a coarse mesh.
struct FacingNormals {
    vec3 geometric;
    vec3 shading;
};

FacingNormals facing_normals(Hit hit, vec3 d)
{
    FacingNormals n;
    bool outside = !(dot3(hit.normal, d) > 0.0f);
    n.geometric = outside ? hit.normal : -hit.normal;
    n.shading = n.geometric;
    if (SMOOTH) {
        n.shading = outside ? hit.shading : -hit.shading;
        float cosine = -dot3(n.shading, d);
        if (cosine < 0.0078125f) {
            precise vec3 turned = n.shading - d * (0.0078125f - cosine);
            n.shading = normalized3(turned);
        }
    }
    return n;
}

// How light leaves a mirror or glass.
struct Leaving {
    vec3 direction;
    float adjoint; // factor on the power of photons (Veach, Robust Monte Carlo Methods for Light Transport Simulation,
                   // 1997, section 5.3), which shading normals need; at most 8
};

// The shading normal on the outside of the surface.
vec3 outward_normal(Hit hit, FacingNormals sides, vec3 d)
{
    if (!SMOOTH)
        return hit.normal;
    return dot3(hit.normal, d) > 0.0f ? -sides.shading : sides.shading;
}

// Light of direction d is reflected or refracted; `f` is what fresnel() finds with the shading normal. Where that would
// lead to the wrong side of the surface, the geometric normal decides.
Leaving leave_specular(Hit hit, FacingNormals sides, Fresnel f, bool reflected, float index, vec3 d)
{
    Leaving l;
    l.adjoint = 1.0f;
    if (reflected)
        l.direction = reflect_direction(d, outward_normal(hit, sides, d));
    else
        l.direction = f.refracted;
    if (SMOOTH) {
        float side = dot3(l.direction, sides.geometric);
        if (reflected ? side > 0.0f : side < 0.0f) {
            precise float factor = abs(dot3(d, sides.shading) * side)
                / abs(dot3(d, sides.geometric) * dot3(l.direction, sides.shading));
            l.adjoint = factor < 8.0f ? factor : 8.0f;
        } else {
            Fresnel g = fresnel(d, hit.normal, index);
            if (reflected || !(g.reflected < 1.0f))
                l.direction = reflect_direction(d, hit.normal);
            else
                l.direction = g.refracted;
        }
    }
    return l;
}

// The same for a photon, which must go where an eye ray comes from. Reflected by the shading normal it does, if that
// leads out of the surface; and along the geometric reflection `other`, if an eye ray that comes from there falls back
// to the geometric normal. Where both are possible, `u` chooses; where neither is, adjoint is 0.
Leaving photon_leaves(Hit hit, FacingNormals sides, Fresnel f, bool reflected, float index, vec3 d, float u)
{
    Leaving l = leave_specular(hit, sides, f, reflected, index, d);
    if (SMOOTH && reflected) {
        vec3 outward = outward_normal(hit, sides, d);
        vec3 other = reflect_direction(d, hit.normal);
        bool by_shading = dot3(reflect_direction(d, outward), sides.geometric) > 0.0f;
        bool by_geometric = !(dot3(reflect_direction(-other, outward), sides.geometric) > 0.0f);
        if (by_shading && by_geometric) {
            if (u < 0.5f) {
                l.direction = other;
                l.adjoint = 1.0f;
            }
            precise float doubled = 2.0f * l.adjoint;
            l.adjoint = doubled;
        } else if (!by_shading && !by_geometric) {
            l.adjoint = 0.0f;
        }
    }
    return l;
}
