// Picture files: PNG for display, EXR and PFM for measurements. docs/guide/scenes.md describes the tone map.
#pragma once

#include <photongrid/io/files.hpp>
#include <photongrid/render/image.hpp>

#include <glm/vec4.hpp>

#include <map>
#include <string>
#include <string_view>

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

/// Reads an EXR or PFM file. Of an EXR's channels it reads R, G and B.
/// \throws file_error.
image read_image(const std::string& path);

/// Reads a picture of a scene, such as an environment: EXR, PFM, Radiance HDR, PNG, JPEG or TGA. The pixels of the last
/// three are decoded to linear values from 0 to 1; transparency is ignored.
/// \throws file_error.
image read_linear_image(const std::string& path);

/// The channels of a picture, row by row from the top left.
struct picture_channels {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::vector<glm::vec4> pixels;       ///< red, green, blue, alpha
    bool is_srgb = false;                ///< red, green and blue are encoded, from 0 to 1: a PNG, JPEG or TGA file
};

/// The linear red, green and blue of one of its pixels.
glm::vec3 linear_pixel(const picture_channels& picture, std::size_t pixel);

/// Reads what read_linear_image() reads, as the file has it: PNG, JPEG and TGA are not decoded. Alpha is 1 but in PNG
/// and TGA files that have it.
/// \throws file_error.
picture_channels read_channels(const std::string& path);

/// The same of a PNG or JPEG file's bytes; `name` is that of the picture in messages.
/// \throws file_error, also for other formats.
picture_channels decode_channels(const std::string& name, std::string_view bytes);

} // namespace photongrid
