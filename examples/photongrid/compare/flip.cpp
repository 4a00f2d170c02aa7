// The steps and their constants are those of the paper, sections 4.1 (colour) and 4.2 (features).
#include <photongrid/compare/flip.hpp>
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/io/tone_map.hpp>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace photongrid {

namespace {
    using values_of_pixels = std::vector<double>;

    struct picture_size {
        std::size_t width, height;
    };

    // --- Colours ---

    /// CIE XYZ of linear sRGB (IEC 61966-2-1).
    glm::dmat3 xyz_from_rgb()
    {
        return glm::transpose(glm::dmat3(
            0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687, 0.0721923, 0.0193308, 0.1191948, 0.9505322));
    }
    glm::dvec3 screen_white() { return xyz_from_rgb() * glm::dvec3(1); }

    /// From values relative to white: L*a*b* without its cube roots is YCxCz, a linear space of opponent colours.
    glm::dvec3 opponent(const glm::dvec3& relative)
    {
        return {116 * relative.y - 16, 500 * (relative.x - relative.y), 200 * (relative.y - relative.z)};
    }
    glm::dvec3 linear_from_opponent(const glm::dvec3& c)
    {
        static const auto rgb_from_xyz = glm::inverse(xyz_from_rgb());
        static const auto white = screen_white();
        const double y = (c.x + 16) / 116;
        return rgb_from_xyz * (white * glm::dvec3(y + c.y / 500, y, y - c.z / 200));
    }
    glm::dvec3 relative_to_white(const glm::dvec3& linear)
    {
        static const auto from_rgb = xyz_from_rgb();
        static const auto white = screen_white();
        return from_rgb * linear / white;
    }

    /// L*a*b* with less colour where it is dark (Hunt's effect).
    glm::dvec3 hunt_adjusted(const glm::dvec3& linear)
    {
        const auto lab = detail::cielab(linear);
        return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
    }

    /// The difference of two such colours by HyAB, to the power of 0.7: lightness and colour are added up. Less than
    /// 10^-4 counts as none: it may be rounding, and where an edge appears any difference would become visible.
    double color_distance(const glm::dvec3& p, const glm::dvec3& q)
    {
        const double apart = std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z);
        return apart < 1e-4 ? 0 : std::pow(apart, 0.7);
    }

    /// The distance as a part of the largest, between green and blue. The lower two fifths take 95 % of the scale.
    double color_difference(const glm::dvec3& p, const glm::dvec3& q)
    {
        static const double largest = color_distance(hunt_adjusted({0, 1, 0}), hunt_adjusted({0, 0, 1}));
        const double bend = 0.4 * largest, distance = color_distance(p, q);
        return distance < bend ? 0.95 * distance / bend : 0.95 + 0.05 * (distance - bend) / (largest - bend);
    }

    // --- Filters ---

    /// Weights of a pixel's neighbours along an axis, from -radius to radius.
    using neighbour_weights = std::vector<double>;

    template <class Weight>
    neighbour_weights weights_of(double radius, Weight weight)
    {
        neighbour_weights all;
        for (double at = -std::ceil(radius); at <= std::ceil(radius); ++at)
            all.push_back(weight(at));
        return all;
    }

    /// Divides by factors that make the sum of positive weights 1, and that of negative ones -1.
    neighbour_weights normalized(neighbour_weights all)
    {
        double above = 0, below = 0;
        for (const double w : all)
            (w > 0 ? above : below) += std::abs(w);
        for (double& w : all)
            w /= w > 0 ? above : below > 0 ? below : 1;
        return all;
    }

    /// The sums over each pixel's neighbours in its row. What lies beyond an end is as the end.
    values_of_pixels across(const values_of_pixels& from, picture_size size, const neighbour_weights& weights)
    {
        const std::size_t radius = weights.size() / 2;
        values_of_pixels to(from.size());
        std::vector<double> padded(size.width + 2 * radius);
        for (std::size_t y = 0; y < size.height; ++y) {
            const double* row = from.data() + y * size.width;
            for (std::size_t i = 0; i < padded.size(); ++i)
                padded[i] = row[std::min(i > radius ? i - radius : 0, size.width - 1)];
            double* sums = to.data() + y * size.width;
            for (std::size_t k = 0; k < weights.size(); ++k)
                for (std::size_t x = 0; x < size.width; ++x)
                    sums[x] += weights[k] * padded[x + k];
        }
        return to;
    }
    /// The same of columns.
    values_of_pixels down(const values_of_pixels& from, picture_size size, const neighbour_weights& weights)
    {
        const std::size_t radius = weights.size() / 2;
        values_of_pixels to(from.size());
        for (std::size_t y = 0; y < size.height; ++y)
            for (std::size_t k = 0; k < weights.size(); ++k) {
                const std::size_t row = std::min(y + k > radius ? y + k - radius : 0, size.height - 1);
                for (std::size_t x = 0; x < size.width; ++x)
                    to[y * size.width + x] += weights[k] * from[row * size.width + x];
            }
        return to;
    }

    /// A Gaussian of the eye's sensitivity to contrast: a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
    struct sensitivity {
        double a, b;
        double factor() const { return a * std::sqrt(std::numbers::pi / b); }
    };

    /// What the eye resolves of an opponent colour: filtered with a sum of Gaussians, whose weights have the sum 1.
    values_of_pixels resolved_part(const values_of_pixels& from, picture_size size, double per_degree,
        std::initializer_list<sensitivity> gaussians)
    {
        constexpr double widest = 0.04; // of all b, so that all colours have the same radius
        constexpr double pi = std::numbers::pi;
        const double radius = 3 * std::sqrt(widest / (2 * pi * pi)) * per_degree;
        values_of_pixels sum(from.size());
        double total = 0;
        for (const auto& g : gaussians) {
            // A Gaussian of two dimensions is a product of two of one. It keeps its part of the sum.
            const auto along = weights_of(
                radius, [&](double x) { return std::exp(-pi * pi * x * x / (per_degree * per_degree * g.b)); });
            const double one = std::accumulate(along.begin(), along.end(), 0.0);
            total += g.factor() * one * one;
            const auto filtered = down(across(from, size, along), size, along);
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += g.factor() * filtered[i];
        }
        for (double& v : sum)
            v /= total;
        return sum;
    }

    /// The lengths of the vectors of a filter's sums, across and down. `smoothing` goes along the other axis.
    std::vector<float> strengths(const values_of_pixels& from, picture_size size, const neighbour_weights& feature,
        const neighbour_weights& smoothing)
    {
        const auto dx = down(across(from, size, feature), size, smoothing);
        const auto dy = down(across(from, size, smoothing), size, feature);
        std::vector<float> all(from.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = static_cast<float>(std::hypot(dx[i], dy[i]));
        return all;
    }

    // --- The pictures ---

    /// What the eye sees of a picture. Single precision suffices for a difference, and takes half of the memory.
    struct seen_picture {
        std::vector<glm::vec3> colors;    ///< filtered, L*a*b* with Hunt's effect
        std::vector<float> edges, points; ///< how strong they are
    };

    std::vector<glm::vec3> seen_colors(std::array<values_of_pixels, 3> c, picture_size size, double per_degree)
    {
        c[0] = resolved_part(c[0], size, per_degree, {{1, 0.0047}});
        c[1] = resolved_part(c[1], size, per_degree, {{1, 0.0053}});
        c[2] = resolved_part(c[2], size, per_degree, {{34.1, 0.04}, {13.5, 0.025}});
        std::vector<glm::vec3> colors;
        colors.reserve(c[0].size());
        for (std::size_t i = 0; i < c[0].size(); ++i) {
            const auto linear = linear_from_opponent({c[0][i], c[1][i], c[2][i]});
            colors.emplace_back(hunt_adjusted(glm::clamp(linear, 0.0, 1.0)));
        }
        return colors;
    }

    seen_picture seen(const image& picture, const tone_map& shown, double per_degree)
    {
        const picture_size size{picture.width, picture.height};
        std::array<values_of_pixels, 3> channels;
        values_of_pixels luminance;
        for (const auto& p : picture.pixels) {
            const auto relative
                = relative_to_white({linear_value(shown(p.x)), linear_value(shown(p.y)), linear_value(shown(p.z))});
            luminance.push_back(relative.y);
            const auto c = opponent(relative);
            for (int i = 0; i < 3; ++i)
                channels[static_cast<std::size_t>(i)].push_back(c[i]);
        }
        // Edges and points are found by the first and the second derivative of a Gaussian 0.082 degrees wide.
        const double sigma = 0.5 * 0.082 * per_degree;
        const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
        const auto smoothing = normalized(weights_of(3 * sigma, gaussian));
        const auto edge = normalized(weights_of(3 * sigma, [&](double x) { return -x * gaussian(x); }));
        const auto point
            = normalized(weights_of(3 * sigma, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); }));
        seen_picture s;
        s.edges = strengths(luminance, size, edge, smoothing);
        s.points = strengths(luminance, size, point, smoothing);
        s.colors = seen_colors(std::move(channels), size, per_degree);
        return s;
    }
} // namespace

glm::dvec3 detail::cielab(const glm::dvec3& linear)
{
    constexpr double delta = 6.0 / 29;
    auto f = relative_to_white(linear);
    for (int i = 0; i < 3; ++i)
        f[i] = f[i] > delta * delta * delta ? std::cbrt(f[i]) : f[i] / (3 * delta * delta) + 4.0 / 29;
    return opponent(f);
}

flip_map flip_difference(const image& a, const image& b, double exposure, double pixels_per_degree)
{
    detail::require_same_size(a, b);
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000))
        throw std::invalid_argument("pixels per degree: must be from 1 to 1000");
    const tone_map shown(exposure);
    const auto p = seen(a, shown, pixels_per_degree), q = seen(b, shown, pixels_per_degree);
    flip_map map;
    map.values.reserve(p.colors.size());
    for (std::size_t i = 0; i < p.colors.size(); ++i) {
        const double color = color_difference(glm::dvec3(p.colors[i]), glm::dvec3(q.colors[i]));
        const float feature = std::max(std::abs(p.edges[i] - q.edges[i]), std::abs(p.points[i] - q.points[i]));
        const double visible = std::min(std::sqrt(static_cast<double>(feature) / std::numbers::sqrt2), 1.0);
        const double value = std::min(std::pow(color, 1 - visible), 1.0);
        map.values.push_back(static_cast<float>(value));
        map.mean += value;
    }
    map.mean /= static_cast<double>(map.values.size()); // NaN for an empty picture
    return map;
}

} // namespace photongrid
