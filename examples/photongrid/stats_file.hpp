// --stats: statistics of a render as JSON, and as attributes of an EXR.
#pragma once

#include <photongrid/backends/any/any.hpp>
#include <photongrid/io/image_file.hpp>
#include <photongrid/io/imported_scene.hpp>

namespace photongrid {

/// The JSON of --stats. docs/reference/statistics.md lists its fields.
std::string stats_json(
    const imported_scene& s, const render_settings& settings, const renderer& result, double total_ms);

/// Attributes for an EXR: seed, backend, device, settings, version.
image_notes picture_notes(const scene& s, const render_settings& settings, const renderer& result);

/// The largest amount of memory that this process has held, bytes.
std::uint64_t peak_memory_bytes();

} // namespace photongrid
