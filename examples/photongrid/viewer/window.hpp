// The window: a picture that is redrawn as its scene is edited (section 3.4), and a panel of settings.
#pragma once

#include "render_thread.hpp"

#include <optional>
#include <string>

namespace photongrid::viewer {

struct window_options {
    version begin;                    ///< the first version to draw
    std::string scene_path{};         ///< the scene's file ...
    std::string scene_text{};         ///< ... and its text, of which saved scenes keep all that is not changed
    renderer_maker make;              ///< makes the renderer ...
    renderer_options renderer;        ///< ... with these options; its backend is in `begin`
    std::string stem{};               ///< files that the window saves are called STEM.png, STEM-2.png, …
    std::optional<image> reference{}; ///< to compute errors against
    std::string journal{};            ///< a file for events, one line of JSON each; empty: none
};

/// Opens the window and returns when it is closed, or when `stop_asked` is set. Throws backend_error if there is no
/// display, or no OpenGL on it. It lies in the module `window`.
extern "C" void photongrid_show_window(const window_options& o, bool (*stop_asked)());

} // namespace photongrid::viewer
