// Radiance HDR, JPEG and TGA, by stb_image.
#include <photongrid/io/image_formats.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
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
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace photongrid::image_formats {

namespace {
    std::string bytes_of(const std::string& path)
    {
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        const auto size = file.tellg();
        if (!file)
            throw std::runtime_error(std::strerror(errno));
        if (size > (std::streamoff{1} << 30))
            fail_file(path, "is larger than 2^30 bytes");
        std::string bytes(static_cast<std::size_t>(size), '\0');
        file.seekg(0);
        if (!file.read(bytes.data(), size))
            throw std::runtime_error(std::strerror(errno));
        return bytes;
    }

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

    /// `load` returns so many channels a pixel, which `add` takes with their number of pixels.
    template <class Load, class Add>
    void read(const std::string& path, std::string_view bytes, int channels_wanted, Load load, Add add)
    {
        int width = 0, height = 0, channels = 0;
        source begin{bytes}, whole{bytes};
        if (!stbi_info_from_callbacks(&from_source, &begin, &width, &height, &channels))
            throw std::runtime_error(stbi_failure_reason());
        check_read_size(path, width, height);
        const auto data = load(&from_source, &whole, &width, &height, &channels, channels_wanted);
        const std::unique_ptr<void, decltype(&stbi_image_free)> freed(data, stbi_image_free);
        if (data == nullptr)
            throw std::runtime_error(stbi_failure_reason());
        if (whole.past_end)
            throw std::runtime_error("the file ends within the picture");
        add(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), data);
    }

    /// `value`: the number that a channel is.
    template <class Load, class Value>
    image read_image_by(const std::string& path, std::string_view bytes, Load load, Value value)
    {
        image picture;
        read(path, bytes, 3, load, [&](std::uint32_t width, std::uint32_t height, const auto* data) {
            picture.width = width;
            picture.height = height;
            const std::size_t pixels = std::size_t{width} * height;
            picture.pixels.reserve(pixels);
            for (std::size_t i = 0; i < pixels; ++i)
                picture.pixels.emplace_back(value(data[3 * i]), value(data[3 * i + 1]), value(data[3 * i + 2]));
        });
        return picture;
    }
} // namespace

image read_hdr(const std::string& path)
{
    return read_image_by(path, bytes_of(path), stbi_loadf_from_callbacks, [](float v) { return v; });
}

image jpeg_picture(const std::string& path, std::string_view bytes)
{
    return read_image_by(
        path, bytes, stbi_load_from_callbacks, [](stbi_uc v) { return static_cast<float>(v) / 255.0f; });
}

image read_jpeg(const std::string& path) { return jpeg_picture(path, bytes_of(path)); }

picture_channels read_tga_channels(const std::string& path)
{
    picture_channels picture{.width = 0, .height = 0, .pixels = {}, .is_srgb = true};
    read(path, bytes_of(path), 4, stbi_load_from_callbacks,
        [&](std::uint32_t width, std::uint32_t height, const stbi_uc* data) {
            picture.width = width;
            picture.height = height;
            const std::size_t pixels = std::size_t{width} * height;
            picture.pixels.reserve(pixels);
            for (std::size_t i = 0; i < 4 * pixels; i += 4)
                picture.pixels.push_back(glm::vec4(data[i], data[i + 1], data[i + 2], data[i + 3]) / 255.0f);
        });
    return picture;
}

} // namespace photongrid::image_formats
