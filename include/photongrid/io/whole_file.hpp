// The bytes of files of meshes, and words of them in messages.
#pragma once

#include <string>
#include <string_view>

namespace photongrid {

/// All bytes of a file.
/// \throws scene_error if it cannot be read.
std::string whole_file(const std::string& path);

/// A word of a file for messages: short, and without control characters.
std::string shown_word(std::string_view word);

} // namespace photongrid
