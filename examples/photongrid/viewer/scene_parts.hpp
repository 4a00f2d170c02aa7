// What a user can take hold of in a scene: its shapes, polygons that share corners as one, and its lights.
#pragma once

#include <photongrid/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace photongrid::viewer {

/// Shapes and lights that move together: indices into the scene's vectors.
struct scene_part {
    std::vector<std::size_t> spheres{}, cylinders{}, cones{}, paraboloids{}, disks{}, polygons{}, point_lights{},
        rectangle_lights{};
    std::string name{}; ///< what it is, and its material or its own name

    bool operator==(const scene_part&) const = default; ///< of every member
};

/// Everything in the scene, each thing in one part.
std::vector<scene_part> parts_of(const scene& s);

/// Moves a part by `by`, m.
void move(scene& s, const scene_part& part, const dvec3& by);

/// A place in the picture, and what is seen there.
struct grip {
    std::size_t part = 0; ///< index into parts_of(scene)
    dvec3 position{0};    ///< m; where it is met
};

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
