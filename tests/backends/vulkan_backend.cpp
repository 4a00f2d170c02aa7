// Tests of the Vulkan backend only: that it equals the serial one bit for bit, that the validation layer (core and
// synchronization) has nothing to say, and how it fails. What every backend promises is in algorithm_tests.hpp.
#include "vulkan_algorithm_tests.hpp"
#include "vulkan_buffer_tests.hpp"
#include "vulkan_compile_tests.hpp"
#include "vulkan_device_tests.hpp"
#include "vulkan_group_tests.hpp"
#include "vulkan_pass_tests.hpp"
