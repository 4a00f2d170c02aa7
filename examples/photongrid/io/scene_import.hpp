// Reads scenes of any format that photongrid knows.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <string_view>

namespace photongrid {

/// The formats of scenes.
enum class scene_format { photongrid, pbrt, mitsuba, gltf, obj, ply };

/// The format of a file by its content, or else by its name. `text`: at least the first 64 KiB of it.
scene_format format_of(const std::string& path, std::string_view text);

/// That of a file. Of one that cannot be read, by its name.
scene_format format_of_file(const std::string& path);

/// Reads a scene file of any of these formats. photongrid's own have their units, and no notes.
/// \throws scene_error; std::invalid_argument for settings out of range.
imported_scene import_scene(const std::string& path, const import_settings& settings = {});

} // namespace photongrid
