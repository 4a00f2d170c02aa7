// The formats of image_file.hpp, one source file per library.
#pragma once

#include <photongrid/io/image_file.hpp>

#include <string_view>

namespace photongrid::image_formats {

// Encoders throw std::exception if their library fails; readers throw std::exception or file_error. Those that are
// given bytes use the path in messages alone.
std::string png_bytes(const image& picture, double exposure);
/// `rgba`: 8 bits each, row by row from the top, as they are.
std::string png_bytes(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& rgba);
std::string exr_bytes(const image& picture, const image_notes& notes);
std::string pfm_bytes(const image& picture);
image read_exr(const std::string& path);
image read_pfm(const std::string& path);
picture_channels read_png_channels(const std::string& path);
picture_channels png_channels(const std::string& path, std::string_view bytes);
picture_channels read_tga_channels(const std::string& path);
image read_hdr(const std::string& path);
image read_jpeg(const std::string& path); // as it is encoded, from 0 to 1
image jpeg_picture(const std::string& path, std::string_view bytes);

/// Throws file_error for a picture that is empty or too large to hold.
void check_read_size(const std::string& path, std::int64_t width, std::int64_t height);

} // namespace photongrid::image_formats
