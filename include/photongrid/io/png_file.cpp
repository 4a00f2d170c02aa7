#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/tone_map.hpp>

#include <png.h>

#include <stdexcept>
#include <vector>

namespace photongrid::image_formats {

std::string png_bytes(const image& picture, double exposure)
{
    const tone_map to_screen(exposure);
    std::vector<unsigned char> rgb;
    rgb.reserve(picture.pixels.size() * 3);
    for (const auto& p : picture.pixels)
        for (int c = 0; c < 3; ++c)
            rgb.push_back(to_screen(p[c]));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = picture.width;
    png.height = picture.height;
    png.format = PNG_FORMAT_RGB; // 8 bits, sRGB
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr))
        throw std::runtime_error(png.message);
    bytes.resize(size);
    return bytes;
}

} // namespace photongrid::image_formats
