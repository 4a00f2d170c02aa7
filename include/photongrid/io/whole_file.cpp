#include <photongrid/io/scene_error.hpp>
#include <photongrid/io/whole_file.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace photongrid {

std::string whole_file(const std::string& path)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
    std::string bytes;
    if (file) {
        std::vector<char> block(std::size_t{1} << 20);
        while (const auto n = std::fread(block.data(), 1, block.size(), file.get()))
            bytes.append(block.data(), n);
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
