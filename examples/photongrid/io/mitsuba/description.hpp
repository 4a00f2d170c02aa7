// What a scene of Mitsuba says, before anything is made of it: its objects with their properties.
#pragma once

#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/import/scene_files.hpp>
#include <photongrid/io/import/spectra.hpp>

#include <glm/mat4x4.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid::mitsuba {

enum class property_kind { number, whole, truth, text, vector, color, spectrum, blackbody, transform };

/// A property: `<float name="radius" value="2"/>`. Its name is spelled as in Mitsuba 3.
struct property {
    property_kind is = property_kind::number;
    std::string tag, name;
    source_place place;
    std::vector<double> numbers{};             ///< one, or three; of a blackbody: its temperature, K, and scale
    std::string text{};                        ///< of a string; of a spectrum: its file, or ""
    bool truth = false;                        ///< of a boolean
    std::optional<sampled_spectrum> samples{}; ///< of a spectrum that is in no file
    glm::dmat4 matrix{1};                      ///< of a transform
    mutable bool used = false;                 ///< something asked for it
};

struct object;

/// An object within another one, where it stands or by its id.
struct child {
    std::string name; ///< under which the outer one has it, or ""
    source_place place;
    std::string id{};               ///< of a reference
    const object* target = nullptr; ///< not null once all is read
    mutable bool used = false;      ///< something asked for it
};

/// An object: `<bsdf type="diffuse" id="wall">`. Who asks for a property of another type than it has gets a
/// scene_error.
struct object {
    std::string tag, type, id;
    source_place place;
    bool is_old = false; ///< of Mitsuba 0.5 or 0.6
    std::vector<property> properties{};
    std::vector<child> children{};

    const property* find(std::string_view name) const;
    std::optional<double> number(std::string_view name) const;
    double number(std::string_view name, double if_absent) const;
    int whole(std::string_view name, int if_absent) const;
    bool truth(std::string_view name, bool if_absent) const;
    std::string text(std::string_view name, const std::string& if_absent) const;
    std::optional<dvec3> vector(std::string_view name) const;
    glm::dmat4 transform(std::string_view name) const;

    /// The object under a name, or null.
    const child* find_child(std::string_view name) const;
    /// The objects with this tag, in their order.
    std::vector<const child*> all_of(std::string_view tag_of_children) const;

    /// `bsdf "diffuse"`, for messages.
    std::string said() const;
    /// Notes what nothing asked for, as left out.
    void note_unused(import_log& log) const;
};

/// A whole file with all that it includes.
struct description {
    std::vector<std::unique_ptr<object>> objects; ///< the first one is the scene

    const object& scene() const { return *objects.front(); }
};

/// Reads the file `text`, whose name for messages is `file`, and what it includes.
/// \throws scene_error.
description parse(const std::string& file, std::string_view text, const scene_files& files, import_log& log);

} // namespace photongrid::mitsuba
