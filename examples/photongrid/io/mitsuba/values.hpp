// Colours, numbers and textures of the properties of Mitsuba's objects.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/mitsuba/description.hpp>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace photongrid::mitsuba {

/// A colour or a number that may vary: `factor` times a texture, and times the colours of vertices.
struct varying {
    dvec3 factor{1};
    texture_use texture{};
    bool has_vertex_colors = false;
};

/// The same with each of its texels changed.
varying changed(const varying& v, const std::function<dvec3(const dvec3&)>& change);

/// The mean of what varies. That of colours of vertices is taken for 1.
dvec3 mean_of(const varying& v);

/// Evaluates properties. Textures are made where they are used.
class value_reader {
public:
    explicit value_reader(scene_builder& builder) : builder_(builder) {}

    /// The reflectance that a property or a texture is. Limited to 0 to 1, with a note.
    varying reflectance(const object& o, std::string_view name, const dvec3& if_absent);
    /// A number, or the luminances of a texture.
    varying number(const object& o, std::string_view name, double if_absent);
    /// The radiance, intensity or irradiance of a light.
    dvec3 emission(const object& o, std::string_view name);
    /// An index of refraction: a number, or the name of a matter.
    double index_of_refraction(const object& o, std::string_view name, const char* if_absent);
    /// The reflectance of a conductor at normal incidence, of `material` or of `eta` and `k`, with its
    /// `specular_reflectance`.
    varying conductor(const object& o);

private:
    enum class meaning { reflectance, emission, number };
    dvec3 constant(const property& p, meaning m) const;
    std::optional<varying> value(const object& o, std::string_view name, meaning m);
    sampled_spectrum spectrum(const property& p) const;
    dvec3 of_samples(const sampled_spectrum& s, meaning m) const;
    dvec3 bare_conductor(const object& o);

    varying texture(const child& c, meaning m);
    varying made_texture(const object& o, meaning m);
    varying spectrum_object(const object& o, meaning m);
    varying bitmap(const object& o, meaning m);
    varying checkerboard(const object& o, meaning m);
    varying scaled(const object& o, meaning m);
    void map_coordinates(const object& o, texture_use& t);

    scene_builder& builder_;
    std::map<std::pair<const object*, meaning>, varying> textures_; ///< those that are made
    std::set<const object*> within_;                                ///< those that are being made
};

} // namespace photongrid::mitsuba
