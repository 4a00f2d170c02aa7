// From here to core/exact_end.hpp the compiler does not contract a * b + c to a fused multiply-add. By default g++
// and clang do, if the machine has the instruction (-march=native, -mfma, and always on AArch64); results would then
// differ in the last bit from those of other backends. The host's own code is not affected.
//
// A file that is compiled with -ffp-contract=off may define PHOTONGRID_CONTRACTION_IS_OFF: it does not need the
// pragmas, and g++ optimizes slightly better without them. photongrid's compiled components do this.
//
// No include guard: every header with arithmetic includes this file after its other headers. g++ inlines a function
// with this option only into functions with the same option, so code that calls kernels belongs between the two files
// too.
//
// -ffast-math and its parts are refused: g++ has a macro for each. clang has only those of -ffast-math and
// -ffinite-math-only: do not give it -funsafe-math-optimizations or parts of that.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)                              \
    || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "photongrid: -ffast-math and its parts change results; compile without them"
#endif
#if defined(PHOTONGRID_CONTRACTION_IS_OFF)
#elif defined(__clang__)
#pragma float_control(push)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif
