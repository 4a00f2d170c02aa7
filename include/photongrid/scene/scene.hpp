// Scenes: shapes, materials, lights, a camera and render settings. Plain data in double precision and SI units,
// independent of devices and files. docs/guide/scenes.md describes scene files.
#pragma once

#include <photongrid/scene/box.hpp>
#include <photongrid/scene/camera.hpp>
#include <photongrid/scene/cone.hpp>
#include <photongrid/scene/cylinder.hpp>
#include <photongrid/scene/disk.hpp>
#include <photongrid/scene/distant_lights.hpp>
#include <photongrid/scene/lights.hpp>
#include <photongrid/scene/material.hpp>
#include <photongrid/scene/mixture.hpp>
#include <photongrid/scene/paraboloid.hpp>
#include <photongrid/scene/placed_mesh.hpp>
#include <photongrid/scene/polygon.hpp>
#include <photongrid/scene/setting_table.hpp>
#include <photongrid/scene/sphere.hpp>
#include <photongrid/scene/sphere_light.hpp>
#include <photongrid/scene/spot_light.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A scene. `render` has the settings of its file, which a program may override.
struct scene {
    std::string name;                              ///< any text; the program names pictures after it
    photongrid::camera camera;                     ///< the view that render() draws
    std::vector<material> materials;               ///< shapes refer to them by index; at least one is Lambertian
    std::vector<sphere> spheres;                   ///< those of one glass must not overlap
    std::vector<cylinder> cylinders;               ///< open
    std::vector<cone> cones;                       ///< open
    std::vector<paraboloid> paraboloids;           ///< open
    std::vector<disk> disks;                       ///< two-sided if Lambertian
    std::vector<box> boxes;                        ///< closed; those of one glass must not overlap
    std::vector<polygon> polygons;                 ///< two-sided if Lambertian
    std::vector<placed_mesh> meshes;               ///< two-sided if Lambertian; closed if glass
    std::vector<point_light> point_lights;         ///< a scene has at least one light of any kind
    std::vector<rectangle_light> rectangle_lights; ///< visible to the camera
    std::vector<mesh_light> mesh_lights;           ///< visible to the camera
    std::vector<sphere_light> sphere_lights;       ///< visible to the camera
    std::vector<spot_light> spot_lights;
    std::vector<directional_light> directional_lights;
    std::vector<environment_light> environment_lights; ///< at most one; visible to the camera
    render_settings render;                            ///< the settings of the scene's file
    std::optional<render_settings> paper;              ///< settings for --as-paper; empty: as_paper(render)

    bool operator==(const scene&) const = default;
};

/// The settings that draw a scene by the paper's method: as_paper(render), unless the scene has its own.
inline render_settings as_paper(const scene& s) { return s.paper ? *s.paper : as_paper(s.render); }

/// The lists of shapes of a scene, one per kind (shape_kind). Lists with the same `number` are consecutive. Polygons
/// come last, because the surfaces of rectangle lights follow them.
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

/// The lists of lights of a scene, one per kind (light_kind). Lights are numbered in this order; rectangles come first,
/// so that the n-th rectangle is light n. The environment comes last.
template <class Scene>
constexpr auto light_lists(Scene& s)
{
    return std::tie(s.rectangle_lights, // clang-format off
        s.point_lights,
        s.sphere_lights,
        s.mesh_lights,
        s.spot_lights,
        s.directional_lights,
        s.environment_lights); // clang-format on
}

namespace detail {
    /// The element type of a list of shapes or lights.
    template <class List>
    using item_of = typename std::remove_cvref_t<List>::value_type;
} // namespace detail

/// Calls f(list, kind) for each list of shapes; decltype(kind) is the shape_kind of its elements.
template <class Scene, class F>
void for_each_shape(Scene& s, F&& f)
{
    std::apply(
        [&](auto&... lists) { (f(lists, shape_kind<detail::item_of<decltype(lists)>>{}), ...); }, shape_lists(s));
}

/// Calls f(list, kind) for each list of lights; decltype(kind) is the light_kind of its elements.
template <class Scene, class F>
void for_each_light(Scene& s, F&& f)
{
    std::apply(
        [&](auto&... lists) { (f(lists, light_kind<detail::item_of<decltype(lists)>>{}), ...); }, light_lists(s));
}

namespace detail {
    template <class... Lists>
    constexpr auto shape_numbers(const std::tuple<Lists...>*)
    {
        return std::array{shape_kind<item_of<Lists>>::number...};
    }
    template <class... Lists>
    constexpr auto light_numbers(const std::tuple<Lists...>*)
    {
        return std::array{light_kind<item_of<Lists>>::number...};
    }
    constexpr std::uint32_t bits_of(std::span<const std::uint32_t> numbers)
    {
        std::uint32_t bits = 0;
        for (const auto n : numbers)
            bits |= 1u << n;
        return bits;
    }
} // namespace detail

/// The SWITCHes of all kinds of lights.
inline constexpr std::uint32_t all_light_switches
    = detail::bits_of(detail::light_numbers(static_cast<decltype(light_lists(std::declval<scene&>()))*>(nullptr)));

/// The number of shapes of a scene; a mesh is one.
inline std::size_t count_shapes(const scene& s)
{
    std::size_t n = s.meshes.size();
    for_each_shape(s, [&](const auto& list, auto) { n += list.size(); });
    return n;
}

/// Whether a scene has a surface that a ray can hit: a shape, or that of a lamp.
inline bool has_surfaces(const scene& s)
{
    return count_shapes(s) + s.rectangle_lights.size() + s.mesh_lights.size() + s.sphere_lights.size() > 0;
}

/// The number of lights of a scene.
inline std::size_t count_lights(const scene& s)
{
    std::size_t n = 0;
    for_each_light(s, [&](const auto& list, auto) { n += list.size(); });
    return n;
}

/// Whether two scenes have the same light paths: the same materials, shapes and lights.
inline bool same_light_paths(const scene& a, const scene& b)
{
    return a.materials == b.materials && shape_lists(a) == shape_lists(b) && a.meshes == b.meshes
        && light_lists(a) == light_lists(b);
}

/// The bounding box of all shapes and lights of a scene, m.
inline bounds bounds_of(const scene& s)
{
    bounds b;
    const auto add = [&](const auto& list, auto kind) {
        for (const auto& x : list)
            kind.add_bounds(b, x);
    };
    for_each_shape(s, add);
    add(s.meshes, shape_kind<placed_mesh>{});
    for_each_light(s, add);
    return b;
}

/// The box through whose faces distant light enters the scene: its bounds, with a margin around all surfaces.
inline bounds entry_box(const scene& s)
{
    bounds b = bounds_of(s);
    const dvec3 margin(0x1p-11 * glm::length(b.high - b.low));
    b.low -= margin;
    b.high += margin;
    return b;
}

namespace detail {
    /// entry_box, which goes over all triangles, if a light of the scene needs it; else nothing.
    inline bounds box_for_lights(const scene& s)
    {
        return s.directional_lights.empty() && s.environment_lights.empty() ? bounds{} : entry_box(s);
    }

    /// The power of all lights, the sum of the channels, W.
    inline double power_of_lights(const scene& s)
    {
        const bounds box = box_for_lights(s);
        double sum = 0;
        for_each_light(s, [&](const auto& lights, auto kind) {
            for (const auto& l : lights) {
                const dvec3 power = power_of(kind, l, box);
                sum += power.x + power.y + power.z;
            }
        });
        return sum;
    }

    /// The names of a scene's lights, for messages: "'lamp', 'bulb'".
    inline std::string names_of_lights(const scene& s)
    {
        std::string names;
        for_each_light(s, [&](const auto& lights, auto) {
            for (const auto& l : lights)
                names += (names.empty() ? "'" : ", '") + l.name + "'";
        });
        return names;
    }

    /// A shape by its list and its index there, as "spheres" and 1.
    struct shape_place {
        std::string_view list;
        std::size_t index = 0;
        std::string text() const { return std::string(list) + "[" + std::to_string(index) + "]"; }
        bool operator==(const shape_place&) const = default;
    };

    /// Calls visit(shape) for the shape at a place.
    template <class F>
    void visit_shape(const scene& s, const shape_place& place, F&& visit)
    {
        for_each_shape(s, [&](const auto& list, auto kind) {
            if (kind.list == place.list)
                visit(list[place.index]);
        });
    }

    inline bool shapes_overlap(const scene& s, const shape_place& a, const shape_place& b)
    {
        bool overlap = false;
        visit_shape(s, a, [&](const auto& x) {
            visit_shape(s, b, [&](const auto& y) {
                if constexpr (requires { overlaps(x, y); })
                    overlap = overlaps(x, y);
                else if constexpr (requires { overlaps(y, x); })
                    overlap = overlaps(y, x);
            });
        });
        return overlap;
    }

    /// Two bodies of one glass that overlap, the earlier one first, if any do: a ray that leaves one is taken to be
    /// outside of all bodies of that glass. Sorted along the longest axis of all, each body is compared with those
    /// whose bounds meet its own along that axis.
    inline std::optional<std::array<shape_place, 2>> overlapping_glass(const scene& s)
    {
        struct body {
            shape_place place;
            std::size_t number;
            std::uint32_t material;
            bounds box{};
        };
        std::vector<body> bodies;
        bounds all;
        for_each_shape(s, [&](const auto& list, auto kind) {
            if constexpr (requires { overlaps(list[0], list[0]); })
                for (std::size_t i = 0; i < list.size(); ++i)
                    if (refracts(s.materials, s.materials[list[i].material])) {
                        kind.add_bounds(
                            bodies.emplace_back(body{{kind.list, i}, bodies.size(), list[i].material}).box, list[i]);
                        kind.add_bounds(all, list[i]);
                    }
        });
        const dvec3 size = all.high - all.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::sort(bodies.begin(), bodies.end(),
            [axis](const body& a, const body& b) { return a.box.low[axis] < b.box.low[axis]; });
        for (auto a = bodies.begin(); a != bodies.end(); ++a)
            for (auto b = a + 1; b != bodies.end() && b->box.low[axis] <= a->box.high[axis]; ++b)
                if (a->material == b->material && shapes_overlap(s, a->place, b->place))
                    return a->number < b->number ? std::array{a->place, b->place} : std::array{b->place, a->place};
        return std::nullopt;
    }

    /// A shape, or the surface of a lamp, beside others of a scene.
    struct sized_shape {
        shape_place place;
        bounds box{};          ///< m
        double size = 0;       ///< m
        double round_size = 0; ///< of curved ones, m: what rounding on them grows with, wherever they are hit
    };

    /// How large a scene and its shapes are, and the point from which kernels measure.
    struct scene_extent {
        bounds all;             ///< of all shapes and lights
        double scale = 0;       ///< half its diagonal, m
        bool is_even = true;    ///< no shape is smaller than 2^-13 of it, so one bound of rounding errors serves all
        dvec3 center{0};        ///< m; with few bits, so that adding it to another point is exact
        sized_shape smallest{}; ///< of those that kernels must resolve
        std::vector<sized_shape> shapes; ///< all of those; the meshes come last but for lights
        std::vector<bounds> meshes;      ///< their boxes
    };

    /// Lamps that are balls are left out of the shapes: rays start on none, and their rounding is their own.
    inline scene_extent extent_of(const scene& s)
    {
        scene_extent e;
        const auto add = [&](const char* list, std::size_t i, const bounds& box, double size, double round_size) {
            e.shapes.push_back({{list, i}, box, size, round_size});
        };
        for_each_shape(s, [&](const auto& list, auto kind) {
            for (std::size_t i = 0; i < list.size(); ++i) {
                bounds box;
                kind.add_bounds(box, list[i]);
                e.all.add(box);
                const bool is_curved = !std::is_same_v<item_of<decltype(list)>, photongrid::box>;
                add(kind.list, i, box, kind.size(list[i]), is_curved ? kind.round_size(list[i]) : 0);
            }
        });
        const auto add_mesh = [&](const char* list, std::size_t i, const bounds& box) {
            e.all.add(box);
            add(list, i, box, glm::length(box.high - box.low), 0);
        };
        for (const auto& m : s.meshes) {
            shape_kind<placed_mesh>::add_bounds(e.meshes.emplace_back(), m);
            add_mesh(shape_kind<placed_mesh>::list, e.meshes.size() - 1, e.meshes.back());
        }
        for_each_light(s, [&](const auto& list, auto kind) {
            for (std::size_t i = 0; i < list.size(); ++i) {
                bounds box;
                kind.add_bounds(box, list[i]);
                if constexpr (std::is_same_v<item_of<decltype(list)>, mesh_light>)
                    add_mesh(kind.list, i, box);
                else if constexpr (std::is_same_v<item_of<decltype(list)>, rectangle_light>)
                    add(kind.list, i, box, kind.size(list[i]), 0);
                e.all.add(box);
            }
        });
        if (e.shapes.empty())
            return e;
        e.scale = 0.5 * glm::length(e.all.high - e.all.low);
        e.smallest = *std::min_element(e.shapes.begin(), e.shapes.end(),
            [](const sized_shape& a, const sized_shape& b) { return a.size < b.size; });
        e.is_even = e.smallest.size >= e.scale * 0x1p-13;
        const auto& around = e.is_even ? e.all : e.smallest.box;
        const double step = std::exp2(std::floor(std::log2(e.is_even ? e.scale * 0x1p-8 : e.smallest.size)));
        e.center = 0.5 * (around.low + around.high);
        if (step > 0) // else a point is a shape
            e.center = glm::round(e.center / step) * step;
        return e;
    }

    /// The distance between numbers in single precision near x.
    inline double single_step(double x) { return std::exp2(std::floor(std::log2(x)) - 23); }

    /// A shape that single precision cannot resolve, and why.
    struct unresolved_shape {
        shape_place place;
        std::string what;
    };

    /// The first shape that single precision cannot resolve where it is, or on a curved one, if there is any.
    inline std::optional<unresolved_shape> unresolved_in(const scene_extent& e)
    {
        if (e.is_even)
            return std::nullopt;
        const auto largest = [](const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
        const auto found = [](const sized_shape& x, const std::string& where, double step, double steps) {
            return unresolved_shape{x.place,
                "is " + text_of(x.size) + " m large, and single precision has steps of " + text_of(step) + " m " + where
                    + ": it resolves shapes from " + text_of(steps * step)
                    + " m on there; make it larger, bring closer what is far apart, or leave one of them out"};
        };
        for (const auto& x : e.shapes) {
            const double far = std::max(largest(x.box.low - e.center), largest(x.box.high - e.center));
            if (const double step = single_step(far); x.size < 64 * step)
                return found(x, text_of(far) + " m from " + e.smallest.place.text() + ", the smallest", step, 64);
        }
        for (const auto& ground : e.shapes) {
            const double step = ground.round_size > 0 ? single_step(ground.round_size) : 0;
            if (e.smallest.size >= 16 * step)
                continue;
            for (const auto& x : e.shapes) {
                const bool meet = glm::all(glm::lessThanEqual(x.box.low, ground.box.high))
                    && glm::all(glm::lessThanEqual(ground.box.low, x.box.high));
                if (meet && x.size < 16 * step)
                    return found(x, "on " + ground.place.text() + ", whose box it touches", step, 16);
            }
        }
        return std::nullopt;
    }

    inline constexpr const char* no_shape = "shapes: there is none; add one to see";

    /// Light goes straight on through meshes only, and textures need coordinates, which only they have.
    template <class Part>
    void check_material_of(const Part& part, const std::vector<material>& materials)
    {
        const auto& m = materials[part.material];
        constexpr bool is_mesh = requires { part.surface->texture_coordinates; };
        require(is_mesh || !is_clear(m), "material: has an opacity, which only meshes may have");
        require(is_mesh || !any_part(materials, m, [](const material& p) { return is_smooth_pane(p); }),
            "material: is smooth thin glass, which only meshes may be; make it a mesh");
        if constexpr (is_mesh)
            if (!part.surface->texture_coordinates.empty())
                return;
        require(!has_texture(materials, m), "material: has a texture, which needs a mesh with texture coordinates");
    }

    template <class Parts>
    void check_all(const char* list, const Parts& parts, const std::vector<material>& materials)
    {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            try {
                check(parts[i]);
                if constexpr (requires { parts[i].parts; })
                    check_parts(materials, parts[i]);
                if constexpr (requires { parts[i].material; }) {
                    require(
                        parts[i].material < materials.size(), "material: is not an index into the scene's materials");
                    check_material_of(parts[i], materials);
                }
            } catch (const std::invalid_argument& e) {
                throw std::invalid_argument(std::string(list) + "[" + std::to_string(i) + "]." + e.what());
            }
        }
    }
} // namespace detail

/// Checks a whole scene. The reader of scene files checks each part and adds its line.
/// \throws std::invalid_argument "part[index].member: what is wrong"; also for a scene without lights, or for bodies of
///         one glass that overlap (meshes are not compared), or a shape that single precision cannot resolve. Only a
///         photon map needs a Lambertian shape (upload_scene, scene files).
inline void check(const scene& s)
{
    detail::check_all("materials", s.materials, s.materials);
    const auto all = [&](const auto& list, auto kind) { detail::check_all(kind.list, list, s.materials); };
    for_each_shape(s, all);
    detail::check_all("meshes", s.meshes, s.materials);
    for_each_light(s, all);
    detail::require(count_lights(s) > 0, "lights: the scene has none; add at least one");
    detail::require(s.environment_lights.size() <= 1, "environment_lights: the scene has several; keep one");
    if (const auto pair = detail::overlapping_glass(s))
        throw std::invalid_argument((*pair)[1].text() + ": overlaps " + (*pair)[0].text()
            + ", and both are of one glass; move them apart, or give them different materials");
    if (const auto bad = detail::unresolved_in(detail::extent_of(s)))
        throw std::invalid_argument(bad->place.text() + ": " + bad->what);
    check(s.camera);
    check(s.render);
    if (s.paper) {
        try {
            check(*s.paper);
        } catch (const std::invalid_argument& e) {
            throw std::invalid_argument(std::string("paper: ") + e.what());
        }
    }
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
