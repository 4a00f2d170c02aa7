// The destination of draw i where each photon's bucket is known (hashed_route.hpp). A bucket keeps the photons that
// arrive first. The draws are as random as their hash, so that these are a uniform sample of all that arrive.
#include <photongrid/core/random.glsl>

struct Params {
    uint photons;
    uint seed;
};
PARAMS(Params)
INPUT(0, uint, buckets) // NONE: no destination
INPUT(1, vec4, powers)
OUTPUT(0, uint, destination)
OUTPUT(1, uint, payload)
OUTPUT(2, vec4, power) // rgb, W; w: 1, which counts the photons

void kernel(uint i)
{
    payload = shuffled(i, args.photons, args.seed);
    destination = buckets(payload);
    vec4 carried = powers(payload);
    power = vec4(carried.x, carried.y, carried.z, 1.0f);
}
