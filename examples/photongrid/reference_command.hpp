// The command `reference`: renders a scene without a photon map, for comparison.
#pragma once

#include "command_line.hpp"

#include <functional>

namespace photongrid {

/// Renders, writes the pictures and prints a summary. Throws as `render` does.
exit_code run_reference(const reference_options& o, const std::function<bool()>& cancelled);

} // namespace photongrid
