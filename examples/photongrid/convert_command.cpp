#include "convert_command.hpp"

#include "scene_notes.hpp"
#include <photongrid/io/scene_export.hpp>

#include <filesystem>
#include <iostream>

namespace photongrid {

exit_code run_convert(const convert_options& o)
{
    check_export_path(o.output);
    const auto s = open_scene(o.scene_path, o.how, false).scene;
    const auto made = export_scene(o.output, s, {.strict = o.how.strict, .source = o.scene_path});
    print_notes(std::cerr, made.notes, made.notes.size());
    std::cout << o.output << '\n';
    if (const auto beside = made.files.size() - 1; beside > 0)
        std::cout << std::filesystem::path(made.files.front()).parent_path().string() << ": " << beside
                  << (beside == 1 ? " file\n" : " files\n");
    return success;
}

} // namespace photongrid
