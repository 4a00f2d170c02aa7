// Shapes of Mitsuba: triangles, and the round ones that have triangles in their place.
#pragma once

#include <photongrid/io/import/scene_builder.hpp>
#include <photongrid/io/mitsuba/description.hpp>

#include <compare>
#include <map>
#include <memory>
#include <string>

namespace photongrid::mitsuba {

/// A round shape in its own space, about the z axis.
struct round_shape {
    enum class kind { none, sphere, cylinder, disk } is = kind::none;
    double radius = 1, height = 0; ///< of a cylinder, from z = 0
    glm::dmat4 to_shape{1};        ///< from this space to that of Mitsuba's shape
};

/// What a shape's material needs of its surface.
struct surface_needs {
    bool coordinates = false, colors = false;
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

    /// The surface of a shape, whose triangles face outwards as Mitsuba has it. Texture coordinates are photongrid's:
    /// v = 1 is the first row of a picture.
    /// \throws scene_error.
    shape_surface surface_of(const object& o, const surface_needs& needs);
    /// The triangles of a round shape, in its own space.
    std::shared_ptr<const mesh> triangles_of(const object& o, const round_shape& r);

private:
    struct file_key {
        std::string name;
        int index;
        bool is_flat, is_reversed, reverse_v, colors, make_coordinates;
        // NOLINTNEXTLINE(modernize-use-nullptr): there is no pointer
        auto operator<=>(const file_key&) const = default;
    };

    shape_surface file_surface(const object& o, const surface_needs& needs);
    mesh read_file(const object& o, const std::string& name, int index, bool* is_flat);
    mesh rectangle() const;
    mesh cube() const;
    shape_surface round(const object& o) const;

    scene_builder& builder_;
    std::size_t triangles_ = 0; ///< in the place of round shapes
    std::map<file_key, shape_surface> files_;
    std::string serialized_name_, serialized_bytes_; ///< of the last one that was read
};

} // namespace photongrid::mitsuba
