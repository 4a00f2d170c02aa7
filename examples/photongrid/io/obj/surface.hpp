// What an OBJ file says, and the meshes that its faces are.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/polygon_cutter.hpp>
#include <photongrid/scene/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::obj {

/// Indices of a corner's position, texture coordinates and normal, counted from 0.
using corner = std::array<std::uint32_t, 3>;
constexpr std::uint32_t absent = 0xFFFFFFFFu;

/// A name, and where it stands first.
struct placed_name {
    std::string name;
    source_place place;
};

/// From this face on, faces are of this material.
struct material_change {
    std::uint32_t face = 0;
    std::uint32_t name = 0; ///< index into surface::materials
};

/// Statements of one kind that make no triangles.
struct skipped_statements {
    std::string statement;
    source_place place{""}; ///< of the first
    std::size_t count = 0;
};

/// What an OBJ file says. All indices in it are valid.
struct surface {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> colors, normals;
    std::vector<glm::vec2> coordinates;
    std::vector<corner> corners;
    std::vector<std::uint32_t> face_starts; ///< the first corner of each face
    std::vector<placed_name> libraries;     ///< what stands behind each `mtllib`
    std::vector<placed_name> materials;     ///< the different names of `usemtl`
    std::vector<material_change> changes;   ///< in the order of faces; what comes first has no material
    std::vector<skipped_statements> skipped;
    skipped_statements flat; ///< faces of fewer than three corners, which are not in `corners`
    std::optional<source_place> smooth_without_normals; ///< of smoothing that faces without normals ask for
};

/// Faces, from `first` to before `past`.
struct face_range {
    std::uint32_t first = 0, past = 0;
};

/// Reads an OBJ file; `file` is its name in messages.
/// \throws scene_error as parse_obj does.
surface parse(const std::string& file, std::string_view text);

/// The mesh of some faces. Its vertices are in the order in which faces first name them.
mesh mesh_of(const surface& s, std::span<const face_range> faces, polygon_cutter& cutter);

} // namespace photongrid::obj
