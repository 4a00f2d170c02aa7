// Ends the region that core/exact_begin.hpp begins.
#if defined(PHOTONGRID_CONTRACTION_IS_OFF)
#elif defined(__clang__)
#pragma float_control(pop)
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif
