// The window: a picture that follows what is done to its scene (section 3.4), and a panel of settings.
#pragma once

#include "document.hpp"
#include <photongrid/backends/any/any.hpp>

#include <optional>
#include <string>

namespace photongrid::viewer {

struct window_options {
    version begin;                    ///< what is drawn at first
    renderer_options renderer;        ///< of it, but for the backend
    std::string stem;                 ///< files that the window saves are called STEM.png, STEM-2.png, …
    std::optional<image> reference{}; ///< to measure errors against
    std::string journal{};            ///< a file for what happens, a line of JSON each; empty: none
};

/// Opens the window and returns when it is closed, or when `stop_asked` says so. Throws backend_error where there is no
/// display, or no OpenGL on it.
void show_window(const window_options& o, bool (*stop_asked)());

} // namespace photongrid::viewer
