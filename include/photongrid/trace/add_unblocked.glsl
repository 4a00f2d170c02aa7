// Adds the light of the samples whose shadow rays (shadow_ray.glsl) no mesh blocks. Irradiance, W/m^2.
#include <photongrid/trace/ray_state.glsl>

struct Params {
    uint first; // the eye ray of shadow ray 0
};
PARAMS(Params)
SWITCH(9, MESHES)
INPUT(0, vec4, arriving)   // rgb: irradiance of the sample if no mesh blocks it, W/m^2
INPUT(1, uvec4, mesh_hits) // with MESHES: of the shadow rays; see ray_state.glsl
STATE(0, vec4, irradiance)

void kernel(uint i)
{
    if (MESHES && triangle_of(mesh_hits(i - args.first)) != NO_TRIANGLE)
        return;
    precise vec3 more = vec3(irradiance) + vec3(arriving(i - args.first));
    irradiance = vec4(more.x, more.y, more.z, irradiance.w);
}
