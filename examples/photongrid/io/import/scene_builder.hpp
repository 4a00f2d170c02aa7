// Puts together the scene of another program's file: what all formats have in common.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/scene_files.hpp>

#include <algorithm>
#include <glm/mat4x4.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

/// A camera as other programs place it: from its space to the scene's, with its field of view.
struct imported_camera {
    dvec3 position{0}, forward{0, 0, -1}, up{0, 1, 0}, right{1, 0, 0}; ///< in the file's space; of any length
    double fov = 45;                                                   ///< degrees
    enum class axis { vertical, horizontal, smaller, larger } fov_axis = axis::vertical; ///< that of `fov`
};

/// A surface that emits.
struct imported_emission {
    dvec3 radiance{1};      ///< W/(m^2 sr), rgb
    bool two_sided = false; ///< else on the outside of its triangles
};

/// Collects a scene. Places and directions are given in the file's space and become the scene's, which is in metres and
/// right-handed. What cannot be is a scene_error with the place that is given, or a note.
class scene_builder {
public:
    /// `path`: the scene's file.
    scene_builder(const std::string& path, const import_settings& settings);

    const import_settings& settings() const { return settings_; }
    scene_files& files() { return files_; }
    import_log& log() { return log_; }
    void note(const source_place& place, const std::string& what) { log_.add(place, what); }

    /// \name What comes first
    /// @{
    /// The length of the file's unit, m, unless the settings give one. Before all that has a length.
    void set_unit(double metres);
    /// The picture's size and the camera. A camera whose right is on the left of a right-handed one makes the scene's
    /// z axis the file's, reversed. Before all that has a place.
    void set_camera(const source_place& place, const imported_camera& c, std::uint32_t width, std::uint32_t height);
    /// @}

    /// Adds a material. Returns its index.
    /// \throws scene_error for one that check() rejects.
    std::uint32_t add_material(const source_place& place, material m);
    /// Whether a material needs texture coordinates.
    bool has_texture(std::uint32_t m) const { return photongrid::has_texture(made_.materials, made_.materials[m]); }
    /// A mixture of two materials; where photongrid does not mix these, a note, and the one with the larger share.
    std::uint32_t add_mixture(const source_place& place, material m, std::uint32_t first, std::uint32_t second);
    /// The same material with an opacity, which meshes alone may have.
    std::uint32_t with_opacity(const source_place& place, std::uint32_t m, double opacity, const texture_use& texture);
    /// Of thin glass, the same as a body of glass; others themselves.
    std::uint32_t as_body(const source_place& place, std::uint32_t m);
    /// What has no surface but absorbs as much: glass of the index of refraction 1.
    std::uint32_t add_medium(const source_place& place, const std::string& name, const dvec3& absorbed);
    /// The same material, if it is glass, with what it absorbs of light by each of the file's units of length.
    std::uint32_t with_absorption(const source_place& place, std::uint32_t m, const dvec3& absorbed);

    /// A texture, or none if its file cannot be read, with a note that 0.5 is in its place.
    /// \throws scene_error for a file outside of the scene's folder.
    std::optional<texture_use> texture(const source_place& place, const std::string& name, texture_holds holds);

    /// \name Shapes and lights
    /// `to_scene`: from the shape's space to the file's. `file`: that of the surface, or "".
    /// @{
    /// A material with a texture needs a surface with texture coordinates.
    void add_mesh(const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene,
        std::uint32_t material, const std::string& file = "");
    /// A rectangle becomes a rectangle_light, other surfaces a mesh_light.
    void add_emitter(const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene,
        const imported_emission& e, const std::string& file = "");
    /// Sphere about the origin. Returns whether it still is one in the scene; if not, nothing is added.
    bool add_sphere(const source_place& place, double radius, const glm::dmat4& to_scene, std::uint32_t material);
    bool add_sphere_light(
        const source_place& place, double radius, const glm::dmat4& to_scene, const imported_emission& e);
    /// The side of a cylinder about the z axis. Likewise.
    bool add_cylinder(const source_place& place, double radius, double low, double high, const glm::dmat4& to_scene,
        std::uint32_t material);
    /// A disk about the z axis. Likewise.
    bool add_disk(
        const source_place& place, double height, double radius, const glm::dmat4& to_scene, std::uint32_t material);

    /// `intensity`: W/sr, rgb, for lengths in the file's unit.
    void add_point_light(const source_place& place, const dvec3& position, const dvec3& intensity);
    /// Angles in degrees from the axis.
    void add_spot_light(const source_place& place, const dvec3& position, const dvec3& direction, double inner_angle,
        double outer_angle, const dvec3& intensity);
    void add_directional_light(const source_place& place, const dvec3& direction, const dvec3& irradiance);
    /// Light of one radiance from everywhere.
    void add_sky(const source_place& place, const dvec3& radiance);
    /// A picture of light from everywhere, in the space of environment_map. Of several the first one is kept.
    void add_environment(const source_place& place, std::shared_ptr<const environment_map> map, const dvec3& radiance,
        const glm::dmat4& to_scene, const std::string& file = "");
    /// @}

    /// The most surfaces of a path that the file wants, 0 to many.
    void set_depth(int surfaces) { depth_ = static_cast<std::uint32_t>(std::clamp(surfaces, 1, 64)); }

    /// The area of a surface in the scene, in the file's unit squared.
    double area(const mesh& surface, const glm::dmat4& to_scene) const;

    /// The scene, with a camera and light if there are none, and settings that suit its size.
    /// \throws scene_error for a scene that cannot be drawn.
    imported_scene finish();

private:
    struct placing {
        glm::dmat3 linear;
        dvec3 offset;
    };
    placing place_in_scene(const source_place& place, const glm::dmat4& to_scene) const;
    placed_mesh placed(const source_place& place, std::shared_ptr<const mesh> surface, const glm::dmat4& to_scene,
        const std::string& file);
    /// The surface in the scene, if its transformation flattens it, as a scale of 0 does: what is left of it, which may
    /// be nothing. Null for others.
    std::shared_ptr<const mesh> flattened(const source_place& place, const mesh& surface, const glm::dmat4& to_scene);
    /// The surface without what cannot be drawn, with a note where it first comes; null if nothing is left.
    std::shared_ptr<const mesh> drawable(const source_place& place, std::shared_ptr<const mesh> surface);
    dvec3 point(const dvec3& p) const { return dvec3(world_ * glm::dvec4(p, 1)); }
    dvec3 direction(const dvec3& d) const { return glm::dmat3(world_) * d; }
    /// The factor on a round shape's lengths. 0: it is stretched, or its material is for meshes alone (a texture or an
    /// opacity).
    double round_scale(const placing& at, std::uint32_t material) const;
    template <class List, class Light>
    void add_light(const source_place& place, List& list, Light light);
    std::string next_light_name();
    /// As add_material(), unless the scene has one like it.
    std::uint32_t add_once(const source_place& place, material m);
    void add_default_camera();
    /// Says that z may be up, as in plans and surveys: OBJ and PLY do not tell.
    void note_flat_along_z();
    void add_environment_light();

    scene made_;
    source_place file_;
    import_settings settings_;
    import_log log_;
    scene_files files_;
    double unit_ = 1;
    glm::dmat4 world_{1}; ///< from the file's space to the scene's
    bool has_camera_ = false;
    std::optional<std::uint32_t> depth_;                                        ///< the most surfaces of a path
    std::vector<source_place> sphere_places_;                                   ///< of each sphere
    std::map<std::shared_ptr<const mesh>, std::shared_ptr<const mesh>> mended_; ///< by what they were
    dvec3 sky_{0};
    std::optional<environment_light> environment_;
    std::optional<source_place> sky_place_;
    std::uint32_t lights_ = 0;
};

} // namespace photongrid
