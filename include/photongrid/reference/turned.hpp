// Surfaces of revolution, for the reference renderer: intersection by their own equations, and bins in rings of
// sectors.
#pragma once

#include <photongrid/reference/surface_bins.hpp>

#include <algorithm>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// A surface of revolution about an axis from z = 0 at `base` to z = height.
struct turned_shape {
    /// The radius along the axis.
    enum class profile { cylinder, cone, paraboloid } kind = profile::cylinder; ///< the kind of profile
    dvec3 base{0};                                                              ///< m; where z is 0
    dvec3 axis{0, 0, 1};                                                        ///< unit
    double height = 1;                                                          ///< m
    double radius = 1; ///< m; of a cone at z = 0, of a paraboloid at z = height

    /// The axis goes from `from` to `to`, m, which must differ.
    turned_shape(profile k, const dvec3& from, const dvec3& to, double r)
        : kind(k), base(from), axis(glm::normalize(to - from)), height(glm::length(to - from)), radius(r)
    {
    }

    /// Distance from the axis at height z, both in m.
    double radius_at(double z) const
    {
        switch (kind) {
        case profile::cylinder: return radius;
        case profile::cone: return radius * (1 - z / height);
        default: return radius * std::sqrt(std::max(0.0, z / height));
        }
    }

    /// The distance to the hit, m, or infinity for a miss. `starts_on`: r starts on this shape.
    double distance(const ray& r, bool starts_on) const
    {
        // Compute from the point of the ray that is closest to the centre, so that squares of long distances do not
        // cancel.
        const double ahead = starts_on ? 0 : -glm::dot(r.origin - (base + 0.5 * height * axis), r.direction);
        const dvec3 f = r.origin + ahead * r.direction - base;
        const double z = glm::dot(f, axis), dz = glm::dot(r.direction, axis);
        const dvec3 p = f - z * axis, d = r.direction - dz * axis;
        // |p + t d|^2 = radius_at(z + t dz)^2 in powers of t.
        double a = glm::dot(d, d), b = glm::dot(p, d), c = glm::dot(p, p);
        if (kind == profile::cylinder) {
            c -= radius * radius;
        } else if (kind == profile::cone) {
            const double slope = radius / height, here = slope * (height - z);
            a -= slope * slope * dz * dz;
            b += slope * dz * here;
            c -= here * here;
        } else {
            const double opening = radius * radius / height;
            b -= 0.5 * opening * dz;
            c -= opening * z;
        }
        double nearest = infinity;
        for (const double t : real_roots(a, b, c, starts_on)) {
            const double height_there = z + t * dz;
            if (t + ahead > 0 && t + ahead < nearest && height_there >= 0 && height_there <= height)
                nearest = t + ahead;
        }
        return nearest;
    }

    /// Moves p onto the surface and returns the outward normal (at a cone's apex, the axis).
    dvec3 settle(dvec3& p) const
    {
        const double z = std::clamp(glm::dot(p - base, axis), 0.0, height);
        const dvec3 off = (p - base) - glm::dot(p - base, axis) * axis;
        const double r = glm::length(off);
        const dvec3 outward = r > 0 ? off / r : across(axis);
        p = base + z * axis + radius_at(z) * outward;
        switch (kind) {
        case profile::cylinder: return outward;
        case profile::cone: return r > 0 ? glm::normalize(height * outward + radius * axis) : axis;
        default:
            return glm::normalize(
                2 * height * radius_at(z) * outward - radius * radius * axis); // gradient of height rho^2 - radius^2 z
        }
    }
};

/// A surface of revolution as ring_bins divides it: along a profile coordinate, an angle for a sphere, m for the
/// others.
struct turned_profile {
    /// The kind of surface.
    enum class form { sphere, disk, cylinder, cone, paraboloid } kind = form::sphere;
    dvec3 origin{0};     ///< m; where the profile coordinate is 0, but for a sphere, its centre
    dvec3 axis{0, 0, 1}; ///< unit
    double radius = 1;   ///< m
    double height = 0;   ///< m; along the axis
    double length = 1;   ///< the last profile coordinate
};

/// The bins of a surface of revolution: rings along its profile, each divided into sectors so that bins are about
/// square.
class ring_bins {
public:
    /// Bins of about `size`, m. \throws std::invalid_argument for more bins than most_bins.
    ring_bins(const turned_profile& p, double size)
        : form_(p.kind), origin_(p.origin), axis_(p.axis), u_(across(p.axis)), v_(glm::cross(p.axis, u_)),
          radius_(p.radius), height_(p.height)
    {
        const double step = form_ == form::sphere ? size / radius_ : size;
        require_few_bins(p.length / step, size);
        edges_.push_back(0);
        if (form_ == form::paraboloid) { // rings of equal arc length:
                                         // d(arc) = sqrt(1 + (2 height rho / radius^2)^2) d(rho)
            require_few_bins(2 * (radius_ + height_) / size, size);
            while (edges_.back() < p.length)
                edges_.push_back(std::min(p.length,
                    edges_.back() + step / std::hypot(1.0, 2 * height_ * edges_.back() / (radius_ * radius_))));
        } else {
            const double rings = std::max(1.0, std::ceil(p.length / step - 1e-9));
            for (double i = 1; i <= rings; ++i)
                edges_.push_back(p.length * (i / rings));
        }
        double bins = 0;
        first_.push_back(0);
        for (std::size_t i = 0; i + 1 < edges_.size(); ++i) {
            bins += std::max(1.0, std::round(2 * M_PI * radius_at(0.5 * (edges_[i] + edges_[i + 1])) / size));
            require_few_bins(bins, size);
            first_.push_back(static_cast<std::uint32_t>(bins));
        }
    }

    /// The number of bins.
    std::uint32_t size() const { return first_.back(); }
    /// m^2
    double area(std::uint32_t bin) const
    {
        const auto ring
            = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), bin) - first_.begin()) - 1;
        return (area_within(edges_[ring + 1]) - area_within(edges_[ring])) / (first_[ring + 1] - first_[ring]);
    }
    /// The area of the whole surface, m^2.
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
    using form = turned_profile::form;

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
    /// The area from coordinate 0 to s.
    double area_within(double s) const
    {
        switch (form_) {
        case form::sphere: return 4 * M_PI * radius_ * radius_ * std::sin(0.5 * s) * std::sin(0.5 * s);
        case form::disk: return M_PI * s * s;
        case form::cylinder: return 2 * M_PI * radius_ * s;
        case form::cone: return M_PI * radius_ / std::hypot(height_, radius_) * s * s;
        default: break;
        }
        // z = a rho^2: pi / (6 a^2) ((1 + 4 a^2 rho^2)^(3/2) - 1), written so that it does not cancel for a shallow
        // bowl.
        const double a = height_ / (radius_ * radius_), x = 4 * a * a * s * s;
        return x > 0 ? M_PI / (6 * a * a) * std::expm1(1.5 * std::log1p(x)) : M_PI * s * s;
    }

    form form_;
    dvec3 origin_, axis_, u_, v_;
    double radius_, height_;
    std::vector<double> edges_;        ///< coordinates of the rings' edges
    std::vector<std::uint32_t> first_; ///< first bin of each ring, and the number of bins
};

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
