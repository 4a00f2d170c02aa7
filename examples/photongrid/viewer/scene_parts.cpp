#include "scene_parts.hpp"

#include <photongrid/reference/intersect.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace photongrid::viewer {

namespace {
    /// Which polygons share a corner with which, directly or by others: a number for each polygon, the same in a group.
    std::vector<std::size_t> groups_of(const std::vector<polygon>& polygons)
    {
        std::vector<std::size_t> group(polygons.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        const auto root = [&](std::size_t i) {
            while (group[i] != i)
                i = group[i];
            return i;
        };
        struct corner {
            dvec3 at;
            std::size_t polygon;
        };
        std::vector<corner> corners;
        for (std::size_t i = 0; i < polygons.size(); ++i)
            for (const auto& v : polygons[i].vertices)
                corners.push_back({v, i});
        const auto less = [](const corner& a, const corner& b) {
            return std::tie(a.at.x, a.at.y, a.at.z) < std::tie(b.at.x, b.at.y, b.at.z);
        };
        std::sort(corners.begin(), corners.end(), less);
        for (std::size_t i = 1; i < corners.size(); ++i)
            if (corners[i].at == corners[i - 1].at)
                group[root(corners[i].polygon)] = root(corners[i - 1].polygon);
        for (std::size_t i = 0; i < group.size(); ++i)
            group[i] = root(i);
        return group;
    }

    std::string named(const char* kind, const scene& s, std::uint32_t material)
    {
        const auto& name = s.materials.at(material).name;
        return name.empty() ? kind : std::string(kind) + ", " + name;
    }
} // namespace

std::vector<scene_part> parts_of(const scene& s)
{
    std::vector<scene_part> parts;
    const auto each = [&](const auto& shapes, const char* kind, auto member) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            scene_part p;
            (p.*member).push_back(i);
            p.name = named(kind, s, shapes[i].material);
            parts.push_back(std::move(p));
        }
    };
    each(s.spheres, "sphere", &scene_part::spheres);
    each(s.cylinders, "cylinder", &scene_part::cylinders);
    each(s.cones, "cone", &scene_part::cones);
    each(s.paraboloids, "paraboloid", &scene_part::paraboloids);
    each(s.disks, "disk", &scene_part::disks);
    const auto groups = groups_of(s.polygons);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        scene_part p;
        for (std::size_t i = 0; i < groups.size(); ++i)
            if (groups[i] == g)
                p.polygons.push_back(i);
        if (p.polygons.empty())
            continue;
        p.name = named(p.polygons.size() == 1 ? "polygon" : (std::to_string(p.polygons.size()) + " polygons").c_str(),
            s, s.polygons[p.polygons[0]].material);
        parts.push_back(std::move(p));
    }
    const auto lights = [&](const auto& all, const char* kind, auto member) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            scene_part p;
            (p.*member).push_back(i);
            p.name = all[i].name.empty() ? kind : all[i].name;
            parts.push_back(std::move(p));
        }
    };
    lights(s.point_lights, "point light", &scene_part::point_lights);
    lights(s.rectangle_lights, "rectangle light", &scene_part::rectangle_lights);
    return parts;
}

void move(scene& s, const scene_part& part, const dvec3& by)
{
    for (const auto i : part.spheres)
        s.spheres.at(i).center += by;
    for (const auto i : part.cylinders)
        s.cylinders.at(i).base += by, s.cylinders[i].top += by;
    for (const auto i : part.cones)
        s.cones.at(i).base += by, s.cones[i].apex += by;
    for (const auto i : part.paraboloids)
        s.paraboloids.at(i).vertex += by, s.paraboloids[i].rim += by;
    for (const auto i : part.disks)
        s.disks.at(i).center += by;
    for (const auto i : part.polygons)
        for (auto& v : s.polygons.at(i).vertices)
            v += by;
    for (const auto i : part.point_lights)
        s.point_lights.at(i).position += by;
    for (const auto i : part.rectangle_lights)
        s.rectangle_lights.at(i).corner += by;
}

sight_line sight_line_at(const camera& c, double width, double height, double x, double y)
{
    const auto [forward, right, up] = photongrid::detail::camera_axes(c);
    const double reach = std::tan(glm::radians(c.vertical_fov) / 2);
    return {c.position,
        glm::normalize(
            forward + (2 * x / width - 1) * reach * width / height * right + (1 - 2 * y / height) * reach * up)};
}

std::optional<grip> pick(
    const scene& s, const std::vector<scene_part>& parts, double width, double height, double x, double y)
{
    const reference::geometry shapes(s);
    const auto line = sight_line_at(s.camera, width, height, x, y);
    const auto hit = shapes.nearest({line.origin, line.direction});

    // Point lights, by how far their place in the picture is.
    const double pixel = 2 * std::tan(glm::radians(s.camera.vertical_fov) / 2) / height; // at 1 m
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (const auto i : parts[p].point_lights) {
            const dvec3 to = s.point_lights[i].position - line.origin;
            const double along = glm::dot(to, line.direction);
            if (along > 0 && glm::length(to - along * line.direction) <= 12 * pixel * along && along < hit.t)
                return grip{p, s.point_lights[i].position};
        }
    if (hit.shape == reference::nothing)
        return std::nullopt;

    // The reference numbers shapes in this order.
    std::size_t number = hit.shape;
    for (const auto& [count, member] : {std::pair{s.spheres.size(), &scene_part::spheres},
             {s.cylinders.size(), &scene_part::cylinders}, {s.cones.size(), &scene_part::cones},
             {s.paraboloids.size(), &scene_part::paraboloids}, {s.disks.size(), &scene_part::disks},
             {s.polygons.size(), &scene_part::polygons}, {s.rectangle_lights.size(), &scene_part::rectangle_lights}}) {
        if (number >= count) {
            number -= count;
            continue;
        }
        for (std::size_t p = 0; p < parts.size(); ++p)
            if (const auto& of_kind = parts[p].*member;
                std::find(of_kind.begin(), of_kind.end(), number) != of_kind.end())
                return grip{p, hit.position};
        break;
    }
    return std::nullopt;
}

std::optional<dvec3> on_plane(const camera& c, const sight_line& line, const dvec3& point, bool level)
{
    const dvec3 forward = glm::normalize(c.look_at - c.position);
    const dvec3 normal = level ? glm::normalize(c.up) : forward;
    const double across = glm::dot(line.direction, normal);
    if (std::abs(across) < 1e-6)
        return std::nullopt;
    const double t = glm::dot(point - line.origin, normal) / across;
    const double distance = glm::length(point - line.origin);
    if (!(t > 0) || t > 20 * distance)
        return std::nullopt;
    return line.origin + t * line.direction;
}

} // namespace photongrid::viewer
