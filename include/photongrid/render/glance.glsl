// Looks along the surface from a point in four directions: where slanted rays (surface_way.glsl) see no wall and no
// edge, the disc is taken for whole, as most are. Edges between two directions are missed in the outer third.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/render/pixel_tile.glsl>

struct Params {
    uint number;      // of the direction
    float min_cosine; // of normals on the same surface (leak_policy)
};
PARAMS(Params)
SWITCH(5, GLASS)
SWITCH(7, AREA_LIGHTS)
INPUT(0, vec4, scene)
INPUT(1, vec4, mesh_places) // these three: see mesh_surface.glsl
INPUT(2, vec4, mesh_normals)
INPUT(3, vec4, mesh_shadings)
INPUT(4, vec4, points)
INPUT(5, vec4, normals)
INPUT(6, vec4, origins)     // see glance_ray.glsl
INPUT(7, vec4, directions)
STATE(0, uint, looked)      // KEPT: the disc is whole so far; SEARCHED: it may end, and is probed

#include <photongrid/trace/intersect.glsl>
#include <photongrid/trace/mesh_hit.glsl>
#include <photongrid/trace/materials.glsl>
#include <photongrid/render/probed_surface.glsl>
#include <photongrid/render/surface_way.glsl>

void kernel(uint i)
{
    if (args.number == 0u)
        looked = KEPT;
    float far = origins(i).w;
    if (!(far > 0.0f))
        return;
    vec3 d = vec3(directions(i));
    Hit hit = intersect_before(vec3(origins(i)), d, far);
    if (MESHES && mesh_is_closer(hit, i))
        hit = mesh_hit(i);
    precise float radius = sqrt(points(i).w);
    if (!(hit.t >= 0.0f) || !is_at_rim(i, hit.position, radius) || !holds_photons(i, hit, d))
        looked = SEARCHED;
}
