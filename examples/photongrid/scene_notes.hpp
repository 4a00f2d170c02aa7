// Opens a scene of any format, and says how it differs from what its file says.
#pragma once

#include <photongrid/io/scene_import.hpp>

#include <iosfwd>
#include <string>
#include <vector>

namespace photongrid {

/// Prints the first notes, one a line, and how many follow. `most`: how many are printed.
void print_notes(std::ostream& to, const std::vector<import_note>& notes, std::size_t most);

/// Reads a scene; unless `quiet`, prints its notes on stderr.
/// \throws as import_scene.
imported_scene open_scene(const std::string& path, const import_settings& how, bool quiet);

} // namespace photongrid
