#include <photongrid/compare/image_difference.hpp>
#include <photongrid/scene/check.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

namespace photongrid {

image averaged(const image& picture, std::uint32_t n)
{
    if (n == 0 || picture.width < n || picture.height < n)
        throw std::invalid_argument("a picture of " + std::to_string(picture.width) + " x "
            + std::to_string(picture.height) + " pixels has no block of " + std::to_string(n) + " x "
            + std::to_string(n));
    image made{.width = picture.width / n, .height = picture.height / n, .pixels = {}};
    for (std::uint32_t y = 0; y < made.height; ++y)
        for (std::uint32_t x = 0; x < made.width; ++x) {
            glm::dvec3 sum(0);
            for (std::uint32_t row = 0; row < n; ++row)
                for (std::uint32_t column = 0; column < n; ++column)
                    sum += glm::dvec3(
                        picture.pixels[(std::size_t{y} * n + row) * picture.width + std::size_t{x} * n + column]);
            made.pixels.emplace_back(sum / (static_cast<double>(n) * n));
        }
    return made;
}

namespace {
    /// What a channel adds to relMSE.
    double relative_square(double error, double reference)
    {
        return error * error / ((reference + relmse_floor) * (reference + relmse_floor));
    }
} // namespace

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
            d.relmse += relative_square(error, q[c]);
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

double noise_of_two(const image& a, const image& other, const image& b)
{
    detail::require_same_size(a, b);
    detail::require_same_size(other, b);
    double sum = 0;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 p(a.pixels[i]), q(other.pixels[i]), r(b.pixels[i]);
        if (!detail::finite(p) || !detail::finite(q) || !detail::finite(r))
            continue;
        for (int c = 0; c < 3; ++c)
            sum += relative_square(p[c] - q[c], r[c]);
        count += 3;
    }
    return sum / static_cast<double>(count) / 2;
}

} // namespace photongrid
