#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/tone_map.hpp>

#include <png.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace photongrid::image_formats {

namespace {
    /// `format`: of `channels`, 8 bits each, sRGB.
    std::string written(
        std::uint32_t width, std::uint32_t height, png_uint_32 format, const std::vector<unsigned char>& channels)
    {
        png_image png{};
        png.version = PNG_IMAGE_VERSION;
        png.width = width;
        png.height = height;
        png.format = format;
        png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
        std::string bytes(size, '\0');
        if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, channels.data(), 0, nullptr))
            throw std::runtime_error(png.message);
        bytes.resize(size);
        return bytes;
    }
} // namespace

std::string png_bytes(const image& picture, double exposure)
{
    const tone_map to_screen(exposure);
    std::vector<unsigned char> rgb;
    rgb.reserve(picture.pixels.size() * 3);
    for (const auto& p : picture.pixels)
        for (int c = 0; c < 3; ++c)
            rgb.push_back(to_screen(p[c]));
    return written(picture.width, picture.height, PNG_FORMAT_RGB, rgb);
}

std::string png_bytes(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& rgba)
{
    return written(width, height, PNG_FORMAT_RGBA, rgba);
}

namespace {
    /// `begin` makes libpng read the header.
    template <class Begin>
    picture_channels read_channels_by(const std::string& path, Begin begin)
    {
        png_image png{};
        png.version = PNG_IMAGE_VERSION;
        const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&png, png_image_free);
        if (!begin(&png))
            throw std::runtime_error(png.message);
        check_read_size(path, png.width, png.height);
        png.format = PNG_FORMAT_RGBA; // 8 bits, sRGB; libpng's own linear format is decoded through 8 bits
        std::vector<png_byte> rgba(std::size_t{png.width} * png.height * 4);
        if (!png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr))
            throw std::runtime_error(png.message);
        picture_channels picture{.width = png.width, .height = png.height, .pixels = {}, .is_srgb = true};
        picture.pixels.reserve(rgba.size() / 4);
        for (std::size_t i = 0; i < rgba.size(); i += 4)
            picture.pixels.push_back(glm::vec4(rgba[i], rgba[i + 1], rgba[i + 2], rgba[i + 3]) / 255.0f);
        return picture;
    }
} // namespace

picture_channels read_png_channels(const std::string& path)
{
    return read_channels_by(path, [&](png_image* png) { return png_image_begin_read_from_file(png, path.c_str()); });
}

picture_channels png_channels(const std::string& path, std::string_view bytes)
{
    return read_channels_by(
        path, [&](png_image* png) { return png_image_begin_read_from_memory(png, bytes.data(), bytes.size()); });
}

} // namespace photongrid::image_formats
