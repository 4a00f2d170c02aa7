// Adds the light that rays of a final gather bring: what the surface that each met sends back of the irradiance at the
// photon nearest there. Farther from that photon than the radius of its estimate, the surface is darker: there the
// light falls as the density of photons does, with the square of the distance.
//
// A ray that ends closer to its start than that radius, as in a corner, sees the estimate's blur. Such near ends are
// left for a gather of their own, as points with w > 0.
#include <photongrid/core/vector.glsl>
#include <photongrid/core/none.glsl>

struct Params {
    float share;       // 1 / rays per point
    uint first;        // element of `starts` of ray 0
    uint leaves_near;  // 1: near ends are left
};
PARAMS(Params)
INPUT(0, vec4, starts)       // xyz, m
INPUT(1, vec4, directions)   // w: surfaces that the ray passed
INPUT(2, vec4, throughputs)  // with the reflectance of the surface at the end
INPUT(3, uint, nearest)      // id of the photon nearest to the end
INPUT(4, float, distances2)  // of that photon, m^2
INPUT(5, vec4, irradiances)  // by photon id: rgb: W/m^2; w: squared radius of its estimate, m^2
STATE(0, vec4, end)          // of the ray; w > 0: on a diffuse surface
STATE(1, vec4, weight)       // rgb: of the light at the start among that of the eye ray's end
STATE(2, vec4, gathered)     // irradiance at the eye ray's end, W/m^2

void kernel(uint i)
{
    vec4 e = end;
    if (!(e.w > 0.0f))
        return;
    vec4 t = throughputs(i);
    precise vec4 weighted = vec4(weight.x * t.x, weight.y * t.y, weight.z * t.z, 0.0f);
    weight = weighted;
    uint id = nearest(i);
    end.w = -1.0f;
    if (id == NONE)
        return;
    vec4 found = irradiances(id);
    precise vec3 way = vec3(e) - vec3(starts(args.first + i));
    if (args.leaves_near != 0u && directions(i).w == 0.0f && dot3(way, way) < found.w) {
        end.w = 1.0f;
        return;
    }
    float distance2 = distances2(i);
    float share = args.share;
    if (distance2 > found.w) {
        precise float thinned = args.share * (found.w / distance2);
        share = thinned;
    }
    precise vec4 sum = vec4(gathered.x + weighted.x * found.x * share, gathered.y + weighted.y * found.y * share,
        gathered.z + weighted.z * found.z * share, 0.0f);
    gathered = sum;
}
