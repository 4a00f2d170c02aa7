// A program that has a Vulkan device already: photongrid works on it, takes over its buffers and hands over its own,
// and the validation layer, synchronization included, has nothing to say.
#include "vulkan_caller_tests.hpp"
