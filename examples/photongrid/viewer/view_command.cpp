#include "view_command.hpp"

#include "../render_command.hpp"
#include "../scene_notes.hpp"
#include "window.hpp"
#include <photongrid/backends/any/module.hpp>
#include <photongrid/io/json_tree.hpp>

#include <iostream>

namespace photongrid {

exit_code run_view(const view_options& o, bool (*stop_asked)())
{
    viewer::window_options w;
    w.make = make_renderer;
    w.scene_path = o.picture.scene_path;
    const auto s = open_scene(w.scene_path, o.picture.how, o.picture.quiet).scene;
    // Only photongrid's own files can be saved with changes: they are changed in place.
    if (format_of_file(w.scene_path) == scene_format::photongrid)
        w.scene_text = read_scene_text(w.scene_path);
    try {
        w.renderer = renderer_asked(o.picture);
        w.begin = {s, settings_for(s, o.picture), w.renderer.backend};
    } catch (const std::invalid_argument& e) {
        std::cerr << "photongrid: error: on the command line: " << e.what() << '\n';
        return usage_error;
    }
    w.stem = file_stem(s.name);
    w.journal = o.journal;
    if (!o.picture.reference.empty())
        w.reference = read_image(o.picture.reference);
    // The window's libraries may be missing where nobody opens one.
    const auto show = reinterpret_cast<decltype(&viewer::photongrid_show_window)>(
        any::function_of_module("window", "photongrid_show_window"));
    show(w, stop_asked);
    return success;
}

} // namespace photongrid
