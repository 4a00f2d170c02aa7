// --resume: an unfinished picture in a file, to be continued later.
#pragma once

#include <photongrid/io/image_file.hpp>

#include <photongrid/core/backend.hpp>
#include <photongrid/render/render_state.hpp>

#include <optional>
#include <string>

namespace photongrid {

/// Everything that a picture's bytes depend on: program, backend, device, scene and settings. One line of JSON.
std::string picture_identity(const scene& s, const render_settings& settings, const capabilities& caps);

/// Writes a state; on failure no partial file is left. Throws file_error.
void write_resume_file(const std::string& path, const std::string& identity, const render_state& state);

/// Reads the state of the picture with this identity; empty if there is no such file. Throws file_error for a file
/// that is damaged or belongs to another picture.
std::optional<render_state> read_resume_file(const std::string& path, const std::string& identity);

} // namespace photongrid
