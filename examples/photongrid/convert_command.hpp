// The command `convert`.
#pragma once

#include "command_line.hpp"

namespace photongrid {

/// Reads a scene, writes it in another format, and prints what it wrote.
/// \throws as import_scene and export_scene.
exit_code run_convert(const convert_options& o);

} // namespace photongrid
