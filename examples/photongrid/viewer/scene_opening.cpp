#include "scene_thread.hpp"

namespace photongrid::viewer {

opened_scene open_noting_files(const scene_opener& open, const std::string& path, file_stamps& files)
{
    const auto note = [&](const std::string& file) { files.try_emplace(file, stamp_of(file)); };
    note(path);
    auto made = open(path, note);
    made.files = files;
    return made;
}

} // namespace photongrid::viewer
