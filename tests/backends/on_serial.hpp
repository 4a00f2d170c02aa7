// The serial backend under test.
#pragma once

#include "serial_algorithms.hpp"

#include <memory>

namespace photongrid::testing {

struct serial_tag {
    using type = serial_backend;
    static constexpr const char* name = "serial";
    static std::unique_ptr<type> make() { return std::make_unique<type>(); }
};

} // namespace photongrid::testing
