// Adds the light of the samples whose shadow rays (shadow_ray.glsl) no mesh blocks. Irradiance, W/m^2.
#include <photongrid/trace/ray_state.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint light; // number of the light
    uint first; // the eye ray of shadow ray 0
};
PARAMS(Params)
INPUT(0, vec4, scene)
INPUT(1, vec4, directions) // w: irradiance divided by the power, m^-2
INPUT(2, uvec4, mesh_hits) // of the shadow rays; see ray_state.glsl
STATE(0, vec4, irradiance)

#include <photongrid/trace/lights.glsl>

void kernel(uint i)
{
    float per_power = directions(i - args.first).w;
    if (!(per_power > 0.0f) || triangle_of(mesh_hits(i - args.first)) != NO_TRIANGLE)
        return;
    precise vec3 more = vec3(irradiance) + light_of(args.light).power * per_power;
    irradiance = vec4(more.x, more.y, more.z, 0.0f);
}
