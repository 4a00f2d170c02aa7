// Materials as MTL files describe them.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/scene/texture.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::obj {

/// A picture that a material names, with its options.
struct mtl_map {
    std::string file;
    source_place place;
    glm::dvec2 scale{1}, offset{0}; ///< of texture coordinates, in this order
    bool clamp = false;
    std::optional<texture_channel> channel{}; ///< of a number, if the file says which
};

/// Something that is left out where the material is used.
struct mtl_note {
    source_place place;
    std::string what;
};

/// A material. Colours are linear rgb; members are named as in the file.
struct mtl_material {
    std::string name;
    source_place place;
    std::optional<dvec3> kd{}, ks{}, ke{}, tf{};
    std::optional<double> ns{}, ni{}, d{}, tr{}, pr{}, pm{};
    std::optional<int> illum{};
    std::optional<mtl_map> map_kd{}, map_ke{}, map_d{}, map_pr{}, map_pm{};
    std::vector<mtl_note> notes{};
};

/// Reads an MTL file; `file` is its name in messages.
/// \throws scene_error for a number that is none, an option of a picture that is not known, or what stands before the
///         first material.
std::vector<mtl_material> parse_mtl(const std::string& file, std::string_view text);

} // namespace photongrid::obj
