// Divides surfaces into bins of exactly known area, in which light paths sum their power. Polygons are divided by a
// square grid; turned.hpp divides surfaces of revolution into rings and sectors.
#pragma once

#include <photongrid/reference/ray.hpp>

#include <algorithm>
#include <string>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// The largest number of bins of a scene.
constexpr double most_bins = 0x1p23;

/// \throws std::invalid_argument for more bins than most_bins; `size`, m, is for the message.
inline void require_few_bins(double count, double size)
{
    if (!(count <= most_bins))
        throw std::invalid_argument("bin: bins of " + std::to_string(size)
            + " m divide the diffuse surfaces into more than 2^23; choose a larger size");
}

/// The part of a convex polygon with coordinate `axis` at least (`above`) or at most `bound` (Sutherland and Hodgman).
inline std::vector<glm::dvec2> clipped(const std::vector<glm::dvec2>& p, int axis, double bound, bool above)
{
    std::vector<glm::dvec2> out;
    const auto depth = [&](const glm::dvec2& v) { return above ? v[axis] - bound : bound - v[axis]; };
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto &a = p[i], &b = p[(i + 1) % p.size()];
        const double da = depth(a), db = depth(b);
        if (da >= 0)
            out.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0))
            out.push_back(a + da / (da - db) * (b - a));
    }
    return out;
}

/// The area of a convex polygon.
inline double area_of(const std::vector<glm::dvec2>& p)
{
    double twice = 0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        const auto a = p[i] - p[0], b = p[i + 1] - p[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::abs(twice);
}

/// The bins of a convex polygon: squares of about `size`, clipped at its edges. Small remainders are joined to a
/// neighbour, because a small area has much noise.
class plane_bins {
public:
    /// `size`: m.
    /// \throws std::invalid_argument for more bins than most_bins.
    plane_bins(const polygon& p, double size)
        : corner_(p.vertices[0]), u_(across(glm::normalize(area_vector(p)))),
          v_(glm::cross(glm::normalize(area_vector(p)), u_))
    {
        std::vector<glm::dvec2> outline;
        glm::dvec2 high(-infinity);
        low_ = glm::dvec2(infinity);
        for (const auto& x : p.vertices) {
            outline.push_back(flat(x));
            low_ = glm::min(low_, outline.back());
            high = glm::max(high, outline.back());
        }
        const glm::dvec2 cells = glm::max(glm::dvec2(1), glm::ceil((high - low_) / size));
        require_few_bins(cells.x * cells.y, size);
        columns_ = static_cast<std::uint32_t>(cells.x);
        rows_ = static_cast<std::uint32_t>(cells.y);
        step_ = (high - low_) / cells;
        std::vector<double> cut(std::size_t{columns_} * rows_, 0.0);
        for (std::uint32_t y = 0; y < rows_; ++y) {
            const auto strip
                = clipped(clipped(outline, 1, low_.y + y * step_.y, true), 1, low_.y + (y + 1) * step_.y, false);
            for (std::uint32_t x = 0; x < columns_ && strip.size() >= 3; ++x)
                cut[index(x, y)] = area_of(
                    clipped(clipped(strip, 0, low_.x + x * step_.x, true), 0, low_.x + (x + 1) * step_.x, false));
        }
        join(cut);
    }

    /// The number of bins, including those without area.
    std::uint32_t size() const { return columns_ * rows_; }
    /// m^2; 0 for a bin outside the polygon, or joined to a neighbour.
    double area(std::uint32_t bin) const { return areas_[bin]; }
    /// The bin of a point of the polygon, m.
    std::uint32_t at(const dvec3& p) const
    {
        const glm::dvec2 cell
            = glm::clamp(glm::floor((flat(p) - low_) / step_), glm::dvec2(0), glm::dvec2(columns_ - 1, rows_ - 1));
        return bin_of_[index(static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y))];
    }

private:
    glm::dvec2 flat(const dvec3& p) const { return {glm::dot(p - corner_, u_), glm::dot(p - corner_, v_)}; }
    std::uint32_t index(std::uint32_t x, std::uint32_t y) const { return y * columns_ + x; }

    /// Joins cells of less than a quarter of a square to the neighbour with the largest area.
    void join(const std::vector<double>& cut)
    {
        const double small = 0.25 * step_.x * step_.y;
        bin_of_.resize(cut.size());
        areas_.assign(cut.size(), 0.0);
        for (std::uint32_t y = 0; y < rows_; ++y)
            for (std::uint32_t x = 0; x < columns_; ++x) {
                const std::uint32_t mine = index(x, y);
                std::uint32_t best = mine;
                if (cut[mine] < small) {
                    for (std::uint32_t b = y > 0 ? y - 1 : 0; b <= std::min(y + 1, rows_ - 1); ++b)
                        for (std::uint32_t a = x > 0 ? x - 1 : 0; a <= std::min(x + 1, columns_ - 1); ++a)
                            if (cut[index(a, b)] > cut[best])
                                best = index(a, b);
                    if (cut[best] < small && cut[mine] > 0)
                        best = mine; // if all neighbours are small too, it stays separate
                }
                bin_of_[mine] = best;
                areas_[best] += cut[mine];
            }
    }

    dvec3 corner_, u_, v_;
    glm::dvec2 low_{0}, step_{1};
    std::uint32_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> bin_of_; ///< by cell
    std::vector<double> areas_;
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
