// A scene relative to a point of it, so that one that is moved has the same records (scene_records.hpp).
#pragma once

#include <photongrid/scene/scene.hpp>

#include <optional>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid::detail {

/// The scene moved by -by.
inline scene moved_back(scene s, const dvec3& by)
{
    const auto move = [&](auto& list, auto kind) {
        for (auto& x : list)
            move_points(x, kind.fields, -by);
    };
    for_each_shape(s, move);
    for_each_light(s, move);
    move(s.meshes, shape_kind<placed_mesh>{});
    s.camera.position -= by;
    s.camera.look_at -= by;
    return s;
}

/// Reference point for recentring: the first light's first point, or else the first shape's, so a translated scene
/// yields the same records.
inline dvec3 anchor(const scene& s)
{
    std::optional<dvec3> first;
    const auto look = [&](const auto& list, auto kind) {
        if (list.empty() || first)
            return;
        if constexpr (requires { corners_of(list[0], 0); })
            first = corners_of(list[0], 0)[0];
        else if constexpr (requires { list[0].surface; })
            first = corners_of(list[0].surface, 0)[0];
        else
            for_each_field(kind.fields, [&](const auto& f) {
                const auto& value = list[0].*f.member;
                if constexpr (requires { first = value; })
                    first = f.of == quantity::point && !first ? value : first;
                else if constexpr (requires { first = value.front(); })
                    first = value.front();
            });
    };
    for_each_light(s, look);
    for_each_shape(s, look);
    look(s.meshes, shape_kind<placed_mesh>{});
    return first.value_or(dvec3(0));
}

} // namespace photongrid::detail

#include <photongrid/core/exact_end.hpp>
