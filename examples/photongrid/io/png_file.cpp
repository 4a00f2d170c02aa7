#include <photongrid/io/image_formats.hpp>
#include <photongrid/io/tone_map.hpp>

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <new>
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
    /// A PNG that is decoded. libpng leaves its functions by a long jump, which no destructor may lie behind: what
    /// needs one is kept here.
    class png_decoder {
    public:
        explicit png_decoder(std::string_view bytes) : left_(bytes)
        {
            png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_error, [](png_structp, png_const_charp) {});
            info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
            if (info_ == nullptr) {
                png_destroy_read_struct(&png_, nullptr, nullptr);
                throw std::bad_alloc();
            }
            png_set_read_fn(png_, this, give_bytes);
            png_set_user_limits(png_, max_picture_edge, max_picture_edge);
            png_set_chunk_malloc_max(png_, 1 << 23);
        }
        png_decoder(const png_decoder&) = delete;
        png_decoder& operator=(const png_decoder&) = delete;
        ~png_decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

        /// Reads the header, and has rows made of four channels of 8 or 16 bits, as they are.
        picture_header begin()
        {
            if (setjmp(png_jmpbuf(png_)) != 0)
                throw std::runtime_error(error_);
            png_read_info(png_, info_);
            const auto type = png_get_color_type(png_, info_);
            png_set_expand(png_);
            if ((type & PNG_COLOR_MASK_COLOR) == 0)
                png_set_gray_to_rgb(png_);
            if ((type & PNG_COLOR_MASK_ALPHA) == 0 && png_get_valid(png_, info_, PNG_INFO_tRNS) == 0)
                png_set_filler(png_, 0xFFFF, PNG_FILLER_AFTER);
            passes_ = png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
            return {.width = png_get_image_width(png_, info_),
                .height = png_get_image_height(png_, info_),
                .is_srgb = true};
        }
        /// Makes room for a row, or for all of an interlaced picture, which come in parts.
        void hold()
        {
            row_bytes_ = png_get_rowbytes(png_, info_);
            held_.resize(row_bytes_ * (passes_ > 1 ? png_get_image_height(png_, info_) : 1));
        }
        bool is_interlaced() const { return passes_ > 1; }
        void read_interlaced()
        {
            if (setjmp(png_jmpbuf(png_)) != 0)
                throw std::runtime_error(error_);
            for (int pass = 0; pass < passes_; ++pass)
                for (png_uint_32 y = 0; y < png_get_image_height(png_, info_); ++y)
                    png_read_row(png_, held_.data() + y * row_bytes_, nullptr);
        }
        void read_row()
        {
            if (setjmp(png_jmpbuf(png_)) != 0)
                throw std::runtime_error(error_);
            png_read_row(png_, held_.data(), nullptr);
        }
        /// A channel of a row that is held.
        float value(std::size_t row, std::size_t channel) const
        {
            const auto* at = held_.data() + row * row_bytes_;
            if (png_get_bit_depth(png_, info_) == 16)
                return static_cast<float>(at[2 * channel] << 8 | at[2 * channel + 1]) / 65535.0f;
            return static_cast<float>(at[channel]) / 255.0f;
        }

    private:
        [[noreturn]] static void keep_error(png_structp png, png_const_charp what)
        {
            auto& d = *static_cast<png_decoder*>(png_get_error_ptr(png));
            std::snprintf(d.error_, sizeof d.error_, "%s", what);
            png_longjmp(png, 1);
        }
        static void give_bytes(png_structp png, png_bytep to, png_size_t n)
        {
            auto& left = static_cast<png_decoder*>(png_get_io_ptr(png))->left_;
            if (n > left.size())
                png_error(png, "the file ends within the picture");
            std::copy_n(left.begin(), n, to);
            left.remove_prefix(n);
        }

        std::string_view left_;
        char error_[128] = "";
        png_structp png_ = nullptr;
        png_infop info_ = nullptr;
        int passes_ = 1;
        std::size_t row_bytes_ = 0;
        std::vector<png_byte> held_;
    };
} // namespace

void decode_png(std::string_view bytes, picture_sink& to)
{
    png_decoder png(bytes);
    const auto header = png.begin();
    to.begin(header);
    png.hold();
    if (png.is_interlaced())
        png.read_interlaced();
    std::vector<glm::vec4> row(header.width);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        if (!png.is_interlaced())
            png.read_row();
        for (std::size_t x = 0; x < row.size(); ++x)
            for (int c = 0; c < 4; ++c)
                row[x][c] = png.value(png.is_interlaced() ? y : 0, 4 * x + static_cast<std::size_t>(c));
        to.row(y, row);
    }
}

} // namespace photongrid::image_formats
