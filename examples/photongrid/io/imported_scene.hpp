// What a reader of other programs' scenes makes, and what it is told.
#pragma once

#include <photongrid/io/files.hpp>
#include <photongrid/io/scene_error.hpp>
#include <photongrid/scene/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace photongrid {

/// How to read a scene. The first three are for those that another program wrote.
struct import_settings {
    bool strict = false;        ///< what would be replaced or left out is an error
    bool allow_outside = false; ///< the file may name files outside of its own folder
    /// The length of the file's unit, m; none: that of its format. Lights are scaled along, so that the picture stays
    /// the same.
    std::optional<double> unit{};
    file_listener before_reading{}; ///< hears of the files that the scene's file names; may be empty
    /// A scene file of any format, whose camera and size of the picture are taken in place of the scene's own; empty:
    /// none. Only import_scene() reads it; other readers leave the scene's camera as it is, or without a default.
    std::string camera_from{};
    /// A picture of light from everywhere, in place of the scene's environments; empty: none. Likewise.
    std::string environment{};
    /// How far that picture is turned about y, degrees: 0 has its middle at z, 90 at x, where Blender has it. None: 90
    /// for a scene that Blender wrote, else 0.
    std::optional<double> environment_rotate{};
    /// The unit in which a glTF file has the radiance of surfaces that emit. None: watts for a scene that Blender
    /// wrote, else nits, as glTF says.
    enum class emission { nits, watts }; ///< cd/m^2, or W/(m^2 sr)
    std::optional<emission> emission_unit{};
    /// The most pixels that the pictures which a scene names may have, beside 32 for each of their bytes.
    std::uint64_t max_pixels = file_reading{}.max_pixels;
    bool z_up = false; ///< z is up in the file: the scene is turned so that y is
};

/// Something in a file that photongrid does not have: what stands in its place, or that it is left out.
struct import_note {
    std::string file;       ///< where it stands
    std::size_t line = 0;   ///< counted from 1; 0: the file as a whole
    std::size_t column = 0; ///< counted from 1, in bytes
    std::string what;       ///< as `material "hair": drawn as diffuse 0.5`

    bool operator==(const import_note&) const = default;
};

/// "file:line:column: note: what".
inline std::string text_of(const import_note& n)
{
    return n.file + (n.line > 0 ? ":" + std::to_string(n.line) + ":" + std::to_string(n.column) : "")
        + ": note: " + n.what;
}

/// A scene, and how it differs from what its file says.
struct imported_scene {
    photongrid::scene scene;
    std::vector<import_note> notes;
};

} // namespace photongrid
