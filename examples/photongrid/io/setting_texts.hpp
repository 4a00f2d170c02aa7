// What people read of settings, made from the words in setting_table.hpp: for options, tooltips, the schema of scene
// files and docs/reference/settings.md.
#pragma once

#include <photongrid/scene/setting_table.hpp>

#include <string>

namespace photongrid {

/// "--max-radius" for max_radius.
std::string option_of_setting(const std::string& name);
/// "max radius", as controls in the window are called.
std::string label_of_setting(const std::string& name);

/// For the option's line of `--help`: settings are named as options.
std::string help_of_setting(const setting_words& words);
/// Whole sentences: settings are named as in the window.
std::string tooltip_of_setting(const setting_words& words);

/// The schema of scene files with its objects `render` and `as_paper`, and the page with the table between its marks
/// `settings`, as the table of settings gives them; the rest is that of `text`.
/// \throws std::runtime_error if `text` has no such place.
std::string schema_with_settings(const std::string& text);
std::string page_with_settings(const std::string& text);

} // namespace photongrid
