// The shapes of the reference renderer: in double precision, each from its own equation, independent of
// trace/intersect/.
//
// shape_of(x) converts a shape of the scene. The result has distance(ray, starts_on) and settle(point). bins_of(x,
// size) and surface_area(x) are for the light tracer's bins.
#pragma once

#include <photongrid/reference/surface_bins.hpp>
#include <photongrid/reference/turned.hpp>

#include <tuple>
#include <variant>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::reference {

/// A convex polygon, or the surface of a rectangle light.
struct flat_shape {
    dvec3 normal{0, 0, 1}; ///< unit; its side depends on the order of the vertices
    dvec3 corner{0};       ///< m; the first vertex
    /// An edge as a half-plane: points p with dot(inward, p - corner) >= offset are inside.
    struct edge {
        dvec3 inward;  ///< unit, in the plane
        double offset; ///< m
    };
    std::vector<edge> edges; ///< without those of length 0

    /// The polygon must pass check().
    explicit flat_shape(const polygon& p) : normal(glm::normalize(area_vector(p))), corner(p.vertices[0])
    {
        double extent = 0;
        for (const auto& v : p.vertices)
            extent = std::max(extent, glm::length(v - corner));
        for (std::size_t i = 0; i < p.vertices.size(); ++i) {
            const dvec3 a = p.vertices[i], b = p.vertices[(i + 1) % p.vertices.size()];
            const dvec3 inward = glm::cross(normal, b - a);
            if (const double length = glm::length(inward);
                length > 0) // rounding must not open a gap between neighbours
                edges.push_back({inward / length, glm::dot(inward / length, a - corner) - 1e-13 * extent});
        }
    }

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        if (starts_on)
            return infinity;
        const double t = glm::dot(normal, corner - r.origin) / glm::dot(normal, r.direction);
        if (!(t > 0) || !(t < infinity))
            return infinity;
        const dvec3 p = r.origin + t * r.direction - corner;
        for (const auto& e : edges)
            if (glm::dot(e.inward, p) < e.offset)
                return infinity;
        return t;
    }
    /// Moves p onto the plane and returns the normal.
    dvec3 settle(dvec3& p) const
    {
        p -= glm::dot(p - corner, normal) * normal;
        return normal;
    }
};

/// A sphere.
struct ball_shape {
    dvec3 center{0};   ///< m
    double radius = 1; ///< m

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        const dvec3 f = r.origin - center;
        const double b = glm::dot(f, r.direction);
        if (starts_on)
            return -2 * b > 0 ? -2 * b : infinity;
        const dvec3 nearest = f - b * r.direction; // the line's closest point to the centre, relative to it
        const double half2 = radius * radius - glm::dot(nearest, nearest);
        if (!(half2 >= 0))
            return infinity;
        const double half = std::sqrt(half2);
        return -b - half > 0 ? -b - half : -b + half > 0 ? -b + half : infinity;
    }
    /// Moves p onto the sphere and returns the outward normal.
    dvec3 settle(dvec3& p) const
    {
        const dvec3 n = glm::normalize(p - center);
        p = center + radius * n;
        return n;
    }
};

/// A disk.
struct disk_shape {
    dvec3 center{0};       ///< m
    dvec3 normal{0, 0, 1}; ///< unit
    double radius = 1;     ///< m

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        if (starts_on)
            return infinity;
        const double t = glm::dot(normal, center - r.origin) / glm::dot(normal, r.direction);
        if (!(t > 0) || !(t < infinity))
            return infinity;
        const dvec3 p = r.origin + t * r.direction - center;
        return glm::dot(p, p) <= radius * radius ? t : infinity;
    }
    /// Moves p onto the plane and returns the normal.
    dvec3 settle(dvec3& p) const
    {
        p -= glm::dot(p - center, normal) * normal;
        return normal;
    }
};

/// A closed box.
struct box_shape {
    dvec3 middle{0};             ///< m
    std::array<dvec3, 3> axes{}; ///< orthogonal unit vectors
    dvec3 half{1};               ///< m; half the length along each axis

    /// The box must pass check().
    explicit box_shape(const box& b) : middle(b.corner + 0.5 * (b.edge_u + b.edge_v + b.edge_w))
    {
        const std::array edges{b.edge_u, b.edge_v, b.edge_w};
        for (int i = 0; i < 3; ++i) {
            half[i] = 0.5 * glm::length(edges[static_cast<std::size_t>(i)]);
            axes[static_cast<std::size_t>(i)] = glm::normalize(edges[static_cast<std::size_t>(i)]);
        }
    }

    /// The components of v along the box's axes.
    dvec3 local(const dvec3& v) const { return {glm::dot(v, axes[0]), glm::dot(v, axes[1]), glm::dot(v, axes[2])}; }

    /// The axis of the face that p is closest to, or farthest outside of.
    int axis_at(const dvec3& p) const
    {
        const dvec3 out = glm::abs(local(p - middle)) - half;
        return out.x >= out.y && out.x >= out.z ? 0 : out.y >= out.z ? 1 : 2;
    }

    /// As turned_shape::distance.
    double distance(const ray& r, bool starts_on) const
    {
        const dvec3 p = local(r.origin - middle), d = local(r.direction);
        double enter = -infinity, leave = infinity; // between the planes of all pairs of faces
        for (int i = 0; i < 3; ++i) {
            if (d[i] == 0 && std::abs(p[i]) > half[i])
                return infinity;
            if (d[i] == 0)
                continue;
            const double beyond = std::copysign(half[i], d[i]);
            enter = std::max(enter, (-beyond - p[i]) / d[i]);
            leave = std::min(leave, (beyond - p[i]) / d[i]);
        }
        if (starts_on) { // convex: an outgoing ray misses it, an ingoing ray hits another face
            const int face = axis_at(r.origin);
            return p[face] * d[face] >= 0 ? infinity : std::max(leave, 0.0);
        }
        const double t = enter > 0 ? enter : leave;
        return enter <= leave && t > 0 ? t : infinity;
    }

    /// Moves p onto the nearest face and returns its outward normal.
    dvec3 settle(dvec3& p) const
    {
        const int i = axis_at(p);
        const double coordinate = local(p - middle)[i];
        const dvec3 outward = coordinate < 0 ? -axes[static_cast<std::size_t>(i)] : axes[static_cast<std::size_t>(i)];
        p += (half[i] - std::abs(coordinate)) * outward;
        return outward;
    }
};

/// The bins of a box: those of its faces.
class box_bins {
public:
    /// See plane_bins.
    box_bins(const box& b, double size) : shape_(b)
    {
        for (const auto& face : faces_of(b)) {
            first_.push_back(size_);
            faces_.emplace_back(face, size);
            size_ += faces_.back().size();
            require_few_bins(size_, size);
        }
    }
    /// The number of bins, including those without area.
    std::uint32_t size() const { return size_; }
    /// m^2
    double area(std::uint32_t bin) const
    {
        std::size_t f = 5;
        while (bin < first_[f])
            --f;
        return faces_[f].area(bin - first_[f]);
    }
    /// The bin of a point of the surface, m.
    std::uint32_t at(const dvec3& p) const
    {
        const int axis = shape_.axis_at(p);
        const auto f = static_cast<std::size_t>(2 * axis + (shape_.local(p - shape_.middle)[axis] > 0 ? 1 : 0));
        return first_[f] + faces_[f].at(p);
    }

private:
    box_shape shape_;
    std::vector<plane_bins> faces_; ///< as faces_of() has them
    std::vector<std::uint32_t> first_;
    std::uint32_t size_ = 0;
};

/// \name Conversion of a scene's shape
/// @{

/// The reference's form of the shape.
inline ball_shape shape_of(const sphere& x) { return {x.center, x.radius}; }
inline turned_shape shape_of(const cylinder& x) { return {turned_shape::profile::cylinder, x.base, x.top, x.radius}; }
inline turned_shape shape_of(const cone& x) { return {turned_shape::profile::cone, x.base, x.apex, x.radius}; }
inline turned_shape shape_of(const paraboloid& x)
{
    return {turned_shape::profile::paraboloid, x.vertex, x.rim, x.radius};
}
inline disk_shape shape_of(const disk& x) { return {x.center, glm::normalize(x.normal), x.radius}; }
inline box_shape shape_of(const box& x) { return box_shape(x); }
inline flat_shape shape_of(const polygon& x) { return flat_shape(x); }
/// @}

/// Vectors of all shapes, in the order of shape_lists().
using shape_vectors = std::tuple<std::vector<ball_shape>, std::vector<turned_shape>, std::vector<disk_shape>,
    std::vector<box_shape>, std::vector<flat_shape>>;

/// The bins of any surface.
using surface_bins = std::variant<ring_bins, plane_bins, box_bins>;

/// \name The profile of a scene's shape, for its bins
/// @{

/// Profile coordinates: the angle from +z of a sphere, the distance from the centre of a disk, the height of a
/// cylinder, the distance from the apex of a cone, and the distance from the axis of a paraboloid.
inline turned_profile profile_of(const sphere& x)
{
    return {turned_profile::form::sphere, x.center, {0, 0, 1}, x.radius, 0, M_PI};
}
inline turned_profile profile_of(const disk& x)
{
    return {turned_profile::form::disk, x.center, glm::normalize(x.normal), x.radius, 0, x.radius};
}
inline turned_profile profile_of(const cylinder& x)
{
    const double height = glm::length(x.top - x.base);
    return {turned_profile::form::cylinder, x.base, glm::normalize(x.top - x.base), x.radius, height, height};
}
inline turned_profile profile_of(const cone& x)
{
    const double height = glm::length(x.base - x.apex);
    return {turned_profile::form::cone, x.apex, glm::normalize(x.base - x.apex), x.radius, height,
        std::hypot(height, x.radius)};
}
inline turned_profile profile_of(const paraboloid& x)
{
    return {turned_profile::form::paraboloid, x.vertex, glm::normalize(x.rim - x.vertex), x.radius,
        glm::length(x.rim - x.vertex), x.radius};
}
/// @}

/// Divides a surface into bins of about `size`, m. \throws std::invalid_argument for more bins than most_bins.
template <class Round>
surface_bins bins_of(const Round& x, double size)
{
    return ring_bins(profile_of(x), size);
}
inline surface_bins bins_of(const box& b, double size) { return box_bins(b, size); }       ///< the same
inline surface_bins bins_of(const polygon& p, double size) { return plane_bins(p, size); } ///< the same

/// The area of one side, m^2.
template <class Round>
double surface_area(const Round& x)
{
    return ring_bins(profile_of(x), infinity).area_of_all();
}
/// The same.
inline double surface_area(const box& b)
{
    double sum = 0;
    for (const auto& face : faces_of(b))
        sum += glm::length(area_vector(face));
    return sum;
}
inline double surface_area(const polygon& p) { return glm::length(area_vector(p)); } ///< the same

} // namespace photongrid::reference

#include <photongrid/core/exact_end.hpp>
