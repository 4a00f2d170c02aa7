// The host's scene: spheres, rectangles and tubes, diffuse, mirrors or glass, and one lamp.
#pragma once

#include "vec3.hpp"

#include <optional>
#include <vector>

namespace host {

struct ray {
    vec3 origin;    ///< m
    vec3 direction; ///< unit vector
};

enum class surface { diffuse, mirror, glass, lamp };

struct material {
    surface kind = surface::diffuse;
    vec3 colour; ///< albedo, reflectance, 1 for glass, or the lamp's radiance, W/(m^2 sr)

    bool is_specular() const { return kind == surface::mirror || kind == surface::glass; }
};

struct sphere {
    vec3 middle;
    double radius; ///< m
    material of;
};
/// Its front, the side on which a lamp emits, is the side of cross(a, b).
struct rectangle {
    vec3 corner, a, b; ///< a, b: edges, at right angles, m
    material of;

    double area() const { return length(cross(a, b)); }
    vec3 normal() const { return normalized(cross(a, b)); }
    vec3 point(random_stream& random) const
    {
        const double u = random.next(), v = random.next();
        return corner + u * a + v * b;
    }
};
/// An upright cylinder without ends.
struct tube {
    vec3 foot;
    double radius, height; ///< m
    material of;
};

struct hit {
    double distance;       ///< m
    vec3 position, normal; ///< normal: unit vector, towards the side that the ray came from
    bool outside;          ///< the ray came from the outside of a solid, or from the front
    material of;
};

struct scene {
    std::vector<sphere> spheres;
    std::vector<rectangle> rectangles;
    std::vector<tube> tubes;
    rectangle lamp;

    std::optional<hit> nearest(const ray& r) const;
    /// Whether the line between two points is unoccluded.
    bool sees(vec3 from, vec3 to) const;
};

/// A box with a glass ball and a gold ring.
scene box_scene();

/// The next ray from a mirror or from glass, for light in either direction. Glass reflects or refracts at random, by
/// Fresnel's equations, so only the surface's colour scales the light.
ray specular_bounce(const ray& r, const hit& h, random_stream& random);

} // namespace host
