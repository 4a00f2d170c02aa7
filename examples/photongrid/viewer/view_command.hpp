// The command `view`: a window on a scene.
#pragma once

#include "../command_line.hpp"

namespace photongrid {

/// Returns when the window is closed, or when `stop_asked` is set. Throws scene_error, file_error, or backend_error if
/// there is no display.
exit_code run_view(const view_options& o, bool (*stop_asked)());

} // namespace photongrid
