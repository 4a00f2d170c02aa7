// Undefines the macros of the kernel dialect (core/begin.hpp) and restores the caller's.
#undef PHOTONGRID_INSIDE_KERNEL_STRUCT
#undef PARAMS
#pragma pop_macro("PARAMS")
#undef PHOTONGRID_ELEMENT
#undef INPUT
#pragma pop_macro("INPUT")
#undef PHOTONGRID_VARIABLE
#undef OUTPUT
#pragma pop_macro("OUTPUT")
#undef STATE
#pragma pop_macro("STATE")
#undef SWITCH
#pragma pop_macro("SWITCH")
#undef GROUP_LANES
#pragma pop_macro("GROUP_LANES")
#undef EACH_LANE
#pragma pop_macro("EACH_LANE")
#undef LANE_VARIABLE
#pragma pop_macro("LANE_VARIABLE")
#undef IN_GROUPS
#pragma pop_macro("IN_GROUPS")
#undef VISIT
#pragma pop_macro("VISIT")
#undef PHOTON_OF
#pragma pop_macro("PHOTON_OF")
#undef EACH_PHOTON
#pragma pop_macro("EACH_PHOTON")
#undef precise
#pragma pop_macro("precise")
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#include <photongrid/core/exact_end.hpp>
