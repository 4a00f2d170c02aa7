// The options of `error`.
#pragma once

#include "command_line.hpp"

#include <CLI/CLI.hpp>

namespace photongrid {

void add_error(CLI::App& to, error_options& o);

} // namespace photongrid
