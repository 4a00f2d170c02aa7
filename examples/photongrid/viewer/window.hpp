// The window: a picture that is redrawn as its scene is edited (section 3.4), and a panel of settings.
#pragma once

#include "render_thread.hpp"
#include "scene_thread.hpp"

#include <optional>
#include <string>

namespace photongrid::viewer {

struct window_options {
    opened_scene begin;               ///< the first scene to draw
    scene_opener open;                ///< opens others, and the present one again, in a thread of the window's
    bool reloads = true;              ///< a scene whose files change is read again
    renderer_maker make;              ///< makes the renderer ...
    renderer_options renderer;        ///< ... with these options
    std::optional<image> reference{}; ///< of the first scene, to compute errors against
    std::string journal{};            ///< a file for events, one line of JSON each; empty: none
};

/// Opens the window and returns when it is closed, or when `stop_asked` is set. Throws backend_error if there is no
/// display, or no OpenGL on it. It lies in the module `window`.
extern "C" void photongrid_show_window(const window_options& o, bool (*stop_asked)());

} // namespace photongrid::viewer
