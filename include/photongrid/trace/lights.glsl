// The table of lights: what each kind emits, how points are lit by it, and how much to expect of it. Included by
// kernels after the INPUTs of trace/lights/mesh_light.glsl, trace/environment.glsl and
// trace/lights/environment_light.glsl.
#include <photongrid/trace/light_record.glsl>
#include <photongrid/trace/lit_point.glsl>
#include <photongrid/trace/environment.glsl>
#include <photongrid/trace/lights/point_light.glsl>
#include <photongrid/trace/lights/rectangle_light.glsl>
#include <photongrid/trace/lights/sphere_light.glsl>
#include <photongrid/trace/lights/mesh_light.glsl>
#include <photongrid/trace/lights/spot_light.glsl>
#include <photongrid/trace/lights/distant_light.glsl>
#include <photongrid/trace/lights/directional_light.glsl>
#include <photongrid/trace/lights/environment_light.glsl>

// A photon of the light whose records are at `at`, for random numbers r and s; s.x has already chosen the light. The
// default has the light's power; each kind sets origin and direction.
Emitted emitted_photon(uint at, vec4 r, vec4 s)
{
    uint kind = kind_of_light(at);
    float probability = light_probability(at);
    vec3 whole = light_power(at);
    Emitted e;
    e.origin = vec3(0.0f, 0.0f, 0.0f);
    e.direction = vec3(0.0f, 0.0f, 1.0f);
    e.power = vec3(whole.x / probability, whole.y / probability, whole.z / probability);
    if (POINT_LIGHTS && kind == POINT_LIGHT)
        return point_emit(at, e, r);
    if (AREA_LIGHTS && kind == RECTANGLE_LIGHT)
        return rectangle_emit(at, e, r);
    if (SPHERE_LIGHTS && kind == SPHERE_LIGHT)
        return sphere_emit(at, e, r);
    if (MESH_LIGHTS && kind == MESH_LIGHT)
        return mesh_emit(at, e, r, s);
    if (SPOT_LIGHTS && kind == SPOT_LIGHT)
        return spot_emit(at, e, r, s);
    if (DIRECTIONAL_LIGHTS && kind == DIRECTIONAL_LIGHT)
        return directional_emit(at, e, r);
    if (ENVIRONMENT_LIGHTS && kind == ENVIRONMENT_LIGHT)
        return environment_emit(at, e, r, s, probability);
    return e;
}

// A sample of any light but a point or a rectangle, of which trace/light_sample.glsl takes several. The default is no
// light.
ArrivingLight arriving_light(uint at, SampleNumbers n, LitPoint lit)
{
    uint kind = kind_of_light(at);
    ArrivingLight a;
    a.found = no_light(lit);
    a.power = light_power(at);
    a.radiance_per_power = 0.0f;
    a.is_rectangle = false;
    if (SPHERE_LIGHTS && kind == SPHERE_LIGHT)
        return sphere_sample(at, a, n, lit);
    if (MESH_LIGHTS && kind == MESH_LIGHT)
        return mesh_sample(at, a, n, lit);
    if (SPOT_LIGHTS && kind == SPOT_LIGHT)
        return spot_sample(at, a, lit);
    if (DIRECTIONAL_LIGHTS && kind == DIRECTIONAL_LIGHT)
        return directional_sample(at, a, lit);
    if (ENVIRONMENT_LIGHTS && kind == ENVIRONMENT_LIGHT)
        return environment_arriving(at, a, n, lit);
    return a;
}

// The estimate of a light's irradiance without shadows: 0 only where it gives none.
float light_importance(uint at, LitPoint lit)
{
    uint kind = kind_of_light(at);
    vec3 whole = light_power(at);
    precise float watts = whole.x + whole.y + whole.z;
    if (AREA_LIGHTS && kind == RECTANGLE_LIGHT)
        return rectangle_importance(at, watts, lit);
    if (SPHERE_LIGHTS && kind == SPHERE_LIGHT)
        return sphere_importance(at, watts, lit);
    if (MESH_LIGHTS && kind == MESH_LIGHT)
        return mesh_importance(at, watts, lit);
    if (SPOT_LIGHTS && kind == SPOT_LIGHT)
        return spot_importance(at, watts, lit);
    if (DIRECTIONAL_LIGHTS && kind == DIRECTIONAL_LIGHT)
        return directional_importance(at, watts, lit);
    if (ENVIRONMENT_LIGHTS && kind == ENVIRONMENT_LIGHT)
        return environment_importance(at, watts);
    return point_importance(at, watts, lit);
}
