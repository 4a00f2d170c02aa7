// Colours, numbers and textures of pbrt's parameters.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/pbrt/description.hpp>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace photongrid::pbrt {

/// A colour or a number that may vary: `factor` times a texture.
struct varying {
    dvec3 factor{1};
    texture_use texture{};
};

/// Evaluates parameters. Textures are made where they are used.
class value_reader {
public:
    value_reader(const description& all, scene_builder& builder) : all_(all), builder_(builder) {}

    /// The reflectance that a parameter is: rgb, a spectrum or a texture. Limited to 0 to 1, with a note.
    varying reflectance(const entity& e, std::string_view name, const dvec3& if_absent);
    /// A number: float, or a texture of floats.
    varying number(const entity& e, std::string_view name, double if_absent);
    /// The colour of a light; one that is a spectrum has the luminance 1.
    dvec3 emission(const entity& e, std::string_view name);
    /// The coefficient of a medium, by the unit of length.
    dvec3 coefficient(const entity& e, std::string_view name);
    /// The index of refraction of a dielectric: float or a spectrum, at 587.6 nm.
    double index_of_refraction(const entity& e, std::string_view name, double if_absent);
    /// The reflectance of a conductor at normal incidence, of `reflectance` or of `eta` and `k`.
    varying conductor(const entity& e, const std::string& prefix);

    /// The mean of what varies.
    static dvec3 mean(const varying& v);

private:
    std::optional<sampled_spectrum> spectrum(const parameter& p) const;
    dvec3 constant_reflectance(const entity& e, const parameter& p) const;
    varying texture(const source_place& place, const std::string& name, bool is_float);
    varying made_texture(const entity& e, bool is_float);
    varying image_texture(const entity& e, bool is_float);
    varying checkerboard(const entity& e, bool is_float);
    varying mixed(const entity& e, bool is_float);
    varying input(const entity& e, std::string_view name, bool is_float, const dvec3& if_absent);
    void map_coordinates(const entity& e, texture_use& t);
    varying baked(const varying& v, const std::function<dvec3(const dvec3&)>& change) const;

    const description& all_;
    scene_builder& builder_;
    std::map<std::string, varying> textures_; ///< those that are made
    std::set<std::string> within_;            ///< those that are being made
};

} // namespace photongrid::pbrt
