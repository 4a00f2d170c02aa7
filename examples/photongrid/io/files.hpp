// Errors of files, and their atomic replacement.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace photongrid {

/// A file that cannot be read or written: "path: reason".
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Called with the path of a file that a scene names, before it is read, and if it cannot be read too.
using file_listener = std::function<void(const std::string& path)>;

/// How the files that a scene names are read.
struct file_reading {
    file_listener before_reading{}; ///< may be empty
    /// Hears what of a file's content is replaced, as "3 values are below 0 ..."; may be empty.
    std::function<void(const std::string& path, const std::string& what)> note{};
    /// The most pixels that all pictures may have, beside 32 for each of their bytes.
    std::uint64_t max_pixels = std::uint64_t{1} << 26;
};

/// \throws file_error "path: reason".
[[noreturn]] void fail_file(const std::string& path, const std::string& reason);

/// Checks whether `path` can be written, so that a program can report that before it renders.
/// \throws file_error if its folder does not exist or is not writable, or if it is not a regular file.
void check_file_path(const std::string& path);

/// Writes bytes to a temporary file beside `path` and renames it. On an error, or if the program dies, the old file
/// remains.
/// \throws file_error.
void write_file(const std::string& path, const std::string& bytes);

} // namespace photongrid
