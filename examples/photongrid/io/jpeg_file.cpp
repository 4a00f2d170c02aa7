#include <photongrid/io/image_formats.hpp>

#include <algorithm>
#include <csetjmp>
#include <cstdio> // which jpeglib.h needs
#include <stdexcept>
#include <vector>

#include <jpeglib.h>

#include <jerror.h>

namespace photongrid::image_formats {

namespace {
    /// A JPEG that is decoded. libjpeg leaves its functions by a long jump, which no destructor may lie behind: what
    /// needs one is kept here.
    class jpeg_decoder {
    public:
        explicit jpeg_decoder(std::string_view bytes)
        {
            jpeg_.err = jpeg_std_error(&errors_);
            errors_.error_exit = keep_error;
            errors_.emit_message = warn;
            jpeg_.client_data = this;
            run([&] {
                jpeg_create_decompress(&jpeg_);
                jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
            });
        }
        jpeg_decoder(const jpeg_decoder&) = delete;
        jpeg_decoder& operator=(const jpeg_decoder&) = delete;
        ~jpeg_decoder() { jpeg_destroy_decompress(&jpeg_); }

        picture_header begin()
        {
            run([&] {
                jpeg_read_header(&jpeg_, TRUE);
                const bool has_black = jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
                jpeg_.out_color_space = has_black ? JCS_CMYK : JCS_RGB;
            });
            return {.width = jpeg_.image_width, .height = jpeg_.image_height, .is_srgb = true};
        }
        void start()
        {
            progress_.progress_monitor = limit_scans;
            jpeg_.progress = &progress_;
            run([&] { jpeg_start_decompress(&jpeg_); });
            row_.resize(std::size_t{jpeg_.output_width} * static_cast<unsigned>(jpeg_.output_components));
        }
        void read_row(std::vector<glm::vec4>& to)
        {
            auto* row = row_.data();
            run([&] { jpeg_read_scanlines(&jpeg_, &row, 1); });
            const auto channels = static_cast<std::size_t>(jpeg_.output_components);
            for (std::size_t x = 0; x < to.size(); ++x)
                to[x] = glm::vec4(colour(row + x * channels), 1.0f);
        }

    private:
        /// Red, green and blue. Adobe's programs write how much of an ink is missing.
        glm::vec3 colour(const unsigned char* at) const
        {
            glm::vec3 c(at[0], at[1], at[2]);
            c /= 255.0f;
            if (jpeg_.out_color_space != JCS_CMYK)
                return c;
            const float black = static_cast<float>(at[3]) / 255.0f;
            return jpeg_.saw_Adobe_marker ? c * black : (1.0f - c) * (1.0f - black);
        }
        template <class Work>
        void run(const Work& work)
        {
            if (setjmp(leave_) != 0)
                throw std::runtime_error(error_);
            work();
        }
        static jpeg_decoder& of(j_common_ptr jpeg) { return *static_cast<jpeg_decoder*>(jpeg->client_data); }
        [[noreturn]] static void keep_error(j_common_ptr jpeg)
        {
            jpeg->err->format_message(jpeg, of(jpeg).error_);
            std::longjmp(of(jpeg).leave_, 1);
        }
        /// What is missing would be grey.
        static void warn(j_common_ptr jpeg, int level)
        {
            if (level < 0 && (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER))
                keep_error(jpeg);
        }
        /// Each scan of a progressive picture goes over all pixels.
        static void limit_scans(j_common_ptr jpeg)
        {
            constexpr std::uint64_t most = std::uint64_t{1} << 31; // pixels of all scans
            auto& d = of(jpeg);
            const auto pixels = std::uint64_t{d.jpeg_.image_width} * d.jpeg_.image_height;
            if (d.jpeg_.input_scan_number > 64
                || static_cast<std::uint64_t>(d.jpeg_.input_scan_number) * pixels > most) {
                std::snprintf(d.error_, sizeof d.error_, "it has too many scans");
                std::longjmp(d.leave_, 1);
            }
        }

        jpeg_decompress_struct jpeg_{};
        jpeg_error_mgr errors_{};
        jpeg_progress_mgr progress_{};
        std::jmp_buf leave_{};
        char error_[JMSG_LENGTH_MAX] = "";
        std::vector<unsigned char> row_;
    };
} // namespace

void decode_jpeg(std::string_view bytes, picture_sink& to)
{
    jpeg_decoder jpeg(bytes);
    const auto header = jpeg.begin();
    to.begin(header);
    jpeg.start();
    std::vector<glm::vec4> row(header.width);
    for (std::uint32_t y = 0; y < header.height; ++y) {
        jpeg.read_row(row);
        to.row(y, row);
    }
}

} // namespace photongrid::image_formats
