// Materials of MTL files as photongrid's.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/obj/mtl.hpp>

#include <cstdint>
#include <optional>

namespace photongrid::obj {

/// What surfaces of a material emit; none of one that is no lamp.
std::optional<imported_emission> emission_of(scene_builder& builder, const mtl_material& m);

/// Adds a material. Returns its index in the scene. `has_coordinates`: whether its surface can have a texture.
std::uint32_t add_material(scene_builder& builder, const mtl_material& m, bool has_coordinates);

} // namespace photongrid::obj
