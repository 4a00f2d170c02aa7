// Pictures on disk: PNG for looking at, EXR and PFM for measuring. docs/guide/scenes.md describes the tone map.
#pragma once

#include <photongrid/io/files.hpp>
#include <photongrid/render/image.hpp>

#include <map>
#include <string>

namespace photongrid {

/// What an EXR says about its making, by attribute name.
using image_notes = std::map<std::string, std::string>;

/// \throws file_error when `path` does not end in .png, .exr or .pfm, or its folder does not take files: said before
/// hours of rendering, not after.
void check_image_path(const std::string& path);

/// Whether the format of `path`'s ending holds image::layers: EXR does.
bool holds_layers(const std::string& path);

/// Writes a picture in the format of its ending. All or nothing: on an error, or when the program dies, `path` is
/// what it was before. `exposure` (EV) is used by PNG only. EXR holds the picture's layers too, as single precision
/// channels estimate.radius (m), estimate.count, estimate.relative_error and, of several passes, noise; PNG and PFM
/// leave them out.
/// \throws file_error.
void write_image(const std::string& path, const image& picture, double exposure = 0, const image_notes& notes = {});

/// Reads an EXR or PFM file; of an EXR's channels R, G and B alone.
/// \throws file_error.
image read_image(const std::string& path);

} // namespace photongrid
