// Pictures that differ.
#pragma once

#include <photongrid/render/image.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace photongrid {
namespace {

    /// A smooth picture with noise of this strength, and none of it below 0.
    [[maybe_unused]] image random_picture(int width, int height, float strength, unsigned seed)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> u(-1, 1);
        image picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const float smooth = 0.3f + 0.2f * std::sin(0.2f * static_cast<float>(x + 2 * y));
                glm::vec3 p(smooth, smooth, 0.5f * smooth);
                for (int c = 0; c < 3; ++c)
                    p[c] = std::max(p[c] + strength * u(random), 0.0f);
                picture.pixels.push_back(p);
            }
        return picture;
    }

} // namespace
} // namespace photongrid
