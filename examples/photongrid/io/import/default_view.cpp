#include <photongrid/io/import/default_view.hpp>
#include <photongrid/reference/intersect.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace photongrid {

environment_map default_sky()
{
    environment_map sky;
    sky.width = 512;
    sky.height = 256;
    sky.radiance.clear();
    const dvec3 ground(0.3, 0.29, 0.28), horizon(0.8, 0.82, 0.85), zenith(0.35, 0.5, 0.75), patch(9, 8.7, 8.2);
    const dvec3 to_patch = glm::normalize(dvec3(-0.55, 0.75, 0.6));
    for (std::uint32_t row = 0; row < sky.height; ++row)
        for (std::uint32_t column = 0; column < sky.width; ++column) {
            const dvec3 d = environment_direction((column + 0.5) / sky.width, (row + 0.5) / sky.height);
            const dvec3 far = d.y > 0 ? zenith : ground;
            const double of_horizon = std::exp(-3 * std::abs(d.y)), // falls faster than the way to the zenith
                of_patch = std::exp(-10 * (1 - glm::dot(d, to_patch)));
            sky.radiance.emplace_back(far + (horizon - far) * of_horizon + patch * of_patch);
        }
    return sky;
}

namespace {
    bool is_ground(const bounds& b)
    {
        const dvec3 size = b.high - b.low;
        return size.y < 0.02 * std::min(size.x, size.z);
    }

    /// What the camera should look at: all, but for grounds that are more than twice as wide as what stands on them.
    bounds subject_of(const scene& s)
    {
        const auto all = bounds_of(s);
        bounds rest;
        for (const auto& m : s.meshes) {
            bounds b;
            shape_kind<placed_mesh>::add_bounds(b, m);
            if (!is_ground(b))
                rest.add(b);
        }
        const bool only_meshes = count_shapes(s) == s.meshes.size();
        if (!only_meshes || rest.empty() || 2 * glm::length(rest.high - rest.low) > glm::length(all.high - all.low))
            return all;
        const dvec3 margin = 0.25 * (rest.high - rest.low); // for its shadow
        return {glm::max(all.low, rest.low - margin), glm::min(all.high, rest.high + margin)};
    }

    camera camera_outside(const bounds& b)
    {
        const dvec3 middle = 0.5 * (b.low + b.high), half = glm::max(0.5 * (b.high - b.low), dvec3(1e-7));
        dvec3 from(0.4, 0.35, 1);
        if (half.y < 0.1 * std::min(half.x, half.z))
            from = {0.3, 0.8, 1};
        else if (half.x < 0.1 * std::min(half.y, half.z))
            from = {1, 0.35, 0.4};
        const dvec3 back = glm::normalize(from), right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)),
                    up = glm::cross(back, right);
        camera c;
        c.vertical_fov = 40;
        const double slope = std::tan(glm::radians(c.vertical_fov) / 2);
        double distance = 0;
        for (const double x : {-1.0, 1.0})
            for (const double y : {-1.0, 1.0})
                for (const double z : {-1.0, 1.0}) {
                    const dvec3 corner = half * dvec3(x, y, z);
                    const double aside = std::max(std::abs(glm::dot(corner, right)), std::abs(glm::dot(corner, up)));
                    distance = std::max(distance, glm::dot(corner, back) + 1.1 * aside / slope);
                }
        c.look_at = middle;
        c.position = middle + distance * back;
        return c;
    }

    /// Counts what cameras see that lamps light.
    class onlooker {
    public:
        explicit onlooker(const scene& s) : shapes_(s)
        {
            for (const auto& l : s.point_lights)
                lamps_.push_back(l.position);
            for (const auto& l : s.spot_lights)
                lamps_.push_back(l.position);
            for (const auto& l : s.rectangle_lights)
                lamps_.push_back(l.corner + 0.5 * (l.edge_u + l.edge_v));
            for (const auto& l : s.sphere_lights)
                lamps_.push_back(l.center);
            for (const auto& l : s.mesh_lights)
                if (const auto& m = *l.surface.surface; !m.triangles.empty()) {
                    const auto c = corners_of(l.surface, m.triangles.size() / 2);
                    lamps_.push_back((c[0] + c[1] + c[2]) / 3.0);
                }
            lamps_.resize(std::min<std::size_t>(lamps_.size(), 32));
        }

        /// Of some hundred rays, those that meet a lamp or what a lamp lights.
        int count_lit(const camera& c) const
        {
            constexpr int side = 20;
            const auto [forward, right, up] = detail::camera_axes(c);
            const double slope = std::tan(glm::radians(c.vertical_fov) / 2);
            int lit = 0;
            for (int row = 0; row < side; ++row)
                for (int column = 0; column < side; ++column) {
                    const double x = (2 * column + 1.0) / side - 1, y = (2 * row + 1.0) / side - 1;
                    const auto h = shapes_.nearest(
                        {c.position, glm::normalize(forward + slope * (x * right + y * up)), reference::nothing});
                    lit += h.shape != reference::nothing && (h.light != reference::nothing || is_lit(h, c)) ? 1 : 0;
                }
            return lit;
        }

    private:
        bool is_lit(const reference::hit& h, const camera& c) const
        {
            const dvec3 normal = glm::dot(c.position - h.position, h.normal) > 0 ? h.normal : -h.normal;
            return std::any_of(lamps_.begin(), lamps_.end(), [&](const dvec3& lamp) {
                const dvec3 way = lamp - h.position;
                const double far = glm::length(way);
                if (!(glm::dot(way, normal) > 0))
                    return false;
                const auto next = shapes_.nearest({h.position, way / far, h.shape});
                return next.light != reference::nothing || next.t >= 0.98 * far;
            });
        }

        reference::geometry shapes_;
        std::vector<dvec3> lamps_;
    };
} // namespace

chosen_camera default_camera(const scene& s)
{
    const chosen_camera outside{camera_outside(subject_of(s)), false};
    if (!s.environment_lights.empty() || !s.directional_lights.empty())
        return outside;
    const onlooker looks(s);
    auto best = outside;
    int most = looks.count_lit(outside.view);
    if (most > 0)
        return outside;
    const auto b = bounds_of(s);
    const dvec3 middle = 0.5 * (b.low + b.high), half = 0.5 * (b.high - b.low);
    for (const double x : {0.9, -0.9})
        for (const double z : {0.9, -0.9}) {
            camera c;
            c.vertical_fov = 70;
            c.position = middle + half * dvec3(x, 0.2, z);
            c.look_at = middle - half * dvec3(0.3 * x, 0.1, 0.3 * z);
            if (const int lit = looks.count_lit(c); lit > most) {
                most = lit;
                best = {c, true};
            }
        }
    return best;
}

} // namespace photongrid
