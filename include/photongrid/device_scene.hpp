// A scene as kernels read it: one buffer of vec4 records, recentred so that float keeps its precision far from the
// origin. The records' layout is kernels/scene_hit.glsl's.
#pragma once

#include <photongrid/backend.hpp>
#include <photongrid/photon_map.hpp>
#include <photongrid/scene.hpp>

#include <algorithm>
#include <photongrid/trace_kernels.hpp>

namespace photongrid {

/// What a scene has, as the SWITCHes of the tracing kernels: code for what it lacks is not compiled.
enum scene_feature : uint {
    has_spheres = 1u << 0,
    has_quadrics = 1u << 1, ///< cylinders, cones, paraboloids
    has_disks = 1u << 2,
    has_polygons = 1u << 3,
    has_mirrors = 1u << 4, ///< and metals
    has_glass = 1u << 5,
    has_point_lights = 1u << 6,
    has_area_lights = 1u << 7,
};

/// The records of a scene and where they stand.
struct scene_records {
    std::vector<glm::vec4> records; ///< as kernels/scene_hit.glsl reads them; positions are recentred
    kernels::Scene layout{};        ///< where each kind of record begins, and how many there are
    uint features = 0;              ///< scene_feature bits
    dvec3 center{0};                ///< subtracted from every position, m
    glm::vec3 low{0};               ///< m; box of the Lambertian surfaces, recentred: where photons can be stored
    glm::vec3 high{0};              ///< m; its other corner
};

namespace detail {
    struct box {
        dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
        void add(const dvec3& p, const dvec3& margin = dvec3(0))
        {
            low = glm::min(low, p - margin);
            high = glm::max(high, p + margin);
        }
        bool empty() const { return !(low.x <= high.x); }
    };

    /// How far a disc of radius r about an axis reaches along x, y and z.
    inline dvec3 disc_reach(const dvec3& axis, double r)
    {
        const dvec3 a = glm::normalize(axis);
        return r * glm::sqrt(glm::max(dvec3(0), dvec3(1) - a * a));
    }

    inline void add_bounds(box& b, const sphere& s) { b.add(s.center, dvec3(s.radius)); }
    inline void add_bounds(box& b, const cylinder& c)
    {
        b.add(c.base, disc_reach(c.top - c.base, c.radius));
        b.add(c.top, disc_reach(c.top - c.base, c.radius));
    }
    inline void add_bounds(box& b, const cone& c)
    {
        b.add(c.base, disc_reach(c.apex - c.base, c.radius));
        b.add(c.apex);
    }
    inline void add_bounds(box& b, const paraboloid& p)
    {
        b.add(p.vertex);
        b.add(p.rim, disc_reach(p.rim - p.vertex, p.radius));
    }
    inline void add_bounds(box& b, const disk& d) { b.add(d.center, disc_reach(d.normal, d.radius)); }
    inline void add_bounds(box& b, const polygon& p)
    {
        for (const auto& v : p.vertices)
            b.add(v);
    }

    /// Writes records; positions are recentred.
    class record_writer {
    public:
        record_writer(scene_records& out, double scale)
            : out_(out), edge_margin_(scale * 0x1p-20), doubt_(scale * 0x1p-20)
        {
        }

        void put(const dvec3& v, double w)
        {
            out_.records.emplace_back(
                static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w));
        }
        void put_position(const dvec3& v, double w) { put(v - out_.center, w); }
        uint next() const { return static_cast<uint>(out_.records.size()); }

        /// x^2 + y^2 + a z^2 + b z + c = 0, z from 0 to the axis' length.
        void put_quadric(const dvec3& base, const dvec3& end, double a, double b, double c, uint material)
        {
            const double height = glm::length(end - base);
            const dvec3 w = (end - base) / height;
            const dvec3 u = glm::normalize(glm::cross(std::abs(w.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), w));
            put_position(base, height);
            put(u, a);
            put(glm::cross(w, u), b);
            put(w, c);
            put(dvec3(material, 0, 0), 0);
        }

        void put_polygon(const polygon& p, double light_tag)
        {
            const dvec3 n = glm::normalize(area_vector(p));
            put(n, glm::dot(n, p.vertices[0] - out_.center));
            double off = 0; // the vertices need lie on one plane only roughly
            for (const auto& v : p.vertices)
                off = std::max(off, std::abs(glm::dot(n, v - p.vertices[0])));
            put(dvec3(static_cast<double>(p.vertices.size()), p.material, light_tag), doubt_ + 2 * off);
            for (std::size_t i = 0; i < p.vertices.size(); ++i) {
                const auto& a = p.vertices[i];
                const auto& b = p.vertices[(i + 1) % p.vertices.size()];
                const dvec3 across = glm::cross(n, b - a); // into the polygon
                const double length = glm::length(across);
                const dvec3 inward = length > 0 ? across / length : dvec3(0);
                put(inward, glm::dot(inward, a - out_.center) - edge_margin_);
            }
            for (const auto& v : p.vertices)
                put_position(v, 0);
        }

    private:
        scene_records& out_;
        double edge_margin_; ///< by which polygons are inflated
        double doubt_;       ///< bound on the rounding of distances from planes and edges
    };
} // namespace detail

namespace detail {
    /// The scene moved by -by.
    inline scene moved_back(scene s, const dvec3& by)
    {
        for (auto& x : s.spheres)
            x.center -= by;
        for (auto& x : s.cylinders)
            x.base -= by, x.top -= by;
        for (auto& x : s.cones)
            x.base -= by, x.apex -= by;
        for (auto& x : s.paraboloids)
            x.vertex -= by, x.rim -= by;
        for (auto& x : s.disks)
            x.center -= by;
        for (auto& x : s.polygons)
            for (auto& v : x.vertices)
                v -= by;
        for (auto& x : s.point_lights)
            x.position -= by;
        for (auto& x : s.rectangle_lights)
            x.corner -= by;
        s.camera.position -= by;
        s.camera.look_at -= by;
        return s;
    }

    /// A point that moves with the scene exactly: any that its lights name.
    inline dvec3 anchor(const scene& s)
    {
        return s.rectangle_lights.empty() ? s.point_lights.at(0).position : s.rectangle_lights[0].corner;
    }

    /// How far the coordinates of a round shape's points reach, from the origin of its record: see `clearance`
    /// (scene_layout.glsl).
    inline double reach(const sphere& s) { return 2 * s.radius; }
    inline double reach(double height, double radius) { return 2 * (height + radius); }

    /// \throws std::invalid_argument when a shape is so small beside the scene that float coordinates cannot resolve it.
    inline void require_resolvable(const scene& s, double scale)
    {
        const auto all = [&](const char* kind, const auto& shapes, auto size) {
            for (std::size_t i = 0; i < shapes.size(); ++i)
                require(size(shapes[i]) >= scale * 0x1p-18,
                    std::string(kind) + "[" + std::to_string(i)
                        + "]: is 2^18 times smaller than the scene or more, which single precision cannot resolve; "
                          "leave it out, or model the large things smaller");
        };
        const auto radius = [](const auto& x) { return x.radius; };
        all("spheres", s.spheres, radius);
        all("cylinders", s.cylinders, radius);
        all("cones", s.cones, radius);
        all("paraboloids", s.paraboloids, radius);
        all("disks", s.disks, radius);
        all("polygons", s.polygons, [](const polygon& p) {
            double extent = 0;
            for (const auto& v : p.vertices)
                extent = std::max(extent, glm::length(v - p.vertices[0]));
            return extent;
        });
        all("rectangle_lights", s.rectangle_lights,
            [](const rectangle_light& l) { return std::min(glm::length(l.edge_u), glm::length(l.edge_v)); });
    }
} // namespace detail

/// Lays a scene out for kernels. \throws std::invalid_argument as check(scene) does, when no surface is Lambertian, or
/// when a size or a power does not fit single precision.
inline scene_records lay_out(const scene& original)
{
    check(original);
    // All sums below are of coordinates relative to a point of the scene: a scene that is moved by an exact amount then
    // gives the same records, bit for bit.
    const dvec3 anchor = detail::anchor(original);
    const scene s = detail::moved_back(original, anchor);
    scene_records out;
    detail::box all, lambertian;
    const auto bound = [&](const auto& shapes) {
        for (const auto& shape : shapes) {
            detail::add_bounds(all, shape);
            if (s.materials[shape.material].kind == material_kind::lambertian)
                detail::add_bounds(lambertian, shape);
        }
    };
    bound(s.spheres);
    bound(s.cylinders);
    bound(s.cones);
    bound(s.paraboloids);
    bound(s.disks);
    bound(s.polygons);
    detail::require(
        !lambertian.empty(), "materials: no shape is lambertian, so no photon can be stored and nothing can be lit");
    for (const auto& l : s.rectangle_lights)
        for (const auto& corner : {l.corner, l.corner + l.edge_u, l.corner + l.edge_v, l.corner + l.edge_u + l.edge_v})
            all.add(corner);
    for (const auto& l : s.point_lights)
        all.add(l.position);
    const double scale = 0.5 * glm::length(all.high - all.low);
    detail::require_resolvable(s, scale);
    // The middle, rounded to few bits, so that the anchor plus it is exact wherever the anchor is.
    const double step = std::exp2(std::floor(std::log2(scale)) - 8);
    out.center = glm::round(0.5 * (all.low + all.high) / step) * step;
    out.low = glm::vec3(lambertian.low - out.center);
    out.high = glm::vec3(lambertian.high - out.center);
    double round = 0;
    for (const auto& x : s.spheres)
        round = std::max(round, detail::reach(x));
    for (const auto& x : s.cylinders)
        round = std::max(round, detail::reach(glm::length(x.top - x.base), x.radius));
    for (const auto& x : s.cones)
        round = std::max(round, detail::reach(glm::length(x.apex - x.base), x.radius));
    for (const auto& x : s.paraboloids)
        round = std::max(round, detail::reach(glm::length(x.rim - x.vertex), x.radius));
    out.layout.scale.x = static_cast<float>(std::max(round * 0x1p-19, scale * 0x1p-26));

    detail::record_writer w(out, scale);
    out.layout.round_things = {w.next(), s.spheres.size(), 0, 0};
    for (const auto& x : s.spheres) {
        w.put_position(x.center, x.radius);
        w.put(dvec3(x.material, 0, 0), 0);
    }
    out.layout.round_things.z = w.next();
    out.layout.round_things.w = static_cast<uint>(s.cylinders.size() + s.cones.size() + s.paraboloids.size());
    for (const auto& x : s.cylinders)
        w.put_quadric(x.base, x.top, 0, 0, -x.radius * x.radius, x.material);
    for (const auto& x : s.cones) { // radius z/h from the apex on: there the equation has no constants that cancel
        const double h = glm::length(x.apex - x.base);
        w.put_quadric(x.apex, x.base, -x.radius * x.radius / (h * h), 0, 0, x.material);
    }
    for (const auto& x : s.paraboloids) // radius^2 z/h
        w.put_quadric(x.vertex, x.rim, 0, -x.radius * x.radius / glm::length(x.rim - x.vertex), 0, x.material);
    out.layout.flat_things = {w.next(), s.disks.size(), 0, 0};
    for (const auto& x : s.disks) {
        const dvec3 n = glm::normalize(x.normal);
        w.put(n, glm::dot(n, x.center - out.center));
        w.put_position(x.center, x.radius);
        w.put(dvec3(x.material, 0, 0), 0);
    }
    out.layout.flat_things.z = w.next();
    out.layout.flat_things.w = static_cast<uint>(s.polygons.size() + s.rectangle_lights.size());
    for (const auto& x : s.polygons)
        w.put_polygon(x, 0);
    for (std::size_t i = 0; i < s.rectangle_lights.size(); ++i) {
        const auto& l = s.rectangle_lights[i];
        w.put_polygon({{l.corner, l.corner + l.edge_u, l.corner + l.edge_u + l.edge_v, l.corner + l.edge_v}, 0},
            static_cast<double>(i + 1));
    }

    out.layout.rest.x = w.next();
    for (const auto& m : s.materials) {
        const bool mirrors = m.kind == material_kind::mirror || m.kind == material_kind::metal;
        w.put(m.reflectance,
            mirrors                              ? kernels::MIRROR_SURFACE
                : m.kind == material_kind::glass ? kernels::GLASS_SURFACE
                                                 : kernels::LAMBERTIAN_SURFACE);
        w.put(dvec3(m.index_of_refraction, 0, 0), 0);
        out.features |= mirrors ? has_mirrors : m.kind == material_kind::glass ? has_glass : 0u;
    }

    // Rectangles first: a polygon's tag is its light's number. A light is chosen in proportion to its power.
    out.layout.rest.y = w.next();
    out.layout.rest.z = static_cast<uint>(s.rectangle_lights.size() + s.point_lights.size());
    double total = 0, below = 0;
    const auto weight = [](const dvec3& power) { return power.x + power.y + power.z; };
    for (const auto& l : s.rectangle_lights)
        total += weight(l.power);
    for (const auto& l : s.point_lights)
        total += weight(l.power);
    const auto put_head = [&](double kind, const dvec3& power) {
        below += weight(power);
        w.put(dvec3(kind, weight(power) / total, below / total), 0);
    };
    for (const auto& l : s.rectangle_lights) {
        const dvec3 normal = glm::cross(l.edge_u, l.edge_v);
        put_head(1, l.power);
        w.put_position(l.corner, 1 / (M_PI * glm::length(normal)));
        w.put(l.edge_u, 0);
        w.put(l.edge_v, 0);
        w.put(glm::normalize(normal), glm::length(normal));
        w.put(l.power, 0);
    }
    for (const auto& l : s.point_lights) {
        put_head(0, l.power);
        w.put_position(l.position, 0);
        w.put(dvec3(0), 0);
        w.put(dvec3(0), 0);
        w.put(dvec3(0), 0);
        w.put(l.power, 0);
    }

    out.features |= s.spheres.empty() ? 0u : has_spheres;
    out.features |= out.layout.round_things.w == 0 ? 0u : has_quadrics;
    out.features |= s.disks.empty() ? 0u : has_disks;
    out.features |= out.layout.flat_things.w == 0 ? 0u : has_polygons;
    out.features |= s.point_lights.empty() ? 0u : has_point_lights;
    out.features |= s.rectangle_lights.empty() ? 0u : has_area_lights;
    for (const auto& r : out.records)
        detail::require(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z) && std::isfinite(r.w),
            "scene: a size or a power is too large for single precision");
    out.center += anchor;
    return out;
}

/// A scene on a device.
template <backend B>
struct device_scene {
    scene_records about;             ///< `records` stay on the host too
    buffer_of<B, glm::vec4> records; ///< as kernels/scene_hit.glsl reads them
};

/// Lays a scene out and uploads it.
/// \throws std::invalid_argument as lay_out does, backend_error where the device has no room.
/// \snippet snippets.cpp upload_scene
template <backend B>
device_scene<B> upload_scene(B& b, const scene& s)
{
    device_scene<B> d;
    d.about = lay_out(s);
    d.records = b.upload(std::span<const glm::vec4>(d.about.records));
    return d;
}

} // namespace photongrid
