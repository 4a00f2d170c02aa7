// Errors in scene files.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace photongrid {

/// An error in a scene file: "file:line:column: error: what was found and what was expected". Lines and columns count
/// from 1, columns in characters. Line 0: the file as a whole ("file: error: …").
struct scene_error : std::runtime_error {
    scene_error(const std::string& file, std::size_t line_, std::size_t column_, const std::string& what_)
        : std::runtime_error(file + (line_ > 0 ? ":" + std::to_string(line_) + ":" + std::to_string(column_) : "")
            + ": error: " + what_),
          line(line_), column(column_)
    {
    }
    std::size_t line = 0, column = 0;
};

} // namespace photongrid
