// Takes the dialect of kernels/begin.hpp back, so that no word of it reaches a user's code.
#undef PHOTONGRID_SHARED_IS_READ
#undef PARAMS
#undef INPUT
#undef PHOTONGRID_VARIABLE
#undef OUTPUT
#undef STATE
#undef SWITCH
#undef GROUP_LANES
#undef EACH_LANE
#undef IN_GROUPS
#undef PHOTON_OF
#undef EACH_PHOTON
#undef precise
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
