// The bins of a guide to the sky (trace/sky_guide.hpp). Included after core/random.glsl.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint SKY_SIDE = 32u;   // bins of directions by their z, and by their angle about it, of equal solid angles
const uint SKY_BINS = 1024u;
const uint SKY_LOOKS = 256u; // at the sky from a point: each at a random one of four bins next to each other
const uint SKY_DEPTH = 7u;   // of the tree of cells
const uint SKY_CELLS = 128u;

// The bin of look number `look` from point i.
inline uint sky_bin_of_look(uint look, uint i)
{
    return look * (SKY_BINS / SKY_LOOKS) + scrambled(i * SKY_LOOKS + look) % (SKY_BINS / SKY_LOOKS);
}

#endif
