// Writes the scene buffer: vec4 records in single precision, positions recentred.
#pragma once

#include <photongrid/scene/check.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A number in two parts, the higher and the lower 16 bits, which single precision can hold.
inline glm::dvec2 halves_of(std::size_t n) { return {static_cast<double>(n >> 16), static_cast<double>(n & 0xFFFFu)}; }

/// Writes the records of shapes and lights. The kernel files that read them describe their layouts.
class record_writer {
public:
    /// Appends to `out`; `center` is subtracted from positions; `scale`, m: the largest coordinate by which rounding is
    /// bounded, half the scene's diagonal; 0: that of each shape.
    record_writer(std::vector<glm::vec4>& out, const dvec3& center, double scale)
        : out_(out), center_(center), scale_(scale)
    {
    }

    /// Appends a record.
    void put(const dvec3& v, double w)
    {
        out_.emplace_back(
            static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w));
    }
    /// Appends a record with a position, m.
    void put_position(const dvec3& v, double w) { put(v - center_, w); }
    /// Appends a record with an index or a count.
    void put_number(std::size_t n) { put(dvec3(static_cast<double>(n), 0, 0), 0); }
    /// Appends the plane through `point`: unit normal and offset.
    void put_plane(const dvec3& normal, const dvec3& point) { put(normal, glm::dot(normal, point - center_)); }

    /// Subtracted from positions, m.
    const dvec3& center() const { return center_; }
    /// A bound on the rounding error of distances from planes and edges of a shape with these vertices, m.
    double rounding(const std::vector<dvec3>& vertices) const
    {
        double farthest = scale_;
        if (scale_ == 0)
            for (const auto& v : vertices)
                farthest = std::max(farthest, glm::length(v - center_));
        return farthest * 0x1p-20;
    }
    /// The number of the next record.
    std::uint32_t next() const { return static_cast<std::uint32_t>(out_.size()); }

private:
    std::vector<glm::vec4>& out_;
    dvec3 center_;
    double scale_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
