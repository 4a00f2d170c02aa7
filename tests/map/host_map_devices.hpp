// On which backends maps for hosts are tested: those that search for one point at a time on the host's memory.
#pragma once

#include <host_backends.hpp>

#include <gtest/gtest.h>

#include <concepts>

namespace photongrid::testing {

/// A backend, on three threads if it has threads.
template <class B>
B make_device()
{
    if constexpr (std::constructible_from<B, unsigned>)
        return B(3u);
    else
        return B();
}

using map_devices = host_backends<::testing::Types>;

template <class B>
class host_maps : public ::testing::Test {
protected:
    B device_ = make_device<B>();
};
TYPED_TEST_SUITE(host_maps, map_devices);

} // namespace photongrid::testing
