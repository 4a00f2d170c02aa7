#include <photongrid/io/scene_error.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace photongrid {

std::string whole_file(const std::string& path)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
    std::string bytes;
    if (file) {
        // Straight to their place, for large files, with room for a byte more, so that the end is found at once.
        std::error_code unknown;
        const auto size
            = std::filesystem::is_regular_file(path, unknown) ? std::filesystem::file_size(path, unknown) : 0;
        bytes.resize(unknown ? 1 : static_cast<std::size_t>(size) + 1);
        std::size_t taken = 0;
        for (;;) {
            taken += std::fread(bytes.data() + taken, 1, bytes.size() - taken, file.get());
            if (taken < bytes.size())
                break;
            bytes.resize(2 * taken + (std::size_t{1} << 16)); // it grows, or it is none that has a size
        }
        bytes.resize(taken);
    }
    if (!file || std::ferror(file.get()) != 0)
        throw scene_error(path, 0, 0, std::string("the file cannot be read: ") + std::strerror(errno));
    return bytes;
}

std::string printable(std::string_view text, std::size_t most)
{
    std::string shown;
    for (const char c : text.substr(0, most))
        shown += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F ? '?' : c;
    return shown;
}

std::string shown_word(std::string_view word) { return '"' + printable(word, 40) + '"'; }

} // namespace photongrid
