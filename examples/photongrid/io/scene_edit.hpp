// Edits scene text in place: replaces changed values, keeps formatting and comments.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <string>

namespace photongrid {

/// The text of a scene file, with the values replaced that differ in `s` and `settings`: those of the camera, of shapes
/// and lights, and settings, as editors change them. Units, layout, order, comments, "$schema" and all other values
/// stay. Changed numbers are in the file's units and read as those of `s`, or as the next double where the conversion
/// skips them. Scene files do not have `only` and `aov`. `file`: the name that `text` was parsed with.
/// \throws scene_error if `text` is not a scene file.
/// \throws std::invalid_argument if `s` has other materials, shapes or lights, or others' names or materials;
/// scene_text() writes any scene.
std::string edited_scene_text(
    const std::string& file, const std::string& text, const scene& s, const render_settings& settings);

} // namespace photongrid
