// The OpenGL backend against the serial one, bit for bit, on every kind of context that this machine has.
#include "../core/wanted_device_tests.hpp"
#include "gl_algorithm_tests.hpp"
#include "gl_buffer_tests.hpp"
#include "gl_context_tests.hpp"
#include "gl_contexts.hpp"
#include "gl_pass_tests.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, ::testing::Types<gl_backend>);

} // namespace photongrid::testing
