// What rough surfaces send to the eye of the light of a sample (shadow_ray.glsl): radiance, times throughput. Rays
// that leave the surface may hit the light too, so that samples of lights with a size have the weights of the balance
// heuristic (Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, section 9.2).
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint first;             // the eye ray of element 0
    uint only_without_size; // 1: lights with a size are left to rays
};
PARAMS(Params)
SWITCH(4, MIRRORS)
SWITCH(5, GLASS)
INPUT(0, vec4, scene)
INPUT(1, vec4, points)
INPUT(2, vec4, directions)
INPUT(3, vec4, throughputs)
INPUT(4, vec4, surfaces)
INPUT(5, vec4, emissions)
INPUT(6, vec4, ways)       // xyz: unit vector towards the light
STATE(0, vec4, arriving)   // rgb: in irradiance, W/m^2, out radiance, W/(m^2 sr); w: see shadow_ray.glsl

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/rough_end.glsl>

void kernel(uint i)
{
    uint ray = args.first + i;
    vec4 light = arriving;
    arriving = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    bool has_size = light.w > 0.0f;
    if (!ended_on_rough(ray) || (has_size && args.only_without_size != 0u))
        return;
    Surface e = rough_end(ray);
    vec3 towards = vec3(ways(i));
    bool front = dot3(towards, e.shading) > 0.0f;
    bool geometric_front = dot3(towards, e.geometric) > 0.0f;
    if (front != geometric_front)
        return;
    e.way = front ? BY_REFLECTION : BY_REFRACTION;
    Scattering s = scattering(e, towards);
    vec3 share = s.bsdf;
    if (has_size) {
        precise vec3 weighted = s.bsdf * (light.w / (light.w + s.density));
        share = weighted;
    }
    precise vec3 seen = vec3(throughputs(ray)) * vec3(light) * share;
    if (largest3(share) > 0.0f)
        arriving = vec4(seen.x, seen.y, seen.z, 0.0f);
}
