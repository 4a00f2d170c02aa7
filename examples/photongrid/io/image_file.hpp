// Picture files: PNG for display, EXR and PFM for measurements. docs/guide/scenes.md describes the tone map.
#pragma once

#include <photongrid/io/files.hpp>
#include <photongrid/render/image.hpp>

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace photongrid {

/// Text attributes of an EXR file, by name.
using image_notes = std::map<std::string, std::string>;

/// Checks whether a picture can be written to `path`, so that a program can report that before it renders.
/// \throws file_error if `path` does not end in .png, .exr or .pfm, or cannot be written.
void check_image_path(const std::string& path);

/// Whether the format of `path` can hold image::layers. EXR can.
bool holds_layers(const std::string& path);

/// Whether the format of `path` holds what a screen shows, not linear numbers: PNG.
bool is_for_display(const std::string& path);

/// Writes a picture in the format given by the extension of `path`. On an error, or if the program dies, the old file
/// remains. `exposure` (EV) applies to PNG only. EXR also has the picture's layers, as single precision channels
/// estimate.radius (m), estimate.count, estimate.relative_error and, for several passes, noise; PNG and PFM do not.
/// \throws file_error.
void write_image(const std::string& path, const image& picture, double exposure = 0, const image_notes& notes = {});

/// What the header of a picture file says.
struct picture_header {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::uint32_t channels = 4;          ///< that the file holds
    bool is_srgb = false;                ///< red, green and blue are encoded, from 0 to 1: a PNG, JPEG or TGA file
};

/// Takes a picture while it is decoded, so that none is held twice.
class picture_sink {
public:
    virtual ~picture_sink() = default;
    /// Before the first row. It may throw: nothing of the picture has been held yet.
    virtual void begin(const picture_header& header) = 0;
    /// A row of red, green, blue and alpha, 1 where the file has none. Rows come once each, in any order; 0 is the top.
    virtual void row(std::uint32_t y, std::span<const glm::vec4> pixels) = 0;
};

/// How many pixels the pictures of a scene may have, so that a small file cannot claim all memory.
class pixel_budget {
public:
    /// Beside `most` pixels, 32 for each byte of the files.
    explicit pixel_budget(std::uint64_t most = file_reading{}.max_pixels) : most_(most) {}
    /// Takes those of a picture in a file of so many bytes. Four channels are one pixel, fewer count as four.
    /// \throws std::runtime_error if there are not so many.
    void take(const picture_header& header, std::size_t bytes);

private:
    std::uint64_t most_, used_ = 0, bytes_ = 0;
};

/// Decodes the bytes of an EXR, PFM, Radiance HDR, PNG, JPEG or TGA file; which one, its content says. `name`: that of
/// the picture in messages. A PNG, JPEG or TGA is handed on as it is encoded, whatever it says of a gamma or a profile.
/// \throws file_error.
void decode_picture(const std::string& name, std::string_view bytes, picture_sink& to, pixel_budget& budget);

/// Reads an EXR or PFM file. Of an EXR's channels it reads R, G and B, those of a layer where it has no others, or Y.
/// \throws file_error.
image read_image(const std::string& path);

/// Reads a picture of a scene, such as an environment: EXR, PFM, Radiance HDR, PNG, JPEG or TGA. The pixels of the last
/// three are decoded to linear values from 0 to 1; transparency is ignored.
/// \throws file_error.
image read_linear_image(const std::string& path);

/// The same of a file's bytes.
/// \throws file_error.
image decode_linear_image(const std::string& name, std::string_view bytes, pixel_budget& budget);

/// The linear red, green and blue of one of a picture's pixels.
glm::vec3 linear_pixel(const glm::vec4& pixel, bool is_srgb);

/// The channels of a picture, row by row from the top left.
struct picture_channels {
    picture_header header;
    std::vector<glm::vec4> pixels; ///< red, green, blue, alpha
};

/// Reads what read_linear_image() reads, as decode_picture() hands it on.
/// \throws file_error.
picture_channels read_channels(const std::string& path);

} // namespace photongrid
