#include <photongrid/io/image_file.hpp>
#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>

namespace photongrid {

namespace fs = std::filesystem;

void image_formats::check_read_size(const std::string& path, std::int64_t width, std::int64_t height)
{
    constexpr std::int64_t max_edge = 65536, max_pixels = std::int64_t{1} << 28;
    if (width < 1 || height < 1 || width > max_edge || height > max_edge || width * height > max_pixels)
        fail_file(path,
            "is " + std::to_string(width) + " x " + std::to_string(height)
                + " pixels; expected at most 65536 per side and 2^28 in total");
}

namespace {
    std::string ending(const std::string& path)
    {
        auto e = fs::path(path).extension().string();
        std::transform(e.begin(), e.end(), e.begin(),
            [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
        return e;
    }
} // namespace

bool holds_layers(const std::string& path) { return ending(path) == ".exr"; }
bool is_for_display(const std::string& path) { return ending(path) == ".png"; }

void check_image_path(const std::string& path)
{
    const auto e = ending(path);
    if (e != ".png" && e != ".exr" && e != ".pfm")
        fail_file(path, "has no known extension; expected .png, .exr or .pfm");
    check_file_path(path);
}

void write_image(const std::string& path, const image& picture, double exposure, const image_notes& notes)
{
    check_image_path(path);
    if (picture.width == 0 || picture.height == 0
        || picture.pixels.size() != std::size_t{picture.width} * picture.height)
        fail_file(path,
            "the picture has " + std::to_string(picture.pixels.size()) + " pixels for " + std::to_string(picture.width)
                + " x " + std::to_string(picture.height));
    const auto e = ending(path);
    std::string bytes;
    try {
        bytes = e == ".png" ? image_formats::png_bytes(picture, exposure)
            : e == ".exr"   ? image_formats::exr_bytes(picture, notes)
                            : image_formats::pfm_bytes(picture);
    } catch (const std::exception& what) {
        fail_file(path, std::string("cannot be encoded: ") + what.what());
    }
    write_file(path, bytes);
}

namespace {
    /// A format that can be read, by the ending of its files.
    template <class Picture>
    struct readable {
        std::string_view ending;
        Picture (*read)(const std::string& path);
    };

    /// \throws file_error, for another ending with `expected`.
    template <class Picture>
    Picture read_as(std::span<const readable<Picture>> formats, const std::string& path, const char* expected)
    {
        const auto e = ending(path);
        const auto* format = std::find_if(
            formats.data(), formats.data() + formats.size(), [&](const auto& f) { return f.ending == e; });
        if (format == formats.data() + formats.size())
            fail_file(path, std::string("has no known extension; expected ") + expected);
        if (std::error_code none; fs::is_directory(path, none))
            fail_file(path, "is a folder");
        try {
            return format->read(path);
        } catch (const file_error&) {
            throw;
        } catch (const std::exception& what) {
            fail_file(path, std::string("cannot be read: ") + what.what());
        }
    }
} // namespace

image read_image(const std::string& path)
{
    static constexpr readable<image> formats[] = {{".exr", image_formats::read_exr}, {".pfm", image_formats::read_pfm}};
    return read_as<image>(formats, path, ".exr or .pfm (a PNG is tone-mapped and clamped, so it cannot be measured)");
}

namespace {
    /// A picture without transparency.
    picture_channels opaque(const image& picture, bool is_srgb)
    {
        picture_channels made{picture.width, picture.height, {}, is_srgb};
        made.pixels.reserve(picture.pixels.size());
        for (const auto& p : picture.pixels)
            made.pixels.emplace_back(p, 1.0f);
        return made;
    }
    template <image (*Read)(const std::string&), bool IsSrgb = false>
    picture_channels read_opaque(const std::string& path)
    {
        return opaque(Read(path), IsSrgb);
    }
} // namespace

picture_channels read_channels(const std::string& path)
{
    using namespace image_formats;
    static constexpr readable<picture_channels> formats[] = {{".exr", read_opaque<read_exr>},
        {".pfm", read_opaque<read_pfm>}, {".hdr", read_opaque<read_hdr>}, {".png", read_png_channels},
        {".tga", read_tga_channels}, {".jpg", read_opaque<read_jpeg, true>}, {".jpeg", read_opaque<read_jpeg, true>}};
    return read_as<picture_channels>(formats, path, ".exr, .hdr, .pfm, .png, .jpg or .tga");
}

picture_channels decode_channels(const std::string& name, std::string_view bytes)
{
    try {
        if (bytes.starts_with("\x89PNG"))
            return image_formats::png_channels(name, bytes);
        if (bytes.starts_with("\xFF\xD8\xFF"))
            return opaque(image_formats::jpeg_picture(name, bytes), true);
    } catch (const file_error&) {
        throw;
    } catch (const std::exception& what) {
        fail_file(name, std::string("cannot be read: ") + what.what());
    }
    fail_file(name, "is neither a PNG nor a JPEG file");
}

image read_linear_image(const std::string& path)
{
    const auto picture = read_channels(path);
    image made{.width = picture.width, .height = picture.height, .pixels = {}};
    made.pixels.reserve(picture.pixels.size());
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        made.pixels.push_back(linear_pixel(picture, i));
    return made;
}

glm::vec3 linear_pixel(const picture_channels& picture, std::size_t pixel)
{
    const glm::vec3 p(picture.pixels[pixel]);
    if (!picture.is_srgb)
        return p;
    const auto decoded = [](float v) { return linear_value(static_cast<unsigned char>(std::lround(v * 255.0f))); };
    return {decoded(p.x), decoded(p.y), decoded(p.z)};
}

} // namespace photongrid
