// Files, written whole or not at all.
#pragma once

#include <stdexcept>
#include <string>

namespace photongrid {

/// A file that cannot be read or written: "path: reason".
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// \throws file_error when `path` cannot become a file: its folder is not there or does not take files, or something
///         that is not a file has its name. Said before hours of rendering, not after.
void check_file_path(const std::string& path);

/// Writes bytes by way of a temporary file beside `path`: on an error, or when the program dies, `path` is what it was
/// before.
/// \throws file_error.
void write_file(const std::string& path, const std::string& bytes);

} // namespace photongrid
