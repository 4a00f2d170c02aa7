// The numbers that a path begins with, and the layout of an emission guide (trace/emission_guide.hpp): for each box the
// shares of the boxes up to it, of 2^24, and the weight of its paths; two vectors of its low corner; two of its size.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint EMISSION_NUMBERS = 8u;
const uint VECTORS_PER_EMISSION_BOX = 5u;

#endif
