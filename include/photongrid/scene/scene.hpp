// What goes into a picture: shapes, materials, lights, a camera, and how to render them. Plain data in double precision
// and SI units; nothing here knows a device or a file. docs/guide/scenes.md shows the scene files.
#pragma once

#include <photongrid/scene/box.hpp>
#include <photongrid/scene/camera.hpp>
#include <photongrid/scene/cone.hpp>
#include <photongrid/scene/cylinder.hpp>
#include <photongrid/scene/disk.hpp>
#include <photongrid/scene/lights.hpp>
#include <photongrid/scene/material.hpp>
#include <photongrid/scene/paraboloid.hpp>
#include <photongrid/scene/polygon.hpp>
#include <photongrid/scene/setting_table.hpp>
#include <photongrid/scene/sphere.hpp>

#include <string_view>

#include <photongrid/backend/exact_begin.hpp>

namespace photongrid {

/// A scene. `render` holds the settings that its file asks for; a program may change them.
struct scene {
    std::string name;                              ///< free; the program names pictures after it
    photongrid::camera camera;                     ///< the view that render() draws
    std::vector<material> materials;               ///< shapes name them by index; one at least that is Lambertian
    std::vector<sphere> spheres;                   ///< balls of glass must not overlap
    std::vector<cylinder> cylinders;               ///< open
    std::vector<cone> cones;                       ///< open
    std::vector<paraboloid> paraboloids;           ///< open
    std::vector<disk> disks;                       ///< Lambertian ones are so on both sides
    std::vector<box> boxes;                        ///< closed; those of glass must not overlap
    std::vector<polygon> polygons;                 ///< Lambertian ones are so on both sides
    std::vector<point_light> point_lights;         ///< a scene has one light at least, of either kind
    std::vector<rectangle_light> rectangle_lights; ///< the eye sees them
    render_settings render;                        ///< what the scene's file asks for

    bool operator==(const scene&) const = default; ///< of every member
};

/// The shapes of a scene, one row for each kind (shape_kind). Rows of one `number` follow each other. Polygons come
/// last, since the surfaces of rectangle lights come after them.
template <class Scene>
constexpr auto shape_lists(Scene& s)
{
    return std::tie(s.spheres, // clang-format off
        s.cylinders,
        s.cones,
        s.paraboloids,
        s.disks,
        s.boxes,
        s.polygons); // clang-format on
}

/// The lights of a scene, one row for each kind (light_kind). Lights are numbered in this order; rectangles come first,
/// so that the n-th rectangle is light n.
template <class Scene>
constexpr auto light_lists(Scene& s)
{
    return std::tie(s.rectangle_lights, s.point_lights);
}

namespace detail {
    /// What a list of shapes or lights holds.
    template <class List>
    using item_of = typename std::remove_cvref_t<List>::value_type;
} // namespace detail

/// Calls f(list, kind) for each list of shapes; decltype(kind) is shape_kind<...> of what it holds.
template <class Scene, class F>
void for_each_shape(Scene& s, F&& f)
{
    std::apply(
        [&](auto&... lists) { (f(lists, shape_kind<detail::item_of<decltype(lists)>>{}), ...); }, shape_lists(s));
}

/// Calls f(list, kind) for each list of lights; decltype(kind) is light_kind<...> of what it holds.
template <class Scene, class F>
void for_each_light(Scene& s, F&& f)
{
    std::apply(
        [&](auto&... lists) { (f(lists, light_kind<detail::item_of<decltype(lists)>>{}), ...); }, light_lists(s));
}

/// How many shapes a scene has.
inline std::size_t count_shapes(const scene& s)
{
    std::size_t n = 0;
    for_each_shape(s, [&](const auto& list, auto) { n += list.size(); });
    return n;
}

/// How many lights a scene has.
inline std::size_t count_lights(const scene& s)
{
    std::size_t n = 0;
    for_each_light(s, [&](const auto& list, auto) { n += list.size(); });
    return n;
}

/// True where light goes the same ways in both scenes: same materials, shapes and lights.
inline bool same_light_paths(const scene& a, const scene& b)
{
    return a.materials == b.materials && shape_lists(a) == shape_lists(b) && light_lists(a) == light_lists(b);
}

namespace detail {
    /// Calls visit(shape, list, index) for each body of glass; `list` is its name.
    template <class F>
    void for_each_glass(const scene& s, F&& visit)
    {
        for_each_shape(s, [&](const auto& list, auto kind) {
            for (std::size_t i = 0; i < list.size(); ++i)
                if (s.materials[list[i].material].kind == material_kind::glass)
                    visit(list[i], std::string_view(kind.list), i);
        });
    }

    /// Glass surfaces have air outside, whatever is there: light is followed through one dielectric at a time.
    inline void require_glass_apart(const scene& s)
    {
        const auto named
            = [](std::string_view list, std::size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; };
        for_each_glass(s, [&](const auto& a, std::string_view list, std::size_t i) {
            bool earlier = true; // each pair once
            for_each_glass(s, [&](const auto& b, std::string_view other, std::size_t j) {
                earlier = earlier && !(other == list && j == i);
                if constexpr (requires { overlaps(a, b); })
                    if (earlier && overlaps(a, b))
                        throw std::invalid_argument(named(list, i) + ": overlaps " + named(other, j)
                            + ", and both are glass; light is followed through one glass body at a time, so move them "
                              "apart");
            });
        });
    }

    template <class Parts>
    void check_all(const char* list, const Parts& parts, std::size_t materials)
    {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            try {
                check(parts[i]);
                if constexpr (requires { parts[i].material; })
                    require(parts[i].material < materials, "material: no such material");
            } catch (const std::invalid_argument& e) {
                throw std::invalid_argument(std::string(list) + "[" + std::to_string(i) + "]." + e.what());
            }
        }
    }
} // namespace detail

/// Checks a whole scene, its parts and their references. A scene file's reader checks part by part and adds the place.
/// \throws std::invalid_argument "part[index].member: what is wrong"; also for a scene without lights, or bodies of
/// glass that overlap.
inline void check(const scene& s)
{
    detail::check_all("materials", s.materials, s.materials.size());
    const auto all = [&](const auto& list, auto kind) { detail::check_all(kind.list, list, s.materials.size()); };
    for_each_shape(s, all);
    for_each_light(s, all);
    detail::require(count_lights(s) > 0, "lights: the scene has none");
    detail::require_glass_apart(s);
    check(s.camera);
    check(s.render);
}

} // namespace photongrid

#include <photongrid/backend/exact_end.hpp>
