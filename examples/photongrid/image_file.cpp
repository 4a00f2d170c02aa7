#include "image_file.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace photongrid {

namespace fs = std::filesystem;

namespace {
    constexpr std::uint32_t max_edge = 65536;
    constexpr std::uint64_t max_pixels = std::uint64_t{1} << 28;

    std::string ending(const std::string& path)
    {
        auto e = fs::path(path).extension().string();
        std::transform(e.begin(), e.end(), e.begin(),
            [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
        return e;
    }

    [[noreturn]] void fail(const std::string& path, const std::string& reason)
    {
        throw file_error(path + ": " + reason);
    }

    /// The file behind a link, so that the link survives.
    fs::path target(const std::string& path)
    {
        std::error_code none;
        const auto real = fs::canonical(path, none);
        return none ? fs::path(path) : real;
    }

    // --- PNG ---
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

    // --- EXR ---
    class memory_stream : public Imf::OStream {
    public:
        memory_stream() : Imf::OStream("memory") {}
        void write(const char c[], int n) override
        {
            const auto size = static_cast<std::size_t>(n);
            if (at_ + size > bytes.size())
                bytes.resize(at_ + size);
            std::memcpy(bytes.data() + at_, c, size);
            at_ += size;
        }
        std::uint64_t tellp() override { return at_; }
        void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }
        std::string bytes;

    private:
        std::size_t at_ = 0;
    };

    /// Where the channels of an RGB float picture lie, for a picture whose first pixel has the box's least coordinates.
    Imf::FrameBuffer rgb_frame(glm::vec3* pixels, const Imath::Box2i& box)
    {
        const auto width = static_cast<std::size_t>(box.max.x - box.min.x + 1);
        Imf::FrameBuffer frame;
        for (int c = 0; c < 3; ++c)
            frame.insert(std::string(1, "RGB"[c]),
                Imf::Slice::Make(Imf::FLOAT, &(*pixels)[c], box, sizeof(glm::vec3), sizeof(glm::vec3) * width));
        return frame;
    }

    /// A layer and the channel that it is in an EXR.
    struct layer_channel {
        const char* name;
        const std::vector<float>& values;
    };

    /// The layers that are there.
    std::vector<layer_channel> layers_of(const image& picture)
    {
        const auto& l = picture.layers;
        std::vector<layer_channel> all;
        for (const auto& c : {layer_channel{"estimate.radius", l.radius}, layer_channel{"estimate.count", l.count},
                 layer_channel{"estimate.relative_error", l.relative_error}, layer_channel{"noise", l.noise}})
            if (!c.values.empty())
                all.push_back(c);
        return all;
    }

    std::string exr_bytes(const image& picture, const image_notes& notes)
    {
        Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
        for (const auto* c : {"R", "G", "B"})
            header.channels().insert(c, Imf::Channel(Imf::FLOAT));
        const auto layers = layers_of(picture);
        for (const auto& l : layers) {
            if (l.values.size() != picture.pixels.size())
                throw std::runtime_error(std::string("the layer ") + l.name + " has " + std::to_string(l.values.size())
                    + " values for " + std::to_string(picture.pixels.size()) + " pixels");
            header.channels().insert(l.name, Imf::Channel(Imf::FLOAT));
        }
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [name, text] : notes)
            header.insert(name, Imf::StringAttribute(text));
        memory_stream stream;
        {
            Imf::OutputFile file(stream, header);
            // OpenEXR reads through pointers that are not const.
            auto frame = rgb_frame(const_cast<glm::vec3*>(picture.pixels.data()), header.dataWindow());
            for (const auto& l : layers)
                frame.insert(
                    l.name, Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(l.values.data()), header.dataWindow()));
            file.setFrameBuffer(frame);
            file.writePixels(static_cast<int>(picture.height));
        }
        return std::move(stream.bytes);
    }

    image read_exr(const std::string& path)
    {
        Imf::InputFile file(path.c_str());
        const auto box = file.header().dataWindow();
        const auto width = std::int64_t{box.max.x} - box.min.x + 1, height = std::int64_t{box.max.y} - box.min.y + 1;
        if (width < 1 || height < 1 || width > max_edge || height > max_edge
            || static_cast<std::uint64_t>(width * height) > max_pixels)
            fail(path,
                "is " + std::to_string(width) + " x " + std::to_string(height)
                    + " pixels; expected 1 to 65536 a side and at most 2^28");
        for (const auto* c : {"R", "G", "B"})
            if (!file.header().channels().findChannel(c))
                fail(path, std::string("has no channel ") + c + "; expected R, G and B");
        image picture{.width = static_cast<std::uint32_t>(width),
            .height = static_cast<std::uint32_t>(height),
            .pixels = std::vector<glm::vec3>(static_cast<std::size_t>(width * height))};
        file.setFrameBuffer(rgb_frame(picture.pixels.data(), box));
        file.readPixels(box.min.y, box.max.y);
        return picture;
    }

    // --- PFM: "PF", width height, -1 (little-endian), rows from the bottom ---
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
            fail(path, errno != 0 ? std::strerror(errno) : "is empty");
        if ((magic != "PF" && magic != "Pf") || !(in >> width >> height >> scale) || in.get() == EOF || scale == 0
            || !std::isfinite(scale))
            fail(path, "is not a PFM file: expected \"PF\" or \"Pf\", width, height, scale");
        if (width < 1 || height < 1 || width > max_edge || height > max_edge
            || std::uint64_t{width} * height > max_pixels)
            fail(path,
                "is " + std::to_string(width) + " x " + std::to_string(height)
                    + " pixels; expected 1 to 65536 a side and at most 2^28");
        const std::size_t channels = magic == "PF" ? 3 : 1;
        image picture{.width = width, .height = height, .pixels = {}};
        std::error_code none;
        if (fs::file_size(path, none) < std::uint64_t{width} * height * channels * sizeof(float))
            fail(path, "ends too early for its " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
        picture.pixels.resize(std::size_t{width} * height);
        std::vector<float> row(width * channels);
        for (std::uint32_t y = height; y-- > 0;) {
            if (!in.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(float))))
                fail(path,
                    "ends too early for its " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
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
} // namespace

void check_file_path(const std::string& path)
{
    std::error_code none;
    const auto status = fs::status(path, none);
    // Renaming a file onto /dev/null would replace the device.
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail(path, fs::is_directory(status) ? "is a folder; expected a file's name" : "is not a regular file");
    const auto folder = target(path).parent_path();
    const auto shown = folder.empty() ? fs::path(".") : folder;
    if (!fs::is_directory(shown, none))
        fail(path, "there is no folder " + shown.string());
    if (::access(shown.c_str(), W_OK | X_OK) != 0)
        fail(path, "the folder " + shown.string() + " cannot be written to: " + std::strerror(errno));
}

bool holds_layers(const std::string& path) { return ending(path) == ".exr"; }

unsigned char tone_mapped(float linear, double exposure)
{
    const double v = static_cast<double>(linear) * std::exp2(exposure);
    if (!(v > 0)) // NaN too
        return 0;
    const double c = std::min(v, 1.0);
    const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * encoded));
}

tone_map::tone_map(double exposure)
{
    // Positive floats are in the order of their bits.
    for (unsigned step = 0; step < steps_.size(); ++step) {
        std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
        while (low < high) {
            const auto middle = low + (high - low) / 2;
            if (tone_mapped(std::bit_cast<float>(middle), exposure) > step)
                high = middle;
            else
                low = middle + 1;
        }
        steps_[step] = std::bit_cast<float>(high);
    }
}

void write_file(const std::string& path, const std::string& bytes)
{
    check_file_path(path);
    const auto real = target(path);
    const auto temporary = real.string() + "." + std::to_string(::getpid()) + ".tmp";
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0)
        fail(path, "cannot write " + temporary + ": " + std::strerror(errno));
    int error = 0;
    for (std::size_t at = 0; at < bytes.size() && error == 0;) {
        const auto n = ::write(file, bytes.data() + at, std::min<std::size_t>(bytes.size() - at, std::size_t{1} << 30));
        if (n >= 0)
            at += static_cast<std::size_t>(n);
        else if (errno != EINTR)
            error = errno;
    }
    if (::close(file) != 0 && error == 0)
        error = errno;
    if (error == 0 && ::rename(temporary.c_str(), real.c_str()) != 0)
        error = errno;
    if (error != 0) {
        ::unlink(temporary.c_str());
        fail(path, std::string("cannot be written: ") + std::strerror(error));
    }
}

void check_image_path(const std::string& path)
{
    const auto e = ending(path);
    if (e != ".png" && e != ".exr" && e != ".pfm")
        fail(path, "has no known ending; expected .png, .exr or .pfm");
    check_file_path(path);
}

void write_image(const std::string& path, const image& picture, double exposure, const image_notes& notes)
{
    check_image_path(path);
    if (picture.width == 0 || picture.height == 0
        || picture.pixels.size() != std::size_t{picture.width} * picture.height)
        fail(path,
            "the picture has " + std::to_string(picture.pixels.size()) + " pixels for " + std::to_string(picture.width)
                + " x " + std::to_string(picture.height));
    const auto e = ending(path);
    std::string bytes;
    try {
        bytes = e == ".png" ? png_bytes(picture, exposure)
            : e == ".exr"   ? exr_bytes(picture, notes)
                            : pfm_bytes(picture);
    } catch (const std::exception& what) {
        fail(path, std::string("cannot be encoded: ") + what.what());
    }
    write_file(path, bytes);
}

image read_image(const std::string& path)
{
    const auto e = ending(path);
    if (e != ".exr" && e != ".pfm")
        fail(path, "has no known ending; expected .exr or .pfm (a PNG is tone-mapped and clamped, hence no measure)");
    if (std::error_code none; fs::is_directory(path, none))
        fail(path, "is a folder");
    try {
        return e == ".exr" ? read_exr(path) : read_pfm(path);
    } catch (const file_error&) {
        throw;
    } catch (const std::exception& what) {
        fail(path, std::string("cannot be read: ") + what.what());
    }
}

image_difference compare_images(const image& a, const image& b)
{
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("the sizes differ: " + std::to_string(a.width) + " x " + std::to_string(a.height)
            + " and " + std::to_string(b.width) + " x " + std::to_string(b.height));
    image_difference d;
    d.largest = -1;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 p(a.pixels[i]), q(b.pixels[i]);
        if (!detail::finite(p) || !detail::finite(q)) {
            ++d.not_finite;
            continue;
        }
        ++d.compared;
        for (int c = 0; c < 3; ++c) {
            const double error = p[c] - q[c];
            d.mse += error * error;
            d.relmse += error * error / ((q[c] + 0.01) * (q[c] + 0.01));
            if (std::abs(error) > d.largest) {
                d.largest = std::abs(error);
                d.x = static_cast<std::uint32_t>(i % a.width);
                d.y = static_cast<std::uint32_t>(i / a.width);
            }
        }
    }
    const double values = 3.0 * static_cast<double>(d.compared);
    d.mse /= values; // NaN where nothing could be compared
    d.relmse /= values;
    return d;
}

} // namespace photongrid
