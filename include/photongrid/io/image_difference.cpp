#include <photongrid/io/image_difference.hpp>
#include <photongrid/scene/check.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

namespace photongrid {

void detail::require_same_size(const image& a, const image& b)
{
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("the sizes differ: " + std::to_string(a.width) + " x " + std::to_string(a.height)
            + " and " + std::to_string(b.width) + " x " + std::to_string(b.height));
}

image_difference compare_images(const image& a, const image& b)
{
    detail::require_same_size(a, b);
    image_difference d;
    d.largest = -1;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 p(a.pixels[i]), q(b.pixels[i]);
        if (!detail::finite(p) || !detail::finite(q)) {
            ++d.not_finite;
            continue;
        }
        ++d.compared;
        for (int c = 0; c < 3; ++c) {
            const double error = p[c] - q[c];
            d.mse += error * error;
            d.relmse += error * error / ((q[c] + 0.01) * (q[c] + 0.01));
            if (std::abs(error) > d.largest) {
                d.largest = std::abs(error);
                d.x = static_cast<std::uint32_t>(i % a.width);
                d.y = static_cast<std::uint32_t>(i / a.width);
            }
        }
    }
    const double values = 3.0 * static_cast<double>(d.compared);
    d.mse /= values; // NaN where nothing could be compared
    d.relmse /= values;
    return d;
}

} // namespace photongrid
