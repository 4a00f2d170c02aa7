// Materials of glTF as photongrid's.
#pragma once

#include <photongrid/io/gltf/textures.hpp>
#include <photongrid/io/import/photometry.hpp>

#include <map>
#include <optional>
#include <string>

namespace photongrid::gltf {

/// What a surface is made of.
struct surface_material {
    std::uint32_t index = 0;               ///< in the scene; of lamps without a texture, none
    coordinate_use coordinates{};          ///< of its textures
    dvec3 radiance{0};                     ///< that it emits, W/(m^2 sr), rgb
    std::optional<texture_use> emission{}; ///< factor on it
    bool is_double_sided = false;          ///< both sides emit
    bool is_black = false;                 ///< it reflects nothing
    bool is_pane = false;                  ///< thin glass, or has some
    std::string name{};                    ///< for notes
};

/// Makes each material where a surface first uses it.
class material_reader {
public:
    explicit material_reader(document& all) : all_(all) {}

    /// `index`: none for the default material.
    const surface_material& made(std::optional<std::size_t> index, const source_place& place);

private:
    document& all_;
    std::map<std::optional<std::size_t>, surface_material> made_;
};

} // namespace photongrid::gltf
