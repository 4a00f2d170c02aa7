// Follows paths of a final gather (gathered_paths.hpp) past the diffuse surfaces where their rays ended. Where paths
// may end, one that a surface leaves the share p of its light ends with the probability 1 - p, and those that go on
// stand for it (Russian roulette: Arvo and Kirk, Particle Transport and Image Synthesis, 1990).
#include <photongrid/core/vector.glsl>
#include <photongrid/core/random.glsl>

struct Params {
    uint may_end;     // 1: paths may end
    uint number;      // of the path among those of its point
    uint nth;         // of the ray in its path
    uint first_pixel; // pixel of element 0
    uint seed;
};
PARAMS(Params)
INPUT(0, vec4, throughputs) // of the ray, with the reflectance of the surface at its end
STATE(0, vec4, end)         // of the ray; w > 0: on a diffuse surface, and the path goes on
STATE(1, vec4, weight)      // rgb: of the light there among that of the eye ray's end

void kernel(uint i)
{
    if (!(end.w > 0.0f))
        return;
    vec4 t = throughputs(i);
    float scale = 1.0f;
    if (args.may_end != 0u) {
        float share = largest3(vec3(t));
        if (!(random4(uvec4(i + args.first_pixel, args.number, 6000u + args.nth, args.seed)).x < share)) {
            end.w = -1.0f;
            return;
        }
        precise float of_those_left = share < 1.0f ? 1.0f / share : 1.0f;
        scale = of_those_left;
    }
    precise vec4 weighted = vec4(weight.x * t.x * scale, weight.y * t.y * scale, weight.z * t.z * scale, 0.0f);
    weight = weighted;
}
