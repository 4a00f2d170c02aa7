// The members of a scene's shapes and lights by name: what readers, writers and editors of scenes go through, so that
// none of them lists the kinds of shapes.
#pragma once

#include <photongrid/scene/check.hpp>

#include <tuple>
#include <vector>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// What a member says, and so how files and editors treat it.
enum class quantity {
    point,     ///< m; moves with its part
    points,    ///< m; several, a std::vector<dvec3>
    edge,      ///< m; from one point to another
    direction, ///< of any length above 0
    length,    ///< m, above 0
    power,     ///< W, rgb
};

/// A member of Part.
template <class Part, class Value>
struct field {
    const char* name;      ///< in C++ and in scene files
    Value Part::*member;   ///< where it is
    quantity what_it_says; ///< of the member's number or numbers
};
/// As clang 14 needs it: it deduces no aggregate's arguments.
template <class Part, class Value>
field(const char*, Value Part::*, quantity) -> field<Part, Value>;

/// What the library must know of a kind of shape. A specialisation stands beside each shape:
/// - `name`, in scene files and for people; `list`, the member of `scene` that holds such shapes;
/// - `number`, below kernels::SCENE_TABLES: SWITCH and table of the kernels' shape that draws it (trace/intersect/);
/// - `fields`, a tuple of `field`; all but the material;
/// - `add_bounds(bounds, shape)`; `size(shape)`, m, which single precision must resolve; `round_size(shape)`, m: how
/// far
///   from the place in its record the coordinates of its points reach, where they are computed with roots or by axes;
///   else 0;
/// - `write(writer, shape)`: its records, as the kernels read them;
/// - `extent(shape)`, m, where files must limit more than radii: its axis, or its least edge.
template <class Shape>
struct shape_kind;

/// What the library must know of a kind of light: `name`, `list` and `fields` as in shape_kind, all but the light's own
/// name; `add_bounds`; `write_record`, as trace/lights.glsl reads it; `size` and `extent` where it has any.
template <class Light>
struct light_kind;

/// Calls f(field) for each of `fields`.
template <class Fields, class F>
void for_each_field(const Fields& fields, F&& f)
{
    std::apply([&](const auto&... each) { (f(each), ...); }, fields);
}

namespace detail {
    /// Moves a shape or light whose fields these are.
    template <class Part, class Fields>
    void move_points(Part& part, const Fields& fields, const dvec3& by)
    {
        for_each_field(fields, [&](const auto& f) {
            auto& value = part.*f.member;
            if constexpr (requires { value.size(); }) {
                for (auto& p : value)
                    p += by;
            } else if constexpr (requires { value += by; }) {
                if (f.what_it_says == quantity::point)
                    value += by;
            }
        });
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
