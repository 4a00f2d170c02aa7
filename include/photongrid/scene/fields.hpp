// The members of shapes and lights by name. Readers, writers and editors of scenes iterate over them, so that none of
// them lists the kinds of shapes.
#pragma once

#include <photongrid/scene/check.hpp>

#include <tuple>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// The physical quantity of a member, which determines how files and editors treat it.
enum class quantity {
    point,     ///< m; moves with the shape or light
    points,    ///< m; std::vector<dvec3>
    edge,      ///< m; difference of two points
    direction, ///< of any length above 0
    length,    ///< m, above 0
    power,     ///< W, rgb
    angle,     ///< degrees
    emission,  ///< rgb; W/m^2 or W/(m^2 sr), in scene files too, whatever their units
};

/// A member of Part.
template <class Part, class Value>
struct field {
    const char* name;    ///< in C++ and in scene files
    Value Part::*member; ///< the member
    quantity of;         ///< its quantity
};
/// For clang 14, which does not deduce the arguments of aggregates.
template <class Part, class Value>
field(const char*, Value Part::*, quantity) -> field<Part, Value>;

/// The properties of a kind of shape that the library needs. Each shape has a specialisation:
/// - `name`, in scene files and for people; `list`, the member of `scene` that holds such shapes;
/// - `number`, below kernels::SCENE_TABLES: the SWITCH and the table of its kernel code (trace/intersect/);
/// - `fields`, a tuple of `field`: all members but the material;
/// - `add_bounds(bounds, shape)`; `size(shape)`, m, which single precision must resolve;
/// - `round_size(shape)`, m: largest distance of a computed point from the record's position, if roots or axes are
///   involved; else 0;
/// - `steps(shape)`, if its kernel code loops: the most loop iterations of a ray, for devices that limit them;
/// - `write(writer, shape)`: writes its records for the kernels;
/// - `extent(shape)`, m, if files must limit more than radii: its axis, or its shortest edge.
template <class Shape>
struct shape_kind;

/// The properties of a kind of light that the library needs: `name`, `list`, `fields` (all members but the light's
/// name, the surface of a mesh, and the picture of an environment) and `add_bounds` as in shape_kind; `number`, its
/// SWITCH in kernels, and `switches`, all those that it needs; `samples`: how they differ;
/// `write_record`, for its kernel code (trace/lights/); `ball(record)`, which holds it, if it has an extent, and then
/// `size` and `extent`; `power_into(box, light)`, W, rgb, if it is outside of the scene and has no `power`.
template <class Light>
struct light_kind;

/// Calls f(field) for each of `fields`.
template <class Fields, class F>
void for_each_field(const Fields& fields, F&& f)
{
    std::apply([&](const auto&... each) { (f(each), ...); }, fields);
}

namespace detail {
    /// Moves a shape or light with these fields, and the mesh that is its surface if it has one.
    template <class Part, class Fields>
    void move_points(Part& part, const Fields& fields, const dvec3& by)
    {
        for_each_field(fields, [&](const auto& f) {
            auto& value = part.*f.member;
            if constexpr (requires { value.size(); }) {
                for (auto& p : value)
                    p += by;
            } else if constexpr (requires { value += by; }) {
                if (f.of == quantity::point)
                    value += by;
            }
        });
        if constexpr (requires { part.surface.offset; })
            part.surface.offset += by;
    }
} // namespace detail

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
