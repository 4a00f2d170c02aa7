#include "view_command.hpp"

#include "../render_command.hpp"
#include "../scene_notes.hpp"
#include "window.hpp"
#include <photongrid/backends/any/module.hpp>
#include <photongrid/io/import/import_log.hpp>
#include <photongrid/io/json_tree.hpp>
#include <photongrid/io/scene_file.hpp>

#include <iostream>
#include <utility>

namespace photongrid {

namespace {
    /// Opens scenes for the window; used by one thread at a time.
    class scene_reader {
    public:
        explicit scene_reader(const render_options& o) : options_(o) {}

        viewer::opened_scene operator()(const std::string& path, const file_listener& before_reading)
        {
            viewer::opened_scene made{.path = path};
            auto how = options_.how;
            how.before_reading = before_reading;
            std::vector<import_note> notes;
            // Only photongrid's own files can be saved with changes: they are changed in place.
            if (format_of_file(path) == scene_format::photongrid) {
                made.text = read_scene_text(path);
                import_log log(how.strict);
                made.scene = parse_scene(path, made.text, file_reading_of(how, log));
                notes = log.take();
            } else {
                auto read = import_scene(path, how);
                made.scene = std::move(read.scene);
                notes = std::move(read.notes);
            }
            made.settings = settings_for(made.scene, options_);
            made.stem = file_stem(made.scene.name);
            made.notes = notes.size();
            if (!options_.quiet && notes != printed_) // not once more when the scene is read again
                print_notes(std::cerr, notes, 20);
            printed_ = std::move(notes);
            return made;
        }

    private:
        render_options options_;
        std::vector<import_note> printed_;
    };
} // namespace

exit_code run_view(const view_options& o, bool (*stop_asked)())
{
    viewer::window_options w;
    w.make = make_renderer;
    w.open = scene_reader(o.picture);
    w.reloads = !o.no_reload;
    if (o.picture.how.unit && format_of_file(o.picture.scene_path) == scene_format::photongrid)
        import_scene(o.picture.scene_path, o.picture.how); // says that it has a unit of its own
    try {
        viewer::file_stamps files;
        w.begin = viewer::open_noting_files(w.open, o.picture.scene_path, files);
        w.renderer = candidates(renderer_asked(o.picture)).front();
    } catch (const std::invalid_argument& e) {
        std::cerr << "photongrid: error: on the command line: " << e.what() << '\n';
        return usage_error;
    }
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
