// The light that photons bring to the ends of eye rays on rough surfaces: radiance, times throughput. The photons near
// a point are a density of power, of which each one's BSDF sends its share to the eye.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>
#include <photongrid/core/natural_exp.glsl>
#include <photongrid/trace/scene_layout.glsl>
#include <photongrid/estimate/search_radius.glsl>

struct Params {
    uint first;        // the eye ray of element 0
    uint k;            // entries of a list
    float share2;      // of the squared distance of the last one, which sets the radius and does not count
    float max_radius2; // the squared radius where a list has fewer entries, m^2
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
INPUT(6, uint, ids)        // lists of the nearest photons
INPUT(7, float, distances2)
INPUT(8, vec4, powers)     // of photons, W, by id
INPUT(9, vec4, arrivals)   // xyz: their directions
OUTPUT(0, vec4, light)     // W/(m^2 sr)

#include <photongrid/trace/materials.glsl>
#include <photongrid/trace/optics.glsl>
#include <photongrid/trace/scatter.glsl>
#include <photongrid/trace/rough_end.glsl>

// The BSDF of a photon that arrives in direction d.
vec3 scattered_to_eye(Surface e, vec3 d)
{
    bool front = !(dot3(d, e.shading) > 0.0f);
    bool geometric_front = !(dot3(d, e.geometric) > 0.0f);
    if (front != geometric_front)
        return vec3(0.0f, 0.0f, 0.0f);
    e.way = front ? BY_REFLECTION : BY_REFRACTION;
    return scatter_eval(e, -d);
}

void kernel(uint i)
{
    uint ray = args.first + i;
    light = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (!ended_on_rough(ray))
        return;
    Surface e = rough_end(ray);
    uint list = i * args.k;
    uint last = list + args.k - 1u;
    bool by_photon = ids(last) != 0xFFFFFFFFu;
    precise float sought2 = by_photon ? distances2(last) * args.share2 : args.max_radius2;
    float least2 = least_disc2(points(ray), 0.0f);
    float radius2 = sought2 > least2 ? sought2 : least2;
    uint past = by_photon && sought2 >= least2 ? last : last + 1u;
    vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    for (uint n = list; n < past; ++n) {
        uint id = ids(n);
        if (id == 0xFFFFFFFFu || !(distances2(n) <= radius2))
            break;
        precise vec3 more = sum + vec3(powers(id)) * scattered_to_eye(e, vec3(arrivals(id)));
        sum = more;
    }
    precise vec3 seen = vec3(throughputs(ray)) * sum / (3.14159265f * radius2);
    if (radius2 < 3.0e38f)
        light = vec4(seen.x, seen.y, seen.z, 0.0f);
}
