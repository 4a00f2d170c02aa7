#include <photongrid/io/image_file.hpp>
#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/tone_map.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string_view>

namespace photongrid {

namespace fs = std::filesystem;

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

void pixel_budget::take(const picture_header& header, std::size_t bytes)
{
    constexpr std::uint64_t edge = image_formats::max_picture_edge;
    const auto size = std::to_string(header.width) + " x " + std::to_string(header.height) + " pixels";
    if (header.width < 1 || header.height < 1 || header.width > edge || header.height > edge)
        throw std::runtime_error("it is " + size + "; expected at most 65,536 along each side");
    bytes_ += bytes;
    used_ += std::uint64_t{header.width} * header.height * std::max((header.channels + 3) / 4, 1u);
    if (used_ > most_ + 32 * bytes_)
        throw std::runtime_error("it claims " + size + " in " + std::to_string(bytes)
            + " bytes: with those before more than " + std::to_string(most_)
            + ", and 32 a byte; --max-pixels lets pictures have more");
}

namespace {
    /// Passes a picture on if it may have so many pixels.
    class limited_sink : public picture_sink {
    public:
        limited_sink(picture_sink& to, pixel_budget& budget, std::size_t bytes)
            : to_(to), budget_(budget), bytes_(bytes)
        {
        }
        void begin(const picture_header& header) override
        {
            budget_.take(header, bytes_);
            to_.begin(header);
        }
        void row(std::uint32_t y, std::span<const glm::vec4> pixels) override { to_.row(y, pixels); }

    private:
        picture_sink& to_;
        pixel_budget& budget_;
        std::size_t bytes_;
    };
    /// Keeps what `Pixel` makes of a picture's pixels.
    template <class Pixels, class Pixel>
    class keeping_sink : public picture_sink {
    public:
        keeping_sink(Pixels& pixels, Pixel pixel) : pixels_(pixels), pixel_(pixel) {}
        void begin(const picture_header& header) override
        {
            this->header = header;
            pixels_.resize(std::size_t{header.width} * header.height);
        }
        void row(std::uint32_t y, std::span<const glm::vec4> pixels) override
        {
            auto* to = pixels_.data() + std::size_t{y} * header.width;
            for (const auto& p : pixels)
                *to++ = pixel_(p, header.is_srgb);
        }
        picture_header header;

    private:
        Pixels& pixels_;
        Pixel pixel_;
    };

    using decoder = void (*)(std::string_view bytes, picture_sink& to);
    /// The decoder of a file, by its content; a TGA alone has no mark, so that its name decides.
    decoder decoder_of(const std::string& name, std::string_view bytes)
    {
        using namespace image_formats;
        if (bytes.starts_with("\x89PNG"))
            return decode_png;
        if (bytes.starts_with("\xFF\xD8\xFF"))
            return decode_jpeg;
        if (bytes.starts_with("\x76\x2F\x31\x01"))
            return decode_exr;
        if (bytes.starts_with("#?"))
            return decode_hdr;
        if (bytes.starts_with("PF") || bytes.starts_with("Pf"))
            return decode_pfm;
        if (ending(name) == ".tga")
            return decode_tga;
        fail_file(name, "is no picture that can be read; expected EXR, Radiance HDR, PFM, PNG, JPEG or TGA");
    }
    void decode_by(
        decoder decode, const std::string& name, std::string_view bytes, picture_sink& to, pixel_budget& budget)
    {
        limited_sink limited(to, budget, bytes.size());
        try {
            decode(bytes, limited);
        } catch (const file_error&) {
            throw;
        } catch (const std::bad_alloc&) {
            fail_file(name, "cannot be read: there is not enough memory for it");
        } catch (const std::exception& what) {
            fail_file(name, std::string("cannot be read: ") + what.what());
        }
    }

    std::string bytes_of(const std::string& path)
    {
        std::error_code wrong;
        if (fs::is_directory(path, wrong))
            fail_file(path, "is a folder");
        try {
            return whole_file(path);
        } catch (const std::runtime_error&) {
            fail_file(path, std::string("cannot be read: ") + std::strerror(errno));
        }
    }
} // namespace

void decode_picture(const std::string& name, std::string_view bytes, picture_sink& to, pixel_budget& budget)
{
    decode_by(decoder_of(name, bytes), name, bytes, to, budget);
}

namespace {
    image decoded_image(decoder decode, const std::string& name, std::string_view bytes, pixel_budget& budget)
    {
        image made;
        keeping_sink keep(made.pixels, linear_pixel);
        decode_by(decode, name, bytes, keep, budget);
        made.width = keep.header.width;
        made.height = keep.header.height;
        return made;
    }
} // namespace

image read_image(const std::string& path)
{
    const auto bytes = bytes_of(path);
    const auto decode = decoder_of(path, bytes);
    if (decode != image_formats::decode_exr && decode != image_formats::decode_pfm)
        fail_file(path, "is neither EXR nor PFM (a PNG is tone-mapped and clamped, so it cannot be measured)");
    pixel_budget measured(std::uint64_t{1} << 28);
    return decoded_image(decode, path, bytes, measured);
}

picture_channels read_channels(const std::string& path)
{
    picture_channels made;
    keeping_sink keep(made.pixels, [](const glm::vec4& p, bool) { return p; });
    const auto bytes = bytes_of(path);
    pixel_budget budget;
    decode_picture(path, bytes, keep, budget);
    made.header = keep.header;
    return made;
}

image decode_linear_image(const std::string& name, std::string_view bytes, pixel_budget& budget)
{
    return decoded_image(decoder_of(name, bytes), name, bytes, budget);
}

image read_linear_image(const std::string& path)
{
    pixel_budget budget;
    return decode_linear_image(path, bytes_of(path), budget);
}

glm::vec3 linear_pixel(const glm::vec4& pixel, bool is_srgb)
{
    if (!is_srgb)
        return glm::vec3(pixel);
    return {linear_of(pixel.x), linear_of(pixel.y), linear_of(pixel.z)};
}

} // namespace photongrid
