// Surfaces of the primitives of meshes.
#pragma once

#include <photongrid/io/gltf/document.hpp>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace photongrid::gltf {

/// What a material makes of texture coordinates.
struct coordinate_use {
    std::size_t set = 0;     ///< TEXCOORD_0, TEXCOORD_1 ...
    glm::dmat3 transform{1}; ///< of a column (u, v, 1), with v downwards as in the file
    bool is_used = false;    ///< some texture needs them
};

/// The pose of a mesh.
struct mesh_pose {
    std::vector<double> weights{};    ///< of morph targets; empty: those of the mesh
    std::vector<glm::dmat4> joints{}; ///< from the space of the mesh's vertices to the scene's; empty: it has no skin
};

/// Makes surfaces. Those that many nodes place are made once.
class mesh_reader {
public:
    explicit mesh_reader(document& all) : all_(all) {}

    /// The triangles of a primitive; null if it has none.
    std::shared_ptr<const mesh> surface_of(
        std::size_t mesh_index, std::size_t primitive, const coordinate_use& coordinates, const mesh_pose& pose);

private:
    std::shared_ptr<const mesh> made(std::size_t mesh_index, const part& p, const coordinate_use& coordinates,
        const std::vector<double>& weights, const std::vector<glm::dmat4>& joints);
    std::vector<glm::uvec3> triangles_of(const part& p, std::size_t vertices);
    void add_colors(const part& attributes, mesh& m);
    void add_coordinates(const part& p, const part& attributes, const coordinate_use& coordinates, mesh& m);
    void morph(const part& p, const std::vector<double>& weights, mesh& m);
    void pose_by_skin(const part& attributes, const std::vector<glm::dmat4>& joints, mesh& m);

    document& all_;
    std::map<std::pair<std::size_t, std::size_t>, std::shared_ptr<const mesh>> made_;
};

} // namespace photongrid::gltf
