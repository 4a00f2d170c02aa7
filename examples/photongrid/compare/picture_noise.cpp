#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_noise.hpp>
#include <photongrid/scene/check.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace photongrid {

namespace {
    constexpr std::uint32_t tile_size = 16;
    constexpr double median_of_gaussian = 0.674489750196082; // of the sizes of numbers with variance 1

    /// How much pixel x, y stands out from its neighbours, as a share of their mean: of noise of relative variance v, a
    /// number of variance v.
    glm::dvec3 relative_detail(const image& p, std::uint32_t x, std::uint32_t y)
    {
        constexpr int mask[3][3] = {{1, -2, 1}, {-2, 4, -2}, {1, -2, 1}};
        glm::dvec3 detail(0), sum(0);
        for (std::uint32_t row = 0; row < 3; ++row)
            for (std::uint32_t column = 0; column < 3; ++column) {
                const glm::dvec3 pixel(p.pixels[std::size_t{y + row - 1} * p.width + (x + column - 1)]);
                detail += static_cast<double>(mask[row][column]) * pixel;
                sum += pixel;
            }
        return detail / 6.0 / (sum / 9.0 + relmse_floor);
    }
} // namespace

double picture_noise(const image& p)
{
    double sum = 0;
    std::size_t count = 0;
    std::vector<double> sizes[3];
    for (std::uint32_t top = 1; top + 1 < p.height; top += tile_size)
        for (std::uint32_t left = 1; left + 1 < p.width; left += tile_size) {
            for (auto& s : sizes)
                s.clear();
            for (std::uint32_t y = top; y < std::min(top + tile_size, p.height - 1); ++y)
                for (std::uint32_t x = left; x < std::min(left + tile_size, p.width - 1); ++x)
                    if (const auto d = relative_detail(p, x, y); detail::finite(d))
                        for (int c = 0; c < 3; ++c)
                            sizes[c].push_back(std::abs(d[c]));
            for (auto& s : sizes)
                if (!s.empty()) {
                    const auto middle = s.begin() + static_cast<std::ptrdiff_t>(s.size() / 2);
                    std::nth_element(s.begin(), middle, s.end());
                    sum += (*middle / median_of_gaussian) * (*middle / median_of_gaussian);
                    ++count;
                }
        }
    return sum / static_cast<double>(count); // NaN for none
}

} // namespace photongrid
