// Copies stored photon i from the frames: a gather, because fragment programs cannot scatter.
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
INPUT(3, vec4, directions)
OUTPUT(0, vec4, position) // w: 1 for a caustic photon, 0 for one that hit a diffuse surface
OUTPUT(1, vec4, power)
OUTPUT(2, vec4, direction)

#include <photongrid/trace/stored_photon.glsl>

void kernel(uint i)
{
    uint found = stored_photon(i);
    vec4 p = positions(found);
    position = vec4(p.x, p.y, p.z, event_before(p) == SPECULAR_BEFORE ? 1.0f : 0.0f);
    power = powers(found);
    direction = directions(found);
}
