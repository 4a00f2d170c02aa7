#include "scene_notes.hpp"

#include <algorithm>
#include <iostream>

namespace photongrid {

void print_notes(std::ostream& to, const std::vector<import_note>& notes, std::size_t most)
{
    for (std::size_t i = 0; i < std::min(notes.size(), most); ++i)
        to << text_of(notes[i]) << '\n';
    if (notes.size() > most)
        to << "and " << notes.size() - most << " notes more; `photongrid check` prints them all\n";
}

imported_scene open_scene(const std::string& path, const import_settings& how, bool quiet)
{
    auto made = import_scene(path, how);
    if (!quiet)
        print_notes(std::cerr, made.notes, 20);
    return made;
}

} // namespace photongrid
