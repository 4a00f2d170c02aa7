// Writes scenes and settings as scene files. docs/guide/scenes.md describes the format.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <string>

namespace photongrid {

/// The text of a scene file that reads as `s` with `settings`, with all numbers exact. Scene files do not have `only`,
/// `seconds` and `aov`. Materials without a name, or with a duplicate name, are numbered.
std::string scene_text(const scene& s, const render_settings& settings);

/// Settings as in a scene file, with `only` and `seconds`, in one line of JSON.
std::string settings_text(const render_settings& s);

} // namespace photongrid
