// What goes into a picture: shapes, materials, lights, a camera, and how to render them. Plain data in double precision
// and SI units; nothing here knows a device or a file. docs/scenes.md shows the scene files.
#pragma once

#include <photongrid/estimate_settings.hpp>

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace photongrid {

/// Double precision, as all of a scene is: m, W or a direction.
using glm::dvec3;

/// How a surface answers light. `metal` is a mirror with a colour.
enum class material_kind { lambertian, mirror, metal, glass };

/// A material. Reflectance per channel (rgb), 0 to 1; for glass it is the transmittance of each crossing (1: clear).
struct material {
    std::string name;                               ///< free; in a scene file, the key that shapes name it by
    material_kind kind = material_kind::lambertian; ///< what `reflectance` means
    dvec3 reflectance{0.5};                         ///< rgb, 0 to 1: see above
    double index_of_refraction = 1.5;               ///< glass only, 1 to 10; air, 1, is outside

    bool operator==(const material&) const = default; ///< of every member
};

/// A sphere. Lengths in m here and below; `material` is an index into scene::materials.
struct sphere {
    dvec3 center{0};            ///< m
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const sphere&) const = default; ///< of every member
};

/// The side of a cylinder, open at both ends.
struct cylinder {
    dvec3 base{0};              ///< m; the middle of one end
    dvec3 top{0, 1, 0};         ///< m; the middle of the other
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const cylinder&) const = default; ///< of every member
};

/// The side of a cone, open at its base.
struct cone {
    dvec3 base{0};              ///< m; the middle of the open end
    dvec3 apex{0, 1, 0};        ///< m
    double radius = 1;          ///< m, above 0; at the base
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const cone&) const = default; ///< of every member
};

/// A paraboloid of revolution from its vertex to its rim, open at the rim.
struct paraboloid {
    dvec3 vertex{0};            ///< m; the deepest point
    dvec3 rim{0, 1, 0};         ///< m; centre of the rim
    double radius = 1;          ///< m, above 0; of the rim
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const paraboloid&) const = default; ///< of every member
};

/// A flat disk, with both of its sides.
struct disk {
    dvec3 center{0};            ///< m
    dvec3 normal{0, 1, 0};      ///< of any length above 0
    double radius = 1;          ///< m, above 0
    std::uint32_t material = 0; ///< index into scene::materials

    bool operator==(const disk&) const = default; ///< of every member
};

/// A convex polygon (a triangle has three vertices), planar, vertices in order round it.
struct polygon {
    std::vector<dvec3> vertices; ///< m; 3 or more
    std::uint32_t material = 0;  ///< index into scene::materials

    bool operator==(const polygon&) const = default; ///< of every member
};

/// A point light: power (W, rgb) sent out evenly in all directions.
struct point_light {
    std::string name;  ///< for messages
    dvec3 position{0}; ///< m
    dvec3 power{1};    ///< W, rgb; no channel below 0, one above

    bool operator==(const point_light&) const = default; ///< of every member
};

/// A rectangle that sends power (W, rgb) out diffusely on the side of cross(edge_u, edge_v); its own surface is black.
struct rectangle_light {
    std::string name;      ///< for messages
    dvec3 corner{0};       ///< m
    dvec3 edge_u{1, 0, 0}; ///< m; from the corner
    dvec3 edge_v{0, 0, 1}; ///< m; from the corner, at a right angle to edge_u
    dvec3 power{1};        ///< W, rgb; no channel below 0, one above

    bool operator==(const rectangle_light&) const = default; ///< of every member
};

/// A pinhole camera.
struct camera {
    dvec3 position{0};        ///< m
    dvec3 look_at{0, 0, -1};  ///< m; the point in the middle of the picture
    dvec3 up{0, 1, 0};        ///< a direction that is up in the picture; not along the line of sight
    double vertical_fov = 45; ///< degrees from the picture's lower edge to its upper one, above 0 and below 179

    bool operator==(const camera&) const = default; ///< of every member
};

namespace detail {
    /// The directions of a camera's picture, unit vectors.
    struct camera_axes {
        dvec3 forward, right, up;

        explicit camera_axes(const camera& c)
            : forward(glm::normalize(c.look_at - c.position)), right(glm::normalize(glm::cross(forward, c.up))),
              up(glm::cross(right, forward))
        {
        }
    };
} // namespace detail

/// How a photon map is built: sorted_map (2.2.1) or routed_map (2.2.2).
enum class map_builder { sort, route };

/// Which part of the light a picture shows. The photon map's part is split by the photons' paths: a caustic photon met
/// mirrors and glass only, an indirect one a diffuse surface too. Lamps that the eye sees count as direct.
enum class light_part { all, direct, caustic, indirect };

/// How to render: the paper's parameters, and what goes beyond them.
struct render_settings {
    std::uint32_t width = 512;     ///< pixels, 1 to 16384
    std::uint32_t height = 512;    ///< pixels, 1 to 16384
    std::uint32_t photons = 65000; ///< photons *stored*
    std::uint32_t k = 500;         ///< photons sought by an estimate
    glm::uvec3 grid{
        25, 25, 50}; ///< cells of the photon map over the scene; 0, 0, 0: fitted to photons and k (fitting_grid.hpp)
    double max_radius = 0.1;                   ///< m
    std::uint32_t light_samples = 32;          ///< shadow rays a light, pixel and eye ray; a point light needs one
    std::uint32_t spp = 1;                     ///< eye rays a pixel
    std::uint32_t depth = 8;                   ///< reflections and refractions an eye ray follows
    std::uint32_t photon_depth = 32;           ///< surfaces a photon path meets at most
    std::uint32_t seed = 1;                    ///< of all random numbers; the same seed gives the same picture
    map_builder builder = map_builder::sort;   ///< sorted or routed
    std::uint32_t slots = 4;                   ///< m: routed cells have m x m slots
    double exposure = 0;                       ///< EV for tone-mapped output: pixel values times 2^exposure
    search_kind search = search_kind::exact_k; ///< which photons an estimate uses
    filter_kernel kernel = filter_kernel::silverman; ///< their weight by distance
    bias_kind bias = bias_kind::unbiased;            ///< does the photon that sets the radius count?
    leak_policy leaks{.side = true};                 ///< photons that are refused
    edge_correction edges = edge_correction::none;   ///< polygons: needs leak_policy::min_cosine above 0
    light_part only = light_part::all;               ///< what of the light is drawn
    bool aov = false; ///< radius, count and relative standard error of the estimate are wanted per pixel

    bool operator==(const render_settings&) const = default; ///< of every member
};

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
    std::vector<polygon> polygons;                 ///< Lambertian ones are so on both sides
    std::vector<point_light> point_lights;         ///< a scene has one light at least, of either kind
    std::vector<rectangle_light> rectangle_lights; ///< the eye sees them
    render_settings render;                        ///< what the scene's file asks for

    bool operator==(const scene&) const = default; ///< of every member
};

/// The settings that reproduce the paper's estimate (2.3): at least k, constant kernel, no policy, no correction. The
/// rest stays.
/// \snippet snippets.cpp as_paper
inline render_settings as_paper(render_settings s)
{
    s.search = search_kind::at_least_k;
    s.kernel = filter_kernel::constant;
    s.bias = bias_kind::paper;
    s.leaks = {};
    s.edges = edge_correction::none;
    return s;
}

/// What the estimates behind a picture say of themselves, means over each pixel's eye rays, row by row from the top
/// left; 0 where no ray asked for an estimate.
struct estimate_layers {
    std::vector<float> radius;         ///< m
    std::vector<float> count;          ///< photons within it
    std::vector<float> relative_error; ///< standard error of the irradiance, over the irradiance (sums over channels)
};

/// A picture: linear radiance, W/(m^2 sr), rgb, row by row from the top left.
struct image {
    std::uint32_t width = 0;       ///< pixels
    std::uint32_t height = 0;      ///< pixels
    std::vector<glm::vec3> pixels; ///< width x height of them
    estimate_layers layers{};      ///< empty unless render_settings::aov
};

namespace detail {
    inline void require(bool good, const std::string& what)
    {
        if (!good)
            throw std::invalid_argument(what);
    }
    inline bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
    inline bool finite(double v) { return std::isfinite(v); }
    inline void require_radius(double r) { require(finite(r) && r > 0, "radius: must be finite and greater than 0"); }
    inline void require_axis(const dvec3& a, const dvec3& b, const char* what)
    {
        require(finite(a) && finite(b), std::string(what) + ": must be finite");
        require(glm::length(b - a) > 0, std::string(what) + ": are the same point, so the shape has no axis");
    }
} // namespace detail

// Each `check` throws std::invalid_argument "member: what is wrong" for a part that cannot be rendered.

/// \throws std::invalid_argument for a reflectance outside 0 to 1, or glass with an index of refraction outside 1 to 10.
inline void check(const material& m)
{
    const auto& r = m.reflectance;
    detail::require(detail::finite(r) && r.x >= 0 && r.y >= 0 && r.z >= 0 && r.x <= 1 && r.y <= 1 && r.z <= 1,
        "reflectance: each channel must be from 0 to 1");
    if (m.kind == material_kind::glass)
        detail::require(
            detail::finite(m.index_of_refraction) && m.index_of_refraction >= 1 && m.index_of_refraction <= 10,
            "index_of_refraction: must be from 1 to 10");
}
/// \throws std::invalid_argument for a centre that is not finite, or a radius that is not above 0.
inline void check(const sphere& s)
{
    detail::require(detail::finite(s.center), "center: must be finite");
    detail::require_radius(s.radius);
}
/// \throws std::invalid_argument for ends in one place or not finite, or a radius that is not above 0.
inline void check(const cylinder& c)
{
    detail::require_axis(c.base, c.top, "base and top");
    detail::require_radius(c.radius);
}
/// \throws std::invalid_argument for a base and an apex in one place or not finite, or a radius that is not above 0.
inline void check(const cone& c)
{
    detail::require_axis(c.base, c.apex, "base and apex");
    detail::require_radius(c.radius);
}
/// \throws std::invalid_argument for a vertex and a rim in one place or not finite, or a radius that is not above 0.
inline void check(const paraboloid& p)
{
    detail::require_axis(p.vertex, p.rim, "vertex and rim");
    detail::require_radius(p.radius);
}
/// \throws std::invalid_argument for a centre or normal that is not finite, a normal of length 0, or a radius that is not above 0.
inline void check(const disk& d)
{
    detail::require(detail::finite(d.center), "center: must be finite");
    detail::require(detail::finite(d.normal) && glm::length(d.normal) > 0, "normal: must be finite and not zero");
    detail::require_radius(d.radius);
}

/// The area vector of a polygon: its normal, as long as its area, m^2 (Newell's method).
inline dvec3 area_vector(const polygon& p)
{
    dvec3 sum(0);
    for (std::size_t i = 0; i < p.vertices.size(); ++i)
        sum += glm::cross(p.vertices[i] - p.vertices[0], p.vertices[(i + 1) % p.vertices.size()] - p.vertices[0]);
    return 0.5 * sum;
}

/// \throws std::invalid_argument for fewer than 3 vertices, one that is not finite or is off the plane by more than 1e-5 of the
///         polygon's extent, a polygon without area, or one that is not convex.
inline void check(const polygon& p)
{
    detail::require(p.vertices.size() >= 3, "vertices: a polygon has at least 3");
    double extent = 0;
    for (const auto& v : p.vertices) {
        detail::require(detail::finite(v), "vertices: must be finite");
        extent = std::max(extent, glm::length(v - p.vertices[0]));
    }
    const dvec3 area = area_vector(p);
    detail::require(glm::length(area) > 1e-12 * extent * extent, "vertices: the polygon has no area");
    const dvec3 n = glm::normalize(area);
    for (std::size_t i = 0; i < p.vertices.size(); ++i) {
        const auto& a = p.vertices[i];
        const auto& b = p.vertices[(i + 1) % p.vertices.size()];
        const auto& c = p.vertices[(i + 2) % p.vertices.size()];
        detail::require(std::abs(glm::dot(n, a - p.vertices[0])) <= 1e-5 * extent,
            "vertices: vertex " + std::to_string(i)
                + " lies off the plane of the others by more than 1e-5 of the polygon's extent; split it into "
                  "triangles");
        detail::require(glm::dot(n, glm::cross(b - a, c - b)) >= -1e-9 * extent * extent,
            "vertices: the polygon is not convex at vertex " + std::to_string((i + 1) % p.vertices.size()));
    }
}

/// \throws std::invalid_argument for a power (W, rgb) with a channel that is not finite or below 0, or with no light.
inline void check_power(const dvec3& power)
{
    detail::require(detail::finite(power) && power.x >= 0 && power.y >= 0 && power.z >= 0,
        "power: each channel must be finite and not negative");
    detail::require(power.x + power.y + power.z > 0, "power: the light is black");
}
/// \throws std::invalid_argument for a position that is not finite, or a power as in check_power.
inline void check(const point_light& l)
{
    detail::require(detail::finite(l.position), "position: must be finite");
    check_power(l.power);
}
/// \throws std::invalid_argument for what is not finite, edges without area or not at right angles, or a power as in check_power.
inline void check(const rectangle_light& l)
{
    detail::require(detail::finite(l.corner) && detail::finite(l.edge_u) && detail::finite(l.edge_v),
        "corner, edge_u, edge_v: must be finite");
    const double u = glm::length(l.edge_u), v = glm::length(l.edge_v);
    detail::require(u > 0 && v > 0 && glm::length(glm::cross(l.edge_u, l.edge_v)) > 1e-9 * u * v,
        "edge_u, edge_v: the rectangle has no area");
    detail::require(std::abs(glm::dot(l.edge_u, l.edge_v)) <= 1e-6 * u * v, "edge_u, edge_v: must be at right angles");
    check_power(l.power);
}
/// \throws std::invalid_argument for a camera that looks nowhere, whose `up` is along its line of sight, or that opens by 0, 179 degrees or more.
inline void check(const camera& c)
{
    detail::require(detail::finite(c.position) && detail::finite(c.look_at), "position and look_at: must be finite");
    detail::require(c.position != c.look_at, "position and look_at: are the same point, so the camera looks nowhere");
    detail::require(detail::finite(c.up)
            && glm::length(glm::cross(c.up, c.look_at - c.position))
                > 1e-9 * glm::length(c.up) * glm::length(c.look_at - c.position)
            && glm::length(c.up) > 0,
        "up: must be finite, not zero, and not along the line of sight");
    detail::require(detail::finite(c.vertical_fov) && c.vertical_fov > 0 && c.vertical_fov < 179,
        "vertical_fov: must be between 0 and 179 degrees");
}
/// \throws std::invalid_argument for a setting out of its range, which the message gives.
inline void check(const render_settings& s)
{
    detail::require(s.width >= 1 && s.height >= 1 && s.width <= 16384 && s.height <= 16384,
        "size: width and height must be from 1 to 16384 pixels");
    detail::require(s.photons >= 1 && s.photons <= (1u << 27), "photons: must be from 1 to 2^27");
    detail::require(s.k >= 1 && s.k <= (1u << 24), "k: must be from 1 to 2^24");
    detail::require(s.grid == glm::uvec3(0) || (s.grid.x >= 1 && s.grid.y >= 1 && s.grid.z >= 1),
        "grid: each axis needs at least one cell (or all three 0: fitted to the photons)");
    detail::require(detail::finite(s.max_radius) && s.max_radius > 0, "max_radius: must be finite and greater than 0");
    detail::require(s.light_samples >= 1 && s.light_samples <= 65536, "light_samples: must be from 1 to 65536");
    detail::require(s.spp >= 1 && s.spp <= 65536, "spp: must be from 1 to 65536");
    detail::require(s.depth <= 64, "depth: must be at most 64");
    detail::require(s.photon_depth >= 1 && s.photon_depth <= 64, "photon_depth: must be from 1 to 64");
    detail::require(
        s.leaks.compression >= 1 && s.leaks.compression <= 1e6f, "leaks: compression must be from 1 to 10^6");
    detail::require(s.leaks.min_cosine >= -1 && s.leaks.min_cosine <= 1, "leaks: min_cosine must be from -1 to 1");
    detail::require(s.edges == edge_correction::none || s.leaks.min_cosine > 0,
        "edge_correction: photons of adjoining walls would count, though their area does not; it needs the leak policy "
        "normals with a cosine above 0, for example 0.5 (or edge_correction none)");
    detail::require(s.slots >= 1 && s.slots <= 16, "slots: must be from 1 to 16");
    detail::require(detail::finite(s.exposure) && std::abs(s.exposure) <= 64, "exposure: must be from -64 to 64 EV");
}

/// Checks a whole scene, its parts and their references. A scene file's reader checks part by part and adds the place.
/// \throws std::invalid_argument "part[index].member: what is wrong"; also for a scene without lights, or balls of glass that overlap.
inline void check(const scene& s)
{
    const auto all = [&](const char* kind, const auto& parts) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            try {
                check(parts[i]);
                if constexpr (requires { parts[i].material; })
                    detail::require(parts[i].material < s.materials.size(), "material: no such material");
            } catch (const std::invalid_argument& e) {
                throw std::invalid_argument(std::string(kind) + "[" + std::to_string(i) + "]." + e.what());
            }
        }
    };
    all("materials", s.materials);
    all("spheres", s.spheres);
    all("cylinders", s.cylinders);
    all("cones", s.cones);
    all("paraboloids", s.paraboloids);
    all("disks", s.disks);
    all("polygons", s.polygons);
    all("point_lights", s.point_lights);
    all("rectangle_lights", s.rectangle_lights);
    detail::require(!s.point_lights.empty() || !s.rectangle_lights.empty(), "lights: the scene has none");
    // Glass surfaces have air outside, whatever is there: light is followed through one dielectric at a time.
    const auto is_glass = [&](const sphere& x) { return s.materials[x.material].kind == material_kind::glass; };
    for (std::size_t i = 0; i < s.spheres.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const auto &a = s.spheres[i], &b = s.spheres[j];
            detail::require(
                !is_glass(a) || !is_glass(b) || glm::length(a.center - b.center) >= (a.radius + b.radius) * (1 - 1e-9),
                "spheres[" + std::to_string(i) + "]: overlaps spheres[" + std::to_string(j)
                    + "], and both are glass; light is followed through one glass body at a time, so move them apart");
        }
    check(s.camera);
    check(s.render);
}

} // namespace photongrid
