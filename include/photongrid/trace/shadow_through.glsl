// Takes shadow rays (shadow_ray.glsl) through surfaces that are clear in part, from one hit on a mesh to the next: what
// arrives falls by the share of light that each surface stops.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/scene_layout.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
SWITCH(17, ROUGH)
INPUT(0, vec4, scene)
INPUT(1, vec4, directions)  // xyz: unit vector
INPUT(2, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(3, vec4, mesh_normals)
INPUT(4, vec4, mesh_shadings)
INPUT(5, vec4, mesh_colors) // see mesh_color.glsl
STATE(0, vec4, origin)      // xyz, m; w: length, m; 0 at the end
STATE(1, vec4, arriving)    // rgb: irradiance if nothing else blocks the ray, W/m^2

#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/mixture.glsl>
#include <photongrid/trace/met_surface.glsl>

bool done()
{
    return !(origin.w > 0.0f);
}

void kernel(uint i)
{
    if (mesh_places(i).w < 0.0f) { // nothing
        origin.w = 0.0f;
        return;
    }
    Hit hit = mesh_hit(i);
    float passes = 0.0f;
    if (hit.material != NO_MATERIAL) {
        precise float clear = 1.0f - opacity_at(hit.material, true, i);
        passes = clear;
    }
    precise vec3 left = vec3(arriving) * passes;
    arriving = vec4(left.x, left.y, left.z, arriving.w);
    vec3 d = vec3(directions(i));
    float side = dot3(hit.normal, d) > 0.0f ? 1.0f : -1.0f;
    vec3 beyond = ray_at(hit.position, hit.normal, side * ray_offset(hit.position, scene(SCENE_SIZES).x));
    precise float rest = origin.w - dot3(beyond - vec3(origin), d);
    origin = vec4(beyond.x, beyond.y, beyond.z, passes > 0.0f && rest > 0.0f ? rest : 0.0f);
}
