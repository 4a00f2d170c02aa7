// The formats of image_file.hpp, one source file per library.
#pragma once

#include <photongrid/io/image_file.hpp>

#include <string_view>

namespace photongrid::image_formats {

// Encoders throw std::exception if their library fails.
std::string png_bytes(const image& picture, double exposure);
/// `rgba`: 8 bits each, row by row from the top, as they are.
std::string png_bytes(std::uint32_t width, std::uint32_t height, const std::vector<unsigned char>& rgba);
std::string exr_bytes(const image& picture, const image_notes& notes);
std::string pfm_bytes(const image& picture);

inline constexpr std::uint32_t max_picture_edge = 65536; ///< pixels

// Decoders hand a file's bytes on row by row. They throw std::exception: what is wrong with the file.
void decode_png(std::string_view bytes, picture_sink& to);
void decode_jpeg(std::string_view bytes, picture_sink& to);
void decode_exr(std::string_view bytes, picture_sink& to);
void decode_pfm(std::string_view bytes, picture_sink& to);
void decode_hdr(std::string_view bytes, picture_sink& to);
void decode_tga(std::string_view bytes, picture_sink& to);

} // namespace photongrid::image_formats
