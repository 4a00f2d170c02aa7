// For programs that take whatever device there is: where hardware was asked for (tests/run.sh --device hardware), they
// must not pass on a software one.
#pragma once

#include "under_test.hpp"

namespace photongrid::testing {

template <class B>
class wanted_device : public ::testing::Test {
};
TYPED_TEST_SUITE_P(wanted_device);

TYPED_TEST_P(wanted_device, is_hardware_if_asked_for)
{
    if (!hardware_wanted())
        return;
    try {
        const auto caps = TypeParam().caps();
        EXPECT_TRUE(!caps.software || caps.backend == "serial" || caps.backend == "cpu")
            << "hardware was asked for, but this device is software: " << caps.device;
    } catch (const backend_error& e) {
        FAIL() << e.what();
    }
}

REGISTER_TYPED_TEST_SUITE_P(wanted_device, is_hardware_if_asked_for);

} // namespace photongrid::testing
