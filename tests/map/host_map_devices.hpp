// On which backends maps for hosts are tested: serial, and cpu where CMakeLists.txt has linked it.
#pragma once

#include "../backends/serial_pictures.hpp"
#if __has_include(<photongrid/backends/cpu/cpu.hpp>)
#include "../backends/cpu_algorithms.hpp"
#endif

#include <gtest/gtest.h>

namespace photongrid::testing {

template <class B>
B make_device()
{
    return B();
}

#if __has_include(<photongrid/backends/cpu/cpu.hpp>)
template <>
inline cpu_backend make_device<cpu_backend>()
{
    return cpu_backend(3);
}
using map_devices = ::testing::Types<serial_backend, cpu_backend>;
#else
using map_devices = ::testing::Types<serial_backend>;
#endif

} // namespace photongrid::testing
