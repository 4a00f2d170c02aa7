// The command `error`.
#pragma once

#include "command_line.hpp"

namespace photongrid {

/// Compares two pictures, draws their differences and prints statistics.
/// \throws file_error.
exit_code run_error(const error_options& o);

} // namespace photongrid
