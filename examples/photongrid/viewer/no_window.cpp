// Replaces the window where CMake found no GLFW or no Dear ImGui.
#include "view_command.hpp"

#include <photongrid/core/backend.hpp>

namespace photongrid {

exit_code run_view(const view_options&, bool (*)())
{
    throw backend_error("view: this photongrid was built without its window; install libglfw3-dev, libimgui-dev and "
                        "libgl-dev, then configure again. `photongrid render --progressive DIR` needs none");
}

} // namespace photongrid
