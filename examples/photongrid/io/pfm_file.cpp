#include <photongrid/io/image_formats.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace photongrid::image_formats {

// "PF", width height, -1 (little-endian), rows from the bottom.
static_assert(std::endian::native == std::endian::little, "PFM is written as the machine's own floats");

std::string pfm_bytes(const image& picture)
{
    std::string bytes = "PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n";
    for (std::uint32_t y = picture.height; y-- > 0;)
        bytes.append(reinterpret_cast<const char*>(&picture.pixels[std::size_t{y} * picture.width]),
            picture.width * sizeof(glm::vec3));
    return bytes;
}

namespace {
    /// The next word of a header, which one white character ends.
    std::string_view next_word(std::string_view& left)
    {
        const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        while (!left.empty() && is_space(left.front()))
            left.remove_prefix(1);
        const auto* end = std::find_if(left.begin(), left.end(), is_space);
        const auto word = left.substr(0, static_cast<std::size_t>(end - left.begin()));
        left.remove_prefix(std::min(word.size() + 1, left.size()));
        return word;
    }
    template <class T>
    bool reads(std::string_view word, T& to)
    {
        const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), to);
        return wrong == std::errc() && end == word.data() + word.size();
    }
} // namespace

void decode_pfm(std::string_view bytes, picture_sink& to)
{
    const auto magic = next_word(bytes);
    picture_header header{.channels = magic == "PF" ? 3u : 1u};
    double scale = 0;
    if ((magic != "PF" && magic != "Pf") || !reads(next_word(bytes), header.width)
        || !reads(next_word(bytes), header.height) || !reads(next_word(bytes), scale) || scale == 0
        || !std::isfinite(scale))
        throw std::runtime_error("it is no PFM file: expected \"PF\" or \"Pf\", width, height, scale");
    to.begin(header);
    const std::size_t channels = header.channels, row_bytes = header.width * channels * sizeof(float);
    if (bytes.size() / row_bytes < header.height)
        throw std::runtime_error("the file ends within the picture");
    std::vector<glm::vec4> row(header.width);
    for (std::uint32_t y = header.height; y-- > 0; bytes.remove_prefix(row_bytes)) {
        for (std::size_t x = 0; x < row.size(); ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint32_t bits = 0;
                std::memcpy(&bits, bytes.data() + (x * channels + c % channels) * sizeof(float), sizeof bits);
                if (scale > 0) // big-endian
                    bits = (bits << 24) | ((bits & 0xFF00u) << 8) | ((bits >> 8) & 0xFF00u) | (bits >> 24);
                row[x][static_cast<int>(c)] = std::bit_cast<float>(bits) * static_cast<float>(std::abs(scale));
            }
        for (auto& p : row)
            p.w = 1;
        to.row(y, row);
    }
}

} // namespace photongrid::image_formats
