// The power of the i-th photon that a bucket kept, with what it stands for (redistribute_power.glsl).
#include <photongrid/map/redistributed.glsl>

struct Params {
    uint unused;
};
PARAMS(Params)
INPUT(0, uint, list)    // photons that were kept
INPUT(1, uint, buckets) // per photon
INPUT(2, vec4, powers)
INPUT(3, vec4, scales)    // per bucket
INPUT(4, vec4, surpluses) // per bucket
OUTPUT(0, vec4, power)

void kernel(uint i)
{
    uint photon = list(i);
    uint bucket = buckets(photon);
    power = redistributed(powers(photon), scales(bucket), surpluses(bucket));
}
