// A program that has a Vulkan device already: photongrid works on it, takes over its buffers and hands over its own,
// and the validation layer, synchronization included, has nothing to say.
#include "../core/wanted_device_tests.hpp"
#include "vulkan_barrier_tests.hpp"
#include "vulkan_caller_tests.hpp"

namespace photongrid::testing {

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, ::testing::Types<vulkan_backend>);

} // namespace photongrid::testing
