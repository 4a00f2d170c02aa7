// The parts of a scene that a user can select: its shapes, its lights, and groups of polygons that share corners.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace photongrid::viewer {

/// A shape or a light of the scene: the number of its list, first those of shape_lists(), then those of light_lists(),
/// then the meshes, and its index there.
struct scene_item {
    std::size_t list = 0;  ///< number of the list
    std::size_t index = 0; ///< in the list

    bool operator==(const scene_item&) const = default;
};

/// Shapes and lights that move together.
struct scene_part {
    std::vector<scene_item> items{}; ///< at least one
    std::string name{};              ///< its kind, and its material or its own name

    bool operator==(const scene_part&) const = default;
};

/// Calls f(list, kind, number) for each list of shapes, of lights and of meshes (shape_kind, light_kind).
template <class Scene, class F>
void for_each_list(Scene& s, F&& f)
{
    std::size_t number = 0;
    const auto next = [&](auto& list, auto kind) { f(list, kind, number++); };
    for_each_shape(s, next);
    for_each_light(s, next);
    next(s.meshes, shape_kind<placed_mesh>{});
}

/// Calls f(item, kind) for each shape or light of `part`.
template <class Scene, class F>
void for_each_item(Scene& s, const scene_part& part, F&& f)
{
    for_each_list(s, [&](auto& list, auto kind, std::size_t number) {
        for (const auto& item : part.items)
            if (item.list == number)
                f(list.at(item.index), kind);
    });
}

/// Those of a part's shapes or lights that have type T.
template <class T>
std::vector<const T*> items_of(const scene& s, const scene_part& part)
{
    std::vector<const T*> all;
    for_each_item(s, part, [&](const auto& item, auto) {
        if constexpr (std::is_same_v<std::decay_t<decltype(item)>, T>)
            all.push_back(&item);
    });
    return all;
}

/// All parts of the scene; each shape and light is in exactly one.
std::vector<scene_part> parts_of(const scene& s);

/// Moves a part by `by`, m.
void move(scene& s, const scene_part& part, const dvec3& by);

/// A point of the scene that is visible in the picture, and its part.
struct grip {
    std::size_t part = 0; ///< index into parts_of(scene)
    dvec3 position{0};    ///< m
};

/// A rectangle of the picture's pixels.
struct picture_box {
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
};

/// The outline of a part of the scene in a picture of width x height pixels; empty if some of it is behind the camera,
/// and for light from outside of the scene.
std::optional<picture_box> box_of(const scene& s, const scene_part& part, double width, double height);

/// A camera ray through a point of a picture.
struct sight_line {
    dvec3 origin{0};          ///< m
    dvec3 direction{0, 0, 1}; ///< unit
};

/// Through (x, y) of a picture of width x height: 0, 0 is its top left corner, width, height the other one.
sight_line sight_line_at(const camera& c, double width, double height, double x, double y);

/// The part visible at (x, y). Lights at a point, which no ray can hit, count if they are visible and within 12 pixels.
/// Empty if there is nothing.
std::optional<grip> pick(
    const scene& s, const std::vector<scene_part>& parts, double width, double height, double x, double y);

/// The intersection of a line of sight with the plane through `point` that faces the camera, or with `level` the plane
/// perpendicular to `up`. The latter may be seen edge-on: empty if the intersection is behind the camera or very far
/// away.
std::optional<dvec3> on_plane(const camera& c, const sight_line& line, const dvec3& point, bool level);

} // namespace photongrid::viewer
