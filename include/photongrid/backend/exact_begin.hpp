// Arithmetic as it is written: from here to backend/exact_end.hpp the compiler does not contract a * b + c to one
// rounding. g++ and clang do so by default where the machine has such an instruction (-march=native, -mfma, and AArch64
// always), and results would then differ in the last bit from those of other backends. The host's own code keeps what
// the host has chosen: no flag of photongrid's reaches it.
//
// Who compiles a file with -ffp-contract=off may define PHOTONGRID_CONTRACTION_IS_OFF for it: the pragmas are then not
// needed, and g++ optimizes a little better without them. photongrid's compiled components do.
//
// No include guard: every header that computes includes it after its other headers. g++ inlines a function that it
// compiled this way only into others of this kind, so what calls kernels lies between the two as well.
#if defined(__FAST_MATH__)
#error "photongrid: -ffast-math changes results; compile this file without it, or link photongrid::cpu_compiled"
#endif
#if defined(PHOTONGRID_CONTRACTION_IS_OFF)
#elif defined(__clang__)
#pragma float_control(push)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif
