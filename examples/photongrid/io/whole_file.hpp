// The bytes of files of meshes, and words of them in messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace photongrid {

/// All bytes of a file.
/// \throws scene_error if it cannot be read.
std::string whole_file(const std::string& path);

/// The first `most` bytes of a text, with "?" for each byte that is no printable ASCII character.
std::string printable(std::string_view text, std::size_t most);

/// A word of a file for messages, in quotes: short, and without control characters.
std::string shown_word(std::string_view word);

} // namespace photongrid
