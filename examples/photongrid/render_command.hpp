// The command `render`: a scene's picture by its photon map.
#pragma once

#include "command_line.hpp"
#include <photongrid/backends/any/any.hpp>

#include <functional>

namespace photongrid {

/// Renders, writes the pictures and says what was done. When `stop_asked` says so, what there is is written, or kept
/// for --resume. Throws scene_error, file_error, backend_error, render_cancelled when there is no picture yet.
exit_code run_render(const render_options& o, const std::function<bool()>& stop_asked);

/// The renderer that --backend and its companions name; says on stderr what `auto` chose.
renderer_options renderer_asked(const render_options& o);

/// A scene's name as a file's.
std::string file_stem(const std::string& name);

} // namespace photongrid
