#include <photongrid/io/image_formats.hpp>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace fs = std::filesystem;

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

image read_pfm(const std::string& path)
{
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    std::string magic;
    std::uint32_t width = 0, height = 0;
    double scale = 0;
    if (!(in >> magic))
        fail_file(path, errno != 0 ? std::strerror(errno) : "is empty");
    if ((magic != "PF" && magic != "Pf") || !(in >> width >> height >> scale) || in.get() == EOF || scale == 0
        || !std::isfinite(scale))
        fail_file(path, "is not a PFM file: expected \"PF\" or \"Pf\", width, height, scale");
    check_read_size(path, width, height);
    const std::size_t channels = magic == "PF" ? 3 : 1;
    image picture{.width = width, .height = height, .pixels = {}};
    std::error_code none;
    if (fs::file_size(path, none) < std::uint64_t{width} * height * channels * sizeof(float))
        fail_file(path, "ends too early for its " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    picture.pixels.resize(std::size_t{width} * height);
    std::vector<float> row(width * channels);
    for (std::uint32_t y = height; y-- > 0;) {
        if (!in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float))))
            fail_file(
                path, "ends too early for its " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                auto bits = std::bit_cast<std::uint32_t>(row[x * channels + c % channels]);
                if (scale > 0) // big-endian
                    bits = (bits << 24) | ((bits & 0xFF00u) << 8) | ((bits >> 8) & 0xFF00u) | (bits >> 24);
                picture.pixels[std::size_t{y} * width + x][static_cast<int>(c)]
                    = std::bit_cast<float>(bits) * static_cast<float>(std::abs(scale));
            }
    }
    return picture;
}

} // namespace photongrid::image_formats
