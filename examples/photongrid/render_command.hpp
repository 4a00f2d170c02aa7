// The command `render`: a scene's picture by its photon map.
#pragma once

#include "command_line.hpp"
#include <photongrid/backends/any/any.hpp>

#include <functional>

namespace photongrid {

/// Renders, writes the pictures and prints a summary. When `stop_asked` is set, writes the picture so far, or saves it
/// for --resume. Throws scene_error, file_error, backend_error, or render_cancelled if there is no picture yet.
exit_code run_render(const render_options& o, const std::function<bool()>& stop_asked);

/// The backend and its options as the command line asks for them.
renderer_options renderer_asked(const render_options& o);

/// The scene's name made into a file name.
std::string file_stem(const std::string& name);

} // namespace photongrid
