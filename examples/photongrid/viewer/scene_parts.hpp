// What a user can take hold of in a scene: its shapes, polygons that share corners as one, and its lights.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace photongrid::viewer {

/// A shape or a light of the scene: a list, numbered as shape_lists() and then light_lists() have them, and its place
/// there.
struct scene_item {
    std::size_t list = 0;  ///< number of the list
    std::size_t index = 0; ///< in the list

    bool operator==(const scene_item&) const = default; ///< of every member
};

/// Shapes and lights that move together.
struct scene_part {
    std::vector<scene_item> items{}; ///< one at least
    std::string name{};              ///< what it is, and its material or its own name

    bool operator==(const scene_part&) const = default; ///< of every member
};

/// Calls f(list, kind, number) for each list of shapes and of lights (shape_kind, light_kind).
template <class Scene, class F>
void for_each_list(Scene& s, F&& f)
{
    std::size_t number = 0;
    const auto next = [&](auto& list, auto kind) { f(list, kind, number++); };
    for_each_shape(s, next);
    for_each_light(s, next);
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

/// Those of a part's shapes or lights that are a T.
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

/// Everything in the scene, each thing in one part.
std::vector<scene_part> parts_of(const scene& s);

/// Moves a part by `by`, m.
void move(scene& s, const scene_part& part, const dvec3& by);

/// A place in the picture, and what is seen there.
struct grip {
    std::size_t part = 0; ///< index into parts_of(scene)
    dvec3 position{0};    ///< m; where it is met
};

/// A rectangle of the picture's pixels.
struct picture_box {
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
};

/// Where a part of the scene stands in a picture of width x height pixels; nothing where some of it is behind the
/// camera.
std::optional<picture_box> box_of(const scene& s, const scene_part& part, double width, double height);

/// A ray of the camera's, through a point of a picture.
struct sight_line {
    dvec3 origin{0};          ///< m
    dvec3 direction{0, 0, 1}; ///< unit
};

/// Through (x, y) of a picture of width x height: 0, 0 is its top left corner, width, height the other one.
sight_line sight_line_at(const camera& c, double width, double height, double x, double y);

/// What is seen at (x, y); point lights, which no ray meets, within 12 pixels of it and not hidden. Nothing where there
/// is none.
std::optional<grip> pick(
    const scene& s, const std::vector<scene_part>& parts, double width, double height, double x, double y);

/// Where a line of sight meets the plane through `point` that faces the camera, or with `level` the one at right angles
/// to `up`; in the latter, which may be seen from its edge, nothing where it is met behind the camera or very far away.
std::optional<dvec3> on_plane(const camera& c, const sight_line& line, const dvec3& point, bool level);

} // namespace photongrid::viewer
