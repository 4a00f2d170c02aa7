// The fixture of tests of edge correction, and surfaces with edges.
#pragma once

#include "../trace/ray_tests.hpp"
#include "known_answers.hpp"

#include <photongrid/render/edge_correction.hpp>

namespace photongrid::testing {

/// A plane's frame, to draw polygons in.
struct drawing_board {
    dvec3 origin{0}, right{1, 0, 0}, up{0, 0, 1};
    dvec3 at(glm::dvec2 p) const { return origin + p.x * right + p.y * up; }
    dvec3 normal() const { return glm::cross(right, up); }
    polygon draw(const std::vector<glm::dvec2>& corners) const
    {
        polygon p;
        for (const auto& c : corners)
            p.vertices.push_back(at(c));
        return p;
    }
};

inline drawing_board random_board(random_source& u)
{
    drawing_board d;
    const dvec3 n = glm::normalize(dvec3(random_direction(u)));
    d.origin = dvec3(u(), u(), u());
    d.right = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    d.up = glm::cross(n, d.right);
    return d;
}

/// Points on the surfaces of a scene, with their discs.
struct discs {
    std::vector<glm::vec4> points, normals, estimates;
    void add(const dvec3& p, const dvec3& n, double radius)
    {
        points.emplace_back(glm::vec3(p), 1.0f);
        normals.emplace_back(glm::vec3(n), 0.0f);
        estimates.emplace_back(0.0f, 0.0f, 0.0f, static_cast<float>(radius * radius));
    }
};

/// Squares of 1 m in rows on the floor, 2 m apart from middle to middle, so that no disc below 0.5 m meets two.
struct squares {
    scene s;
    uint rows = 16;
    dvec3 corner(uint i) const { return {2.0 * (i % rows), 0, 2.0 * (i / rows)}; }
    squares()
    {
        s = empty_scene({rows, 3, rows});
        s.camera = {{0, 5, 0}, {1, 0, 1}, {0, 1, 0}, 40};
        for (uint i = 0; i < rows * rows; ++i) {
            const dvec3 c = corner(i);
            s.polygons.push_back({{c, c + dvec3(0, 0, 1), c + dvec3(1, 0, 1), c + dvec3(1, 0, 0)}, 0});
        }
    }
};

template <class Tag>
class edges : public on_backend<Tag> {
protected:
    using B = typename Tag::type;

    template <class Device>
    static std::vector<glm::vec4> cover_on(
        Device& b, const device_scene<Device>& scene, const discs& d, filter_kind filter)
    {
        const auto p = b.upload(std::span<const glm::vec4>(d.points)),
                   n = b.upload(std::span<const glm::vec4>(d.normals)),
                   e = b.upload(std::span<const glm::vec4>(d.estimates));
        return b.download(covered_shares(b, scene, p, n, e, filter));
    }
    /// Positions of `d` are the scene's; they are recentred here. Serial's bits are compared.
    std::vector<glm::vec4> cover(const scene& s, discs d, filter_kind filter)
    {
        auto& b = this->b();
        const auto scene = upload_scene(b, s);
        serial_backend serial;
        const auto reference = upload_scene(serial, s);
        for (auto& p : d.points)
            p = glm::vec4(glm::vec3(dvec3(p) - scene.layout.center), p.w);
        const auto shares = cover_on(b, scene, d, filter);
        if (b.caps().exact_division && b.caps().exact_sqrt) {
            EXPECT_EQ(count_different_bits(shares, cover_on(serial, reference, d, filter)), 0u);
        }
        return shares;
    }
    double largest_error(const std::vector<glm::vec4>& cover, double expected)
    {
        double largest = 0;
        for (const auto& c : cover)
            largest = c.y == 1 ? std::max(largest, std::abs(static_cast<double>(c.x) - expected)) : 1;
        return largest;
    }
};
TYPED_TEST_SUITE_P(edges);

} // namespace photongrid::testing
