// Scenes and settings as the text of scene files; docs/guide/scenes.md describes the format.
#pragma once

#include <photongrid/scene/scene.hpp>

#include <string>

namespace photongrid {

/// The text of a scene file that reads as `s` with `settings`, every number to its last bit. `only` and `aov` are not a
/// scene's. Materials without a name, or with one that another has, are numbered.
std::string scene_text(const scene& s, const render_settings& settings);

/// Settings in the words of a scene file, with `only`, in one line of JSON.
std::string settings_text(const render_settings& s);

} // namespace photongrid
