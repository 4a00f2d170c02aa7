#include <photongrid/compare/image_difference.hpp>
#include <photongrid/compare/structural_similarity.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace photongrid {

namespace {
    using plane = std::vector<double>;

    /// The luma of Rec. 601, from 0 to 255.
    plane luma_of(const image& picture, const tone_map& shown)
    {
        plane luma;
        luma.reserve(picture.pixels.size());
        for (const auto& p : picture.pixels)
            luma.push_back(0.299 * shown(p.x) + 0.587 * shown(p.y) + 0.114 * shown(p.z));
        return luma;
    }

    /// Averages along one axis, on which neighbours are `stride` apart, with a Gaussian window that the ends cut.
    plane averaged(
        const plane& from, std::size_t lines, std::size_t between_lines, std::size_t length, std::size_t stride)
    {
        constexpr std::size_t reach = 5;
        std::array<double, reach + 1> weight;
        for (std::size_t i = 0; i <= reach; ++i)
            weight[i] = std::exp(-static_cast<double>(i * i) / (2 * 1.5 * 1.5));
        plane to(from.size());
        for (std::size_t line = 0; line < lines; ++line)
            for (std::size_t at = 0; at < length; ++at) {
                const std::size_t first = at > reach ? at - reach : 0, last = std::min(at + reach, length - 1);
                double sum = 0, weights = 0;
                for (std::size_t i = first; i <= last; ++i) {
                    const double w = weight[i > at ? i - at : at - i];
                    sum += w * from[line * between_lines + i * stride];
                    weights += w;
                }
                to[line * between_lines + at * stride] = sum / weights;
            }
        return to;
    }
    plane averaged(const plane& from, const image& size)
    {
        const std::size_t w = size.width, h = size.height;
        return averaged(averaged(from, h, w, w, 1), w, 1, h, w);
    }
    plane products(const plane& a, const plane& b)
    {
        plane all(a.size());
        std::transform(a.begin(), a.end(), b.begin(), all.begin(), std::multiplies<>());
        return all;
    }
} // namespace

double structural_similarity(const image& a, const image& b, double exposure)
{
    detail::require_same_size(a, b);
    const tone_map shown(exposure);
    const auto x = luma_of(a, shown), y = luma_of(b, shown);
    const auto mean_x = averaged(x, a), mean_y = averaged(y, a);
    const auto mean_xx = averaged(products(x, x), a), mean_yy = averaged(products(y, y), a),
               mean_xy = averaged(products(x, y), a);
    constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double mx = mean_x[i], my = mean_y[i];
        const double of_x = std::max(mean_xx[i] - mx * mx, 0.0), of_y = std::max(mean_yy[i] - my * my, 0.0),
                     of_both = mean_xy[i] - mx * my;
        sum += (2 * mx * my + c1) * (2 * of_both + c2) / ((mx * mx + my * my + c1) * (of_x + of_y + c2));
    }
    return sum / static_cast<double>(x.size());
}

} // namespace photongrid
