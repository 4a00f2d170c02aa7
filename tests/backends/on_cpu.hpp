// The cpu backend under test, on three threads whatever the machine has.
#pragma once

#include "cpu_algorithms.hpp"

#include <memory>

namespace photongrid::testing {

struct cpu_tag {
    using type = cpu_backend;
    static constexpr const char* name = "cpu";
    /// It sorts by digits, in fewer passes than the network's, and adds up photons in another order than the kernels.
    static constexpr bool sorts_by_network = false, adds_as_serial = false;
    static constexpr unsigned peak_bytes_per_photon = 52 + 32 + 44; // two attributes twice, and what it sorts by
    static std::unique_ptr<type> make() { return std::make_unique<type>(3u); }
};

} // namespace photongrid::testing
