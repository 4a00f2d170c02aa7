// Rough surfaces: facets with normals by the GGX distribution, shadowed as Smith has it (Walter, Marschner, Li and
// Torrance, Microfacet Models for Refraction through Rough Surfaces, 2007). Light that meets a second facet is lost.
// Included by kernels after core/vector.glsl.

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
