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
        : std::runtime_error(message(file, line_, column_, what_)), line(line_), column(column_)
    {
    }
    std::size_t line = 0, column = 0;

private:
    // Not by +: g++ 12 warns of memory that literal + string does not touch.
    static std::string message(const std::string& file, std::size_t line, std::size_t column, const std::string& what)
    {
        std::string text = file;
        if (line > 0)
            text.append(":").append(std::to_string(line)).append(":").append(std::to_string(column));
        return text.append(": error: ").append(what);
    }
};

} // namespace photongrid
