// The surface normal at stored photon i, on the side that it hit. bounce_photon.glsl stores it in three w components.
#include <photongrid/core/vector.glsl>
#include <photongrid/trace/photon_event.glsl>

struct Params {
    uint paths;
    uint frames;
    uint stored_before; // photons of earlier batches
    uint kinds;         // of photons that are stored (photon_event.glsl)
};
PARAMS(Params)
INPUT(0, uint, sums) // storable photons of paths 0 to i
INPUT(1, vec4, positions)
INPUT(2, vec4, powers)
INPUT(3, vec4, next_origins)
INPUT(4, vec4, next_directions)
OUTPUT(0, vec4, normal)

#include <photongrid/trace/stored_photon.glsl>
#include <photongrid/trace/inside_code.glsl>

void kernel(uint i)
{
    uint at = stored_photon(i);
    float x = powers(at).w;
    float y = next_origins(at).w;
    normal = vec4(x, y, z_of(x, y, next_directions(at).w), 0.0f);
}
