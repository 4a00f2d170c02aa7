#include "scene_parts.hpp"

#include <photongrid/reference/intersect.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace photongrid::viewer {

namespace {
    /// Groups of polygons connected by shared corners: a number for each polygon, the same within a group.
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

namespace {
    /// Polygons that share corners are one part.
    void add_polygons(std::vector<scene_part>& parts, const scene& s, std::size_t list)
    {
        const auto groups = groups_of(s.polygons);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            scene_part p;
            for (std::size_t i = 0; i < groups.size(); ++i)
                if (groups[i] == g)
                    p.items.push_back({list, i});
            if (p.items.empty())
                continue;
            p.name = named(p.items.size() == 1 ? "polygon" : (std::to_string(p.items.size()) + " polygons").c_str(), s,
                s.polygons[p.items[0].index].material);
            parts.push_back(std::move(p));
        }
    }
} // namespace

std::vector<scene_part> parts_of(const scene& s)
{
    std::vector<scene_part> parts;
    for_each_list(s, [&](const auto& list, auto kind, std::size_t number) {
        using item = typename std::decay_t<decltype(list)>::value_type;
        if constexpr (std::is_same_v<item, polygon>) {
            add_polygons(parts, s, number);
        } else {
            for (std::size_t i = 0; i < list.size(); ++i) {
                scene_part p{{{number, i}}};
                if constexpr (requires { list[i].material; })
                    p.name = named(kind.name, s, list[i].material);
                else
                    p.name = list[i].name.empty() ? std::string(kind.name) + " light" : list[i].name;
                parts.push_back(std::move(p));
            }
        }
    });
    return parts;
}

void move(scene& s, const scene_part& part, const dvec3& by)
{
    for_each_item(s, part, [&](auto& item, auto kind) { photongrid::detail::move_points(item, kind.fields, by); });
}

sight_line sight_line_at(const camera& c, double width, double height, double x, double y)
{
    const auto [forward, right, up] = photongrid::detail::camera_axes(c);
    const double half_height = std::tan(glm::radians(c.vertical_fov) / 2);
    return {c.position,
        glm::normalize(forward + (2 * x / width - 1) * half_height * width / height * right
            + (1 - 2 * y / height) * half_height * up)};
}

std::optional<grip> pick(
    const scene& s, const std::vector<scene_part>& parts, double width, double height, double x, double y)
{
    const reference::geometry shapes(s);
    const auto line = sight_line_at(s.camera, width, height, x, y);
    const auto hit = shapes.nearest({line.origin, line.direction});

    // Lights at a point, by the distance of their position in the picture.
    const double pixel = 2 * std::tan(glm::radians(s.camera.vertical_fov) / 2) / height; // at 1 m
    const auto is_near = [&](const dvec3& position) {
        const dvec3 to = position - line.origin;
        const double along = glm::dot(to, line.direction);
        return along > 0 && glm::length(to - along * line.direction) <= 12 * pixel * along && along < hit.t;
    };
    for (std::size_t p = 0; p < parts.size(); ++p) {
        std::optional<grip> found;
        for_each_light(s, [&](const auto& list, auto) {
            using light = typename std::decay_t<decltype(list)>::value_type;
            if constexpr (requires(const light& l) { l.position; })
                for (const auto* l : items_of<light>(s, parts[p]))
                    if (!found && is_near(l->position))
                        found = grip{p, l->position};
        });
        if (found)
            return found;
    }
    if (hit.shape == reference::nothing)
        return std::nullopt;

    // The reference numbers shapes and the surfaces of lights in the order of the lists; of meshes it numbers
    // triangles.
    std::size_t before = 0;
    std::optional<scene_item> hit_item;
    for_each_list(s, [&](const auto& list, auto, std::size_t number) {
        using item = typename std::decay_t<decltype(list)>::value_type;
        for (std::size_t i = 0; i < list.size() && !hit_item; ++i) {
            if constexpr (std::is_same_v<item, placed_mesh>)
                before += list[i].surface->triangles.size();
            else if constexpr (std::is_same_v<item, mesh_light>)
                before += list[i].surface.surface->triangles.size();
            else if constexpr (
                requires { list[i].material; } || requires { surface_of(list[i]); })
                ++before;
            if (hit.shape < before)
                hit_item = scene_item{number, i};
        }
    });
    for (std::size_t p = 0; p < parts.size(); ++p)
        if (hit_item && std::find(parts[p].items.begin(), parts[p].items.end(), *hit_item) != parts[p].items.end())
            return grip{p, hit.position};
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

std::optional<picture_box> box_of(const scene& s, const scene_part& part, double width, double height)
{
    bounds b;
    for_each_item(s, part, [&](const auto& item, auto kind) { kind.add_bounds(b, item); });
    if (b.empty())
        return std::nullopt; // light from outside of the scene
    const auto& c = s.camera;
    const auto [forward, right, up] = photongrid::detail::camera_axes(c);
    const double half_height = std::tan(glm::radians(c.vertical_fov) / 2);
    picture_box f;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 to
            = dvec3(corner & 1 ? b.high.x : b.low.x, corner & 2 ? b.high.y : b.low.y, corner & 4 ? b.high.z : b.low.z)
            - c.position;
        const double depth = glm::dot(to, forward);
        if (depth <= 0)
            return std::nullopt;
        const double x = 0.5 * width + 0.5 * height * glm::dot(to, right) / (depth * half_height),
                     y = 0.5 * height - 0.5 * height * glm::dot(to, up) / (depth * half_height);
        f.left = std::min(f.left, x), f.right = std::max(f.right, x), f.top = std::min(f.top, y),
        f.bottom = std::max(f.bottom, y);
    }
    return f;
}

} // namespace photongrid::viewer
