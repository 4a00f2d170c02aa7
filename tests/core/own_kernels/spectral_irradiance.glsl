// Irradiance in n bands, W/m^2 each, four to an element: element i is bands 4 g to 4 g + 3 of point p, i = p * groups + g. The
// photon that sets the radius is left out of the sum.
#include "disc.glsl"
#include <photongrid/core/vector.glsl>

struct Params {
    uint k;
    uint groups; // of four bands
};
PARAMS(Params)
INPUT(0, uint, ids)
INPUT(1, float, distances2)
INPUT(2, vec4, spectra) // power of photon f in group g: element f * groups + g, W
OUTPUT(0, vec4, irradiance)

void kernel(uint i)
{
    uint point = i / args.groups;
    uint group = i - point * args.groups;
    vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    for (uint entry = point * args.k; entry + 1u < (point + 1u) * args.k; ++entry) {
        precise vec4 more = sum + spectra(ids(entry) * args.groups + group);
        sum = more;
    }
    precise vec4 density = sum / disc_area(distances2((point + 1u) * args.k - 1u));
    irradiance = density;
}
