// Tests whether a device rounds division and square root correctly: Vulkan and GL allow an error of 2.5 units in the
// last place. If it does, traced photons equal the serial backend's bit for bit (docs/design/design.md).
#pragma once

#include <photongrid/core/arithmetic_probe.kernel.hpp>
#include <photongrid/core/backend.hpp>
#include <photongrid/core/exact_arithmetic.hpp>

#include <cmath>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Runs 65,536 quotients and square roots on `device` and compares them with the host's.
/// Returns {division is exact, square root is exact}.
template <class B>
std::pair<bool, bool> test_arithmetic(B& device)
{
    constexpr uint n = 65536;
    auto result = device.template make<glm::vec4>(n);
    device.template run<kernels::arithmetic_probe>(n, {.seed = 1u}, reads(), writes(result));
    bool division = true, square_root = true;
    for (const auto& r : device.download(result)) {
        division = division && r.x / r.y == r.z;
        square_root = square_root && std::sqrt(r.x) == r.w;
    }
    return {division, square_root};
}

/// Tests the arithmetic of kernels on `device`, as it is or rewritten: rewrite(true) makes kernels take quotients and
/// square roots from exact_arithmetic.glsl, rewrite(false) undoes that. Returns what test_arithmetic() found of the one
/// chosen.
template <class B, class Rewrite>
std::pair<bool, bool> choose_arithmetic(B& device, arithmetic_kind kind, Rewrite rewrite)
{
    constexpr std::pair all_exact(true, true);
    if (kind == arithmetic_kind::rewritten)
        rewrite(true);
    const auto found = test_arithmetic(device);
    if (kind != arithmetic_kind::automatic || found == all_exact)
        return found;
    rewrite(true);
    if (test_arithmetic(device) == all_exact)
        return all_exact;
    rewrite(false); // its fma rounds twice
    return found;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
