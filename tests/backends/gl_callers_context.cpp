// The OpenGL backend in a context of the caller's, made here by hand: all state of OpenGL 4.5 core is as it was after
// every call, whatever it was, and results equal the serial backend's. Buffers as the caller's textures, and back.
#include "../core/wanted_device_tests.hpp"
#include "gl_barrier_tests.hpp"
#include "gl_caller_state_tests.hpp"
#include "gl_caller_texture_tests.hpp"
#include "gl_garbage_tests.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, ::testing::Types<gl_backend>);

} // namespace photongrid::testing
