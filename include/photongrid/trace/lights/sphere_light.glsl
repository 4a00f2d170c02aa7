// Spheres that are lights (scene/sphere_light.hpp). Records: at + 1: centre; at + 2: radius.
SWITCH(12, SPHERE_LIGHTS)
const uint SPHERE_LIGHT = 12u;

// The distance of rays' ends from the surface, m.
float sphere_light_offset(vec3 centre, float radius)
{
    return ray_offset(
        abs(centre) + vec3(radius, radius, radius), round_share_of(scene(SCENE_SIZES), 2.0f * radius));
}

Emitted sphere_emit(uint at, Emitted e, vec4 r)
{
    vec3 centre = vec3(scene(at + 1u));
    vec3 normal = uniform_direction(r.z, r.w);
    float radius = scene(at + 2u).x;
    e.direction = cosine_direction(normal, r.x, r.y);
    e.origin = ray_at(centre, normal, radius + sphere_light_offset(centre, radius));
    return e;
}

// A direction that is even over the solid angle that the sphere takes up (Shirley, Wang and Zimmerman, Monte Carlo
// Techniques for Direct Lighting Calculations, 1996).
ArrivingLight sphere_sample(uint at, ArrivingLight a, SampleNumbers n, LitPoint lit)
{
    a.radiance_per_power = radiance_per_power(at);
    vec3 centre = vec3(scene(at + 1u));
    float radius = scene(at + 2u).x;
    precise vec3 to_centre = centre - lit.position;
    float distance2 = dot3(to_centre, to_centre);
    precise float sine2 = radius * radius / distance2;
    if (!(sine2 < 1.0f))
        return a; // inside
    precise float cone = sine2 / (1.0f + sqrt(1.0f - sine2)); // 1 - cosine
    precise float below = cone * n.place.x;
    precise float off_axis2 = below * (2.0f - below);
    precise float off_axis = sqrt(off_axis2);
    vec2 circle = unit_circle(n.place.y);
    vec3 d = from_basis(
        vec3(off_axis * circle.x, off_axis * circle.y, 1.0f - below), normalized3(to_centre));
    float cosine = dot3(d, lit.normal);
    if (!(cosine > 0.0f))
        return a;
    // The sphere's surface along d, then outward by the offset.
    precise float half_chord2 = radius * radius - distance2 * off_axis2;
    precise float t = dot3(d, to_centre) - sqrt(half_chord2 > 0.0f ? half_chord2 : 0.0f);
    vec3 normal = normalized3(ray_at(-to_centre, d, t));
    float end_radius = radius + sphere_light_offset(centre, radius);
    precise float per_power = a.radiance_per_power * cosine * 6.28318531f * cone * n.share;
    a.found = lit_from(ray_at(centre, normal, end_radius), per_power, lit);
    return a;
}

float sphere_importance(uint at, float watts, LitPoint lit)
{
    return ball_importance(vec3(scene(at + 1u)), scene(at + 2u).x, watts, lit);
}
