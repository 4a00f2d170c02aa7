// Light that a device computed, compared with the serial backend's.
#pragma once

#include <photongrid/core/arithmetic_probe.kernel.hpp>
#include <photongrid/core/backend.hpp>

#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace photongrid::testing {

/// Sums of up to `terms` quotients: equal bit for bit where the device's division rounds correctly. Elsewhere each
/// quotient may be off by 2.5 units in the last place (Vulkan 1.1, appendix "Precision and Operation of SPIR-V
/// Instructions"), and each addition rounds once.
inline void expect_same_light(const capabilities& device, const std::vector<glm::vec4>& light,
    const std::vector<glm::vec4>& serial_light, unsigned terms, const std::string& what)
{
    ASSERT_EQ(light.size(), serial_light.size()) << what;
    const float tolerance = static_cast<float>(terms + 8u) * 0x1p-24f;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (std::memcmp(&light[i], &serial_light[i], sizeof(glm::vec4)) == 0)
            continue;
        ASSERT_FALSE(device.exact_division) << what << ": element " << i << " has other bits";
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(light[i][c], serial_light[i][c], tolerance * std::abs(serial_light[i][c]))
                << what << ": element " << i;
    }
}

/// That quotients and square roots on `device`, rewritten or not, are off by 2.5 units in the last place at most.
template <backend B>
void expect_good_arithmetic(B& device)
{
    constexpr unsigned n = 65536;
    auto result = device.template make<glm::vec4>(n);
    device.template run<kernels::arithmetic_probe>(n, {.seed = 5u}, reads(), writes(result));
    for (const auto& r : device.download(result)) {
        ASSERT_NEAR(r.z, r.x / r.y, 2.5f * 0x1p-23f * r.z) << r.x << " / " << r.y;
        ASSERT_NEAR(r.w, std::sqrt(r.x), 2.5f * 0x1p-23f * r.w) << "square root of " << r.x;
    }
}

} // namespace photongrid::testing
