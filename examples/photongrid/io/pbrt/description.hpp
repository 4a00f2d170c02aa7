// What a pbrt-v4 file says, before anything is made of it: its directives with their parameters, and the graphics state
// (transformation, material, …) that each shape and light had.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/io/import/spectra.hpp>

#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::pbrt {

/// The colour spaces of `ColorSpace`, by name; null for another name.
const rgb_primaries* color_space(std::string_view name);

/// A parameter: `"rgb L" [ 17 12 4 ]`.
struct parameter {
    std::string type, name;
    source_place place;
    std::vector<double> numbers{};
    std::vector<std::string> texts{}; ///< of strings, textures and named spectra
    std::vector<bool> truths{};       ///< of bool
    mutable bool used = false;        ///< something asked for it
};

/// The parameters of a directive. Who asks for one of another type than it has gets a scene_error.
class parameter_list {
public:
    void add(parameter p) { all_.push_back(std::move(p)); }
    /// Adds those of `defaults` that are not here.
    void add_absent(const parameter_list& defaults);

    const parameter* find(std::string_view name) const;
    /// The same to be changed, without being asked for; null if there is none.
    parameter* change(std::string_view name);
    double number(std::string_view name, double if_absent) const;
    std::optional<double> number(std::string_view name) const;
    int whole(std::string_view name, int if_absent) const;
    bool truth(std::string_view name, bool if_absent) const;
    std::string text(std::string_view name, const std::string& if_absent) const;
    /// All numbers of a parameter that is one of `types`, a multiple of `together`; empty if it is absent.
    std::vector<double> numbers(
        std::string_view name, std::initializer_list<std::string_view> types, std::size_t together) const;
    std::optional<dvec3> point(std::string_view name) const;

    /// Notes those that nothing asked for, as left out. `of`: of what they are.
    void note_unused(import_log& log, const std::string& of) const;

private:
    std::vector<parameter> all_;
};

/// A directive with a type: Camera "perspective", Shape "sphere", ….
struct entity {
    std::string type;
    parameter_list parameters{};
    source_place place;
    const rgb_primaries* colors = nullptr; ///< those of its rgb parameters
    glm::dmat4 to_world{1};                ///< the transformation where it stands
};

/// A material, by its name or its place in the list.
struct material_reference {
    std::optional<std::string> name{}; ///< of MakeNamedMaterial
    std::size_t index = 0;             ///< into description::materials
};

struct shape_entity : entity {
    material_reference material{};
    std::optional<std::size_t> area_light{}; ///< index into description::area_lights
    bool reverse_orientation = false;
    std::string inside{}, outside{}; ///< names of the media on its sides; empty: none
};

struct object_instance {
    std::string name;
    source_place place;
    glm::dmat4 to_world{1};
};

/// A whole file with all that it includes.
struct description {
    std::optional<entity> camera, film, filter, integrator;
    glm::dmat4 camera_to_world{1};
    std::vector<entity> materials; ///< the first one is that of shapes before any Material
    std::map<std::string, std::size_t> named_materials;
    std::map<std::string, entity> textures; ///< by "name/float" or "name/spectrum": these are apart
    std::map<std::string, entity> media;
    std::vector<entity> area_lights, lights;
    std::vector<shape_entity> shapes;
    std::map<std::string, std::vector<shape_entity>> objects;
    std::vector<object_instance> instances;
};

/// Reads the file `text`, whose name for messages is `file`, and what it includes.
/// \throws scene_error.
description parse(const std::string& file, std::string_view text, const scene_files& files, import_log& log);

} // namespace photongrid::pbrt
