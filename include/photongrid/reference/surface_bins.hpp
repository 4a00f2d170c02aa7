// Surfaces cut into bins whose areas are known exactly: where light paths leave their flux. Flat polygons are cut by a
// square grid, clipped; surfaces of revolution into rings of sectors.
#pragma once

#include <photongrid/reference/intersect.hpp>

#include <string>
#include <variant>

namespace photongrid::reference {

/// Bins of all surfaces of a scene together are at most this many.
constexpr double most_bins = 0x1p23;

/// \throws std::invalid_argument for more bins than most_bins; `size`, m, is for the message.
inline void require_few_bins(double count, double size)
{
    if (!(count <= most_bins))
        throw std::invalid_argument("bin: bins of " + std::to_string(size)
            + " m cut the diffuse surfaces into more than 2^23; choose a larger size");
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

/// A convex polygon's bins: squares of about `size`, cut at its edges. What is left of a square that is mostly cut off
/// is joined to a neighbour, since little area means much noise.
class plane_bins {
public:
    /// `size`: m. \throws std::invalid_argument for more bins than most_bins.
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
        const glm::dvec2 wanted = glm::max(glm::dvec2(1), glm::ceil((high - low_) / size));
        require_few_bins(wanted.x * wanted.y, size);
        columns_ = static_cast<std::uint32_t>(wanted.x);
        rows_ = static_cast<std::uint32_t>(wanted.y);
        step_ = (high - low_) / wanted;
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

    /// Bins, those without area included.
    std::uint32_t size() const { return columns_ * rows_; }
    /// m^2; 0 for one outside the polygon, or joined to a neighbour.
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

    /// Cells of less than a quarter of a square go to the neighbour with the most area.
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
                        best = mine; // among small ones each keeps its own
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

/// Bins of a surface of revolution: rings along its profile, each in as many sectors as keep bins about square.
class ring_bins {
public:
    /// \name Bins of about `size`, m
    /// @{

    /// \throws std::invalid_argument for more bins than most_bins.
    ring_bins(const sphere& s, double size) : ring_bins(form::sphere, s.center, dvec3(0, 0, 1), s.radius, 0, M_PI, size)
    {
    }
    ring_bins(const disk& d, double size)
        : ring_bins(form::disk, d.center, glm::normalize(d.normal), d.radius, 0, d.radius, size)
    {
    }
    ring_bins(const cylinder& c, double size)
        : ring_bins(form::cylinder, c.base, glm::normalize(c.top - c.base), c.radius, glm::length(c.top - c.base),
            glm::length(c.top - c.base), size)
    {
    }
    ring_bins(const cone& c, double size) // measured from the apex
        : ring_bins(form::cone, c.apex, glm::normalize(c.base - c.apex), c.radius, glm::length(c.base - c.apex),
            std::hypot(glm::length(c.base - c.apex), c.radius), size)
    {
    }
    ring_bins(const paraboloid& p, double size)
        : ring_bins(form::paraboloid, p.vertex, glm::normalize(p.rim - p.vertex), p.radius,
            glm::length(p.rim - p.vertex), p.radius, size)
    {
    }
    /// @}

    /// Bins.
    std::uint32_t size() const { return first_.back(); }
    /// m^2
    double area(std::uint32_t bin) const
    {
        const auto ring
            = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), bin) - first_.begin()) - 1;
        return (area_within(edges_[ring + 1]) - area_within(edges_[ring])) / (first_[ring + 1] - first_[ring]);
    }
    /// m^2, of the whole surface.
    double area_of_all() const { return area_within(edges_.back()); }
    /// The bin of a point of the surface, m.
    std::uint32_t at(const dvec3& p) const
    {
        const dvec3 f = p - origin_;
        const double z = glm::dot(f, axis_), x = glm::dot(f, u_), y = glm::dot(f, v_);
        const double s = profile_coordinate(z, std::hypot(x, y));
        const auto inner = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, s) - edges_.begin();
        const auto ring = static_cast<std::size_t>(inner) - 1;
        const double sectors = first_[ring + 1] - first_[ring];
        const double turn = std::atan2(y, x) / (2 * M_PI) + 0.5;
        return first_[ring] + static_cast<std::uint32_t>(std::clamp(std::floor(turn * sectors), 0.0, sectors - 1));
    }

private:
    enum class form { sphere, disk, cylinder, cone, paraboloid };

    /// `length`: the last profile coordinate, an angle for a sphere, m for the others.
    ring_bins(form f, const dvec3& origin, const dvec3& axis, double radius, double height, double length, double size)
        : form_(f), origin_(origin), axis_(axis), u_(across(axis)), v_(glm::cross(axis, u_)), radius_(radius),
          height_(height)
    {
        const double step = f == form::sphere ? size / radius : size;
        require_few_bins(length / step, size);
        edges_.push_back(0);
        if (f == form::paraboloid) { // rings as wide along the bowl as elsewhere: d(arc) = sqrt(1 + (2 height rho /
                                     // radius^2)^2) d(rho)
            require_few_bins(2 * (radius + height) / size, size);
            while (edges_.back() < length)
                edges_.push_back(std::min(
                    length, edges_.back() + step / std::hypot(1.0, 2 * height * edges_.back() / (radius * radius))));
        } else {
            const double rings = std::max(1.0, std::ceil(length / step - 1e-9));
            for (double i = 1; i <= rings; ++i)
                edges_.push_back(length * (i / rings));
        }
        double bins = 0;
        first_.push_back(0);
        for (std::size_t i = 0; i + 1 < edges_.size(); ++i) {
            bins += std::max(1.0, std::round(2 * M_PI * radius_at(0.5 * (edges_[i] + edges_[i + 1])) / size));
            require_few_bins(bins, size);
            first_.push_back(static_cast<std::uint32_t>(bins));
        }
    }

    double profile_coordinate(double z, double rho) const
    {
        switch (form_) {
        case form::sphere: return std::atan2(rho, z);
        case form::cylinder: return z;
        case form::cone: return std::hypot(rho, z);
        default: return rho;
        }
    }
    /// Distance from the axis at profile coordinate s.
    double radius_at(double s) const
    {
        switch (form_) {
        case form::sphere: return radius_ * std::sin(s);
        case form::cylinder: return radius_;
        case form::cone: return radius_ * s / std::hypot(height_, radius_);
        default: return s;
        }
    }
    /// Area from coordinate 0 to s.
    double area_within(double s) const
    {
        switch (form_) {
        case form::sphere: return 4 * M_PI * radius_ * radius_ * std::sin(0.5 * s) * std::sin(0.5 * s);
        case form::disk: return M_PI * s * s;
        case form::cylinder: return 2 * M_PI * radius_ * s;
        case form::cone: return M_PI * radius_ / std::hypot(height_, radius_) * s * s;
        default: break;
        }
        // z = a rho^2: pi / (6 a^2) ((1 + 4 a^2 rho^2)^(3/2) - 1), written so that a shallow bowl does not cancel.
        const double a = height_ / (radius_ * radius_), x = 4 * a * a * s * s;
        return x > 0 ? M_PI / (6 * a * a) * std::expm1(1.5 * std::log1p(x)) : M_PI * s * s;
    }

    form form_;
    dvec3 origin_, axis_, u_, v_;
    double radius_, height_;
    std::vector<double> edges_;        ///< of the rings
    std::vector<std::uint32_t> first_; ///< first bin of each ring, and how many bins there are
};

/// The bins of any surface.
using surface_bins = std::variant<ring_bins, plane_bins>;

} // namespace photongrid::reference
