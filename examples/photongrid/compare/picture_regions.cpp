#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/picture_regions.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/scene/check.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace photongrid {

namespace {
    constexpr double step_of_edge = 1.5;
    constexpr std::uint32_t edge_reach = 2;
    constexpr double dark_factor = 0.25; // 2 EV

    std::vector<bool> finite_pixels(const image& picture)
    {
        std::vector<bool> all;
        all.reserve(picture.pixels.size());
        for (const auto& p : picture.pixels)
            all.push_back(detail::finite(glm::dvec3(p)));
        return all;
    }

    /// Luminance, of each pixel the median of the 5 x 5 pixels about it: single bright paths are no edges, and a pixel
    /// is not called dark because noise made it so. Beyond its edges the picture continues as at the edge.
    class smooth_luminance {
    public:
        explicit smooth_luminance(const image& picture) : width_(picture.width), height_(picture.height)
        {
            std::vector<double> all;
            all.reserve(picture.pixels.size());
            for (const auto& p : picture.pixels)
                all.push_back(detail::finite(glm::dvec3(p)) ? std::max(luminance_of(p), 0.0) : 0.0);
            medians_.reserve(all.size());
            for (std::uint32_t y = 0; y < height_; ++y)
                for (std::uint32_t x = 0; x < width_; ++x)
                    medians_.push_back(median_about(all, x, y));
        }
        double at(std::uint32_t x, std::uint32_t y) const { return medians_[std::size_t{y} * width_ + x]; }
        /// Sobel's filter on the logarithm: the change from one side of a pixel to the other, as a length.
        double change_at(std::uint32_t x, std::uint32_t y) const
        {
            const auto left = before(x, 1), right = after(x, 1, width_), above = before(y, 1),
                       below = after(y, 1, height_);
            const auto value = [&](auto column, auto row) { return std::log(at(column, row) + relmse_floor); };
            const auto column = [&](auto i) { return (value(i, above) + 2 * value(i, y) + value(i, below)) / 4; };
            const auto row = [&](auto i) { return (value(left, i) + 2 * value(x, i) + value(right, i)) / 4; };
            return std::hypot(column(right) - column(left), row(below) - row(above));
        }

    private:
        static std::uint32_t before(std::uint32_t i, std::uint32_t n) { return i - std::min(i, n); }
        static std::uint32_t after(std::uint32_t i, std::uint32_t n, std::uint32_t size)
        {
            return std::min(i + n, size - 1);
        }
        double median_about(const std::vector<double>& all, std::uint32_t x, std::uint32_t y) const
        {
            constexpr std::uint32_t reach = 2;
            constexpr std::size_t side = 2 * reach + 1;
            std::array<double, side * side> near;
            auto next = near.begin();
            for (std::uint32_t row = 0; row <= 2 * reach; ++row)
                for (std::uint32_t column = 0; column <= 2 * reach; ++column) {
                    const auto v = row < reach ? before(y, reach - row) : after(y, row - reach, height_);
                    const auto u = column < reach ? before(x, reach - column) : after(x, column - reach, width_);
                    *next++ = all[std::size_t{v} * width_ + u];
                }
            const auto middle = near.begin() + near.size() / 2;
            std::nth_element(near.begin(), middle, near.end());
            return *middle;
        }

        std::uint32_t width_, height_;
        std::vector<double> medians_;
    };

    std::vector<bool> pixels_near_steps(const image& picture, const smooth_luminance& luminance)
    {
        const double step = std::log(step_of_edge);
        std::vector<bool> near(picture.pixels.size());
        for (std::uint32_t y = 0; y < picture.height; ++y)
            for (std::uint32_t x = 0; x < picture.width; ++x) {
                if (luminance.change_at(x, y) < step)
                    continue;
                const auto last_x = std::min(x + edge_reach, picture.width - 1),
                           last_y = std::min(y + edge_reach, picture.height - 1);
                for (auto row = y - std::min(y, edge_reach); row <= last_y; ++row)
                    for (auto column = x - std::min(x, edge_reach); column <= last_x; ++column)
                        near[std::size_t{row} * picture.width + column] = true;
            }
        return near;
    }
} // namespace

std::vector<picture_region> regions_of(const image& reference)
{
    const smooth_luminance smooth(reference);
    const auto finite = finite_pixels(reference), near = pixels_near_steps(reference, smooth);
    // Where middle grey lies at the fitting exposure.
    const double middle = 0.18 * std::exp2(-fitting_exposure(reference).value_or(0.0));
    const std::size_t count = reference.pixels.size();
    std::vector<picture_region> regions;
    for (const auto* name : {"edges", "surfaces", "dark", "middle", "bright"})
        regions.push_back({name, std::vector<bool>(count)});
    for (std::size_t i = 0; i < count; ++i) {
        if (!finite[i])
            continue;
        const double luminance = smooth.at(
            static_cast<std::uint32_t>(i % reference.width), static_cast<std::uint32_t>(i / reference.width));
        regions[near[i] ? 0 : 1].pixels[i] = true;
        regions[luminance < middle * dark_factor ? 2 : luminance > middle / dark_factor ? 4 : 3].pixels[i] = true;
    }
    return regions;
}

picture_region region_of(const std::string& name, const image& picture, double level, bool outside)
{
    const auto finite = finite_pixels(picture);
    const std::size_t count = picture.pixels.size();
    double sum = 0, pixels = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (finite[i]) {
            sum += luminance_of(picture.pixels[i]);
            ++pixels;
        }
    const double least = level * sum / pixels;
    picture_region region{name, std::vector<bool>(count)};
    for (std::size_t i = 0; i < count; ++i)
        region.pixels[i] = finite[i] && (luminance_of(picture.pixels[i]) > least) != outside;
    if (std::find(region.pixels.begin(), region.pixels.end(), true) == region.pixels.end())
        throw std::invalid_argument(std::string("no pixel is ") + (outside ? "at or below " : "above ")
            + std::to_string(level) + " of the picture's mean luminance, so the region is empty");
    return region;
}

} // namespace photongrid
