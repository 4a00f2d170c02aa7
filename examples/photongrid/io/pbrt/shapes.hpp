// Shapes of pbrt: triangles, and the round ones that have triangles in their place.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/pbrt/description.hpp>

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace photongrid::pbrt {

/// A round shape that is whole, in its own space about the z axis; else its triangles are drawn.
struct round_shape {
    enum class kind { none, sphere, cylinder, disk } is = kind::none;
    double radius = 1, low = -1, high = 1; ///< of a disk, `low` is its height
};

/// A shape's surface.
struct shape_surface {
    std::shared_ptr<const mesh> surface; ///< null if only the round shape is known, or if there is none
    std::string file{};                  ///< of the surface, if it is as the file has it
    round_shape round{};
};

/// Makes surfaces. Those that many shapes share, by the same file, are made once.
class shape_reader {
public:
    explicit shape_reader(scene_builder& builder) : builder_(builder) {}

    /// The surface of a shape, whose triangles face outwards as pbrt has it: as vertices' normals do if it has any.
    /// \throws scene_error.
    shape_surface surface_of(const shape_entity& s);
    /// The triangles of a round shape.
    std::shared_ptr<const mesh> triangles_of(const shape_entity& s, const round_shape& r);
    /// The same with texture coordinates for each triangle, as pbrt gives those that have none.
    static std::shared_ptr<const mesh> with_coordinates(const mesh& m);

private:
    mesh triangle_mesh(const shape_entity& s) const;
    mesh bilinear_mesh(const shape_entity& s);
    shape_surface file_mesh(const shape_entity& s);
    shape_surface round(const shape_entity& s);
    /// Counts triangles that are in no file, so that a short file cannot fill the memory.
    void count(const shape_entity& s, const mesh& m);

    scene_builder& builder_;
    std::size_t triangles_ = 0; ///< in the place of round shapes and patches
    /// Meshes of files, by their names and whether they are reversed; with their names if nothing was changed.
    std::map<std::pair<std::string, bool>, shape_surface> files_;
};

} // namespace photongrid::pbrt
