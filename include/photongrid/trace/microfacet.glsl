// Rough surfaces: facets with normals by the GGX distribution, shadowed as Smith has it (Walter, Marschner, Li and
// Torrance, Microfacet Models for Refraction through Rough Surfaces, 2007). Light that meets a second facet is lost.
// Included by kernels after trace/materials.glsl and trace/optics.glsl. How light leaves: rough_leaving.glsl.

// The normal of a facet that is seen from `view`, for numbers from 0 to 1; facets come in proportion to the area that
// is seen of them (Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps, 2023). Both are unit vectors in
// a basis whose third axis is the surface's normal.
vec3 visible_facet(vec3 view, float alpha, float u, float v)
{
    precise vec3 stretched_view = vec3(view.x * alpha, view.y * alpha, view.z);
    vec3 stretched = normalized3(stretched_view);
    precise float z = (1.0f - u) * (1.0f + stretched.z) - stretched.z;
    precise float sine2 = 1.0f - z * z;
    precise float sine = sqrt(sine2 > 0.0f ? sine2 : 0.0f);
    vec2 circle = unit_circle(v);
    precise vec3 half_way = vec3(sine * circle.x, sine * circle.y, z) + stretched;
    precise vec3 facet = vec3(half_way.x * alpha, half_way.y * alpha, half_way.z);
    if (!(facet.z > 0.0f)) // rounded: seen at right angles
        return vec3(0.0f, 0.0f, 1.0f);
    return normalized3(facet);
}

// The share of the facets that face a direction and that no other hides; `cosine`: of the direction and the normal.
float unhidden(float cosine, float alpha)
{
    precise float cosine2 = cosine * cosine;
    precise float share = 2.0f * cosine / (cosine + sqrt(cosine2 + alpha * alpha * (1.0f - cosine2)));
    return share < 1.0f ? share : 1.0f;
}

// The area of all facets with this normal, per solid angle, of an area of 1 of the surface.
float facets_with(vec3 facet, float alpha)
{
    precise vec3 squeezed = vec3(facet.x / alpha, facet.y / alpha, facet.z);
    float length2 = dot3(squeezed, squeezed);
    precise float density = 1.0f / (3.14159265f * alpha * alpha * length2 * length2);
    return density;
}

// Light that comes from `towards` and leaves against d by a rough surface.
struct RoughScattering {
    float bsdf;    // of radiance, sr^-1
    float density; // of the directions in which facets that are visible along d send an eye ray, sr^-1
};

// `outside`: d comes from outside. Of a coated surface: by its coat.
RoughScattering rough_scattering(vec3 normal, Material m, bool outside, vec3 d, vec3 towards)
{
    float alpha = m.alpha;
    RoughScattering s;
    s.bsdf = 0.0f;
    s.density = 0.0f;
    float side = dot3(towards, normal);
    bool reflected = side > 0.0f;
    float cosine = reflected ? side : -side;
    float seen_cosine = -dot3(d, normal);
    if (!(cosine > 0.0f) || !(seen_cosine > 0.0f) || (!reflected && !is_glass(m)))
        return s;
    float eta = outside ? 1.0f / m.index_of_refraction : m.index_of_refraction;
    precise vec3 between = towards - d * (reflected ? 1.0f : eta);
    vec3 facet = normalized3(between);
    facet = dot3(facet, normal) < 0.0f ? -facet : facet;
    float seen = -dot3(d, facet);
    float lit = dot3(towards, facet);
    if (!(seen > 0.0f) || !(reflected ? lit > 0.0f : lit < 0.0f))
        return s;
    float share = 1.0f;
    if (m.kind != MIRROR_SURFACE) // a coat is met from outside on both sides of the surface
        share = fresnel(d, outside || !is_glass(m) ? facet : -facet, m.index_of_refraction).reflected;
    // Half vectors per solid angle of `towards`, times the cosine by which a facet is seen.
    precise float apart = eta * seen + lit;
    precise float jacobian = reflected ? 0.25f : seen * abs(lit) / (apart * apart);
    precise float density
        = facets_with(in_basis(facet, normal), alpha) * unhidden(seen_cosine, alpha) * jacobian / seen_cosine;
    s.density = density;
    precise float scaled = reflected ? share : (1.0f - share) * eta * eta;
    precise float bsdf = density * scaled * unhidden(cosine, alpha) / cosine;
    s.bsdf = bsdf;
    return s;
}
