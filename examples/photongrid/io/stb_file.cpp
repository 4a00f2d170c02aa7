// Radiance HDR and TGA, by stb_image.
#include <photongrid/io/image_formats.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace photongrid::image_formats {

namespace {
    /// The bytes of a file as stb_image reads them. It takes what is missing at the end of a file for zeros.
    struct source {
        std::string_view bytes;
        std::size_t at = 0;
        bool past_end = false;
    };
    /// Reads up to `size` bytes and returns how many there were.
    int read_bytes(void* user, char* to, int size)
    {
        auto& s = *static_cast<source*>(user);
        const auto n = std::min(static_cast<std::size_t>(size), s.bytes.size() - s.at);
        std::copy_n(s.bytes.begin() + static_cast<std::ptrdiff_t>(s.at), n, to);
        s.at += n;
        s.past_end = s.past_end || n == 0;
        return static_cast<int>(n);
    }

    void skip_bytes(void* user, int n)
    {
        auto& s = *static_cast<source*>(user);
        const auto to = static_cast<std::int64_t>(s.at) + n, end = static_cast<std::int64_t>(s.bytes.size());
        s.past_end = s.past_end || to > end;
        s.at = static_cast<std::size_t>(std::clamp<std::int64_t>(to, 0, end));
    }

    int is_at_end(void* user)
    {
        const auto& s = *static_cast<source*>(user);
        return s.at == s.bytes.size() ? 1 : 0;
    }

    constexpr stbi_io_callbacks from_source{read_bytes, skip_bytes, is_at_end};

    /// The size that stb_image finds.
    picture_header header_of(std::string_view bytes)
    {
        source begin{bytes};
        int width = 0, height = 0, channels = 0;
        if (!stbi_info_from_callbacks(&from_source, &begin, &width, &height, &channels))
            throw std::runtime_error(stbi_failure_reason());
        return {.width = static_cast<std::uint32_t>(width), .height = static_cast<std::uint32_t>(height)};
    }
    /// `load` returns four channels a pixel.
    template <class Load>
    auto loaded(std::string_view bytes, Load load)
    {
        source whole{bytes};
        int width = 0, height = 0, channels = 0;
        const auto data = load(&from_source, &whole, &width, &height, &channels, 4);
        std::unique_ptr<std::remove_pointer_t<decltype(data)>, decltype(&stbi_image_free)> owned(data, stbi_image_free);
        if (data == nullptr)
            throw std::runtime_error(stbi_failure_reason());
        if (whole.past_end)
            throw std::runtime_error("the file ends within the picture");
        return owned;
    }

    /// The header of a Radiance picture: its lines up to an empty one, and that of its size.
    struct hdr_header {
        double exposure = 1;                       ///< by which its values were multiplied
        glm::dvec3 colours = {1, 1, 1};            ///< likewise
        bool is_xyz = false;                       ///< its values are CIE XYZ
        char slow = 'Y', fast = 'X';               ///< the axes along which rows follow each other, and pixels in a row
        bool slow_falls = true, fast_grows = true; ///< as in nearly all pictures, whose rows come from the top
        std::uint32_t rows = 0, row_pixels = 0;
        std::string_view pixels;
    };
    /// "-Y 512" at the beginning of `line`, which it removes.
    std::optional<std::uint32_t> size_along(std::string_view& line, char& axis, bool& grows)
    {
        while (line.starts_with(' '))
            line.remove_prefix(1);
        if (line.size() < 4 || (line[0] != '-' && line[0] != '+') || (line[1] != 'X' && line[1] != 'Y')
            || line[2] != ' ')
            return std::nullopt;
        grows = line[0] == '+';
        axis = line[1];
        std::uint32_t n = 0;
        const auto [end, wrong] = std::from_chars(line.data() + 3, line.data() + line.size(), n);
        if (wrong != std::errc() || n == 0)
            return std::nullopt;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        return n;
    }
    /// "EXPOSURE=4" as 4, of a line whose name is that.
    std::vector<double> numbers_of(std::string_view line)
    {
        std::vector<double> all;
        for (const auto* at = line.data(); at != line.data() + line.size();) {
            if (*at == ' ' || *at == '\t') {
                ++at;
                continue;
            }
            double x = 0;
            const auto [end, wrong] = std::from_chars(at, line.data() + line.size(), x);
            if (wrong != std::errc() || !(x > 0) || !std::isfinite(x))
                throw std::runtime_error("its EXPOSURE or COLORCORR is no number above 0");
            all.push_back(x);
            at = end;
        }
        return all;
    }
    hdr_header parse_hdr(std::string_view bytes)
    {
        hdr_header h;
        const auto next_line = [&] {
            const auto end = bytes.find('\n');
            if (end == std::string_view::npos)
                throw std::runtime_error("its header does not end");
            auto line = bytes.substr(0, end);
            bytes.remove_prefix(end + 1);
            if (line.ends_with('\r'))
                line.remove_suffix(1);
            return line;
        };
        for (auto line = next_line(); !line.empty(); line = next_line()) {
            const auto value
                = [&](std::string_view name) { return line.starts_with(name) ? line.substr(name.size()) : ""; };
            if (const auto text = value("EXPOSURE="); !text.empty())
                for (const double x : numbers_of(text))
                    h.exposure *= x;
            if (const auto text = value("COLORCORR="); !text.empty())
                if (const auto three = numbers_of(text); three.size() == 3)
                    h.colours *= glm::dvec3(three[0], three[1], three[2]);
            h.is_xyz = h.is_xyz || line == "FORMAT=32-bit_rle_xyze";
        }
        auto line = next_line();
        bool slow_grows = false;
        const auto rows = size_along(line, h.slow, slow_grows), row_pixels = size_along(line, h.fast, h.fast_grows);
        if (!rows || !row_pixels || h.slow == h.fast)
            throw std::runtime_error("its size is not given as in \"-Y 512 +X 1024\"");
        h.slow_falls = !slow_grows;
        h.rows = *rows;
        h.row_pixels = *row_pixels;
        h.pixels = bytes;
        return h;
    }
} // namespace

void decode_hdr(std::string_view bytes, picture_sink& to)
{
    const auto h = parse_hdr(bytes);
    const bool turned = h.slow == 'X'; // columns follow each other
    const picture_header header{.width = turned ? h.rows : h.row_pixels, .height = turned ? h.row_pixels : h.rows};
    to.begin(header);
    // stb_image knows one order of axes and RGBE.
    const auto plain = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(h.rows) + " +X "
        + std::to_string(h.row_pixels) + '\n' + std::string(h.pixels);
    const auto data = loaded(plain, stbi_loadf_from_callbacks);
    const auto scale = glm::vec3(1.0 / (h.exposure * h.colours));
    std::vector<glm::vec4> row(header.width);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        for (std::uint32_t x = 0; x < header.width; ++x) {
            // Y grows upwards, X to the right.
            const auto along = [&](std::uint32_t at, std::uint32_t n, bool grows) { return grows ? at : n - 1 - at; };
            const auto slow = turned ? along(x, h.rows, !h.slow_falls) : along(y, h.rows, h.slow_falls);
            const auto fast = turned ? along(y, h.row_pixels, !h.fast_grows) : along(x, h.row_pixels, h.fast_grows);
            const float* at = data.get() + 4 * (std::size_t{slow} * h.row_pixels + fast);
            glm::vec3 p(at[0], at[1], at[2]);
            if (h.is_xyz) // to linear sRGB (IEC 61966-2-1)
                p = glm::vec3(3.2406f * p.x - 1.5372f * p.y - 0.4986f * p.z,
                    -0.9689f * p.x + 1.8758f * p.y + 0.0415f * p.z, 0.0557f * p.x - 0.2040f * p.y + 1.0570f * p.z);
            row[x] = glm::vec4(p * scale, 1.0f);
        }
        to.row(y, row);
    }
}

void decode_tga(std::string_view bytes, picture_sink& to)
{
    auto header = header_of(bytes);
    header.is_srgb = true;
    to.begin(header);
    const auto data = loaded(bytes, stbi_load_from_callbacks);
    const auto descriptor = static_cast<unsigned char>(bytes[17]); // stb_image looks at its bit 5 alone
    const bool has_alpha = (descriptor & 0x0F) != 0, from_right = (descriptor & 0x10) != 0;
    std::vector<glm::vec4> row(header.width);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        for (std::uint32_t x = 0; x < header.width; ++x) {
            const auto column = from_right ? header.width - 1 - x : x;
            const auto* at = data.get() + 4 * (std::size_t{y} * header.width + column);
            row[x] = glm::vec4(at[0], at[1], at[2], has_alpha ? at[3] : 255) / 255.0f;
        }
        to.row(y, row);
    }
}

} // namespace photongrid::image_formats
