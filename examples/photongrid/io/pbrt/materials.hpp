// Materials of pbrt as photongrid's.
#pragma once

#include <photongrid/io/pbrt/values.hpp>

#include <map>
#include <optional>
#include <set>
#include <string>

namespace photongrid::pbrt {

/// Makes each material where a shape first uses it.
class material_reader {
public:
    material_reader(const description& all, scene_builder& builder, value_reader& values)
        : all_(all), builder_(builder), values_(values)
    {
    }

    /// Its index in the scene; none for `interface`, whose surfaces are not drawn.
    /// \throws scene_error for a name that no material has.
    std::optional<std::uint32_t> index_of(const material_reference& m, const source_place& place);
    /// That of a shape's, which absorbs what the medium inside it does; an interface then has the index of
    /// refraction 1.
    std::optional<std::uint32_t> index_of(const shape_entity& s);
    /// Whether it is black, as the surfaces of lamps are here.
    bool is_black(const material_reference& m, const source_place& place);

private:
    struct medium {
        dvec3 absorbed{0}; ///< by the unit of length
        bool scatters = false;
    };
    medium medium_of(const std::string& name, const source_place& place);
    std::size_t entity_of(const material_reference& m, const source_place& place) const;
    std::optional<std::uint32_t> made(const entity& e, const std::string& name);
    std::optional<std::uint32_t> mixture(const entity& e, const std::string& name);
    double roughness(const entity& e, const std::string& prefix, texture_use* texture);

    const description& all_;
    scene_builder& builder_;
    value_reader& values_;
    std::map<std::size_t, std::optional<std::uint32_t>> made_;
    std::map<std::string, medium> media_;
    bool noted_outside_ = false;
    std::set<std::size_t> within_; ///< mixtures that are being made
};

} // namespace photongrid::pbrt
