// What two shared libraries and a program give each other. All of their files read photongrid's headers.
#pragma once

#include "../nearest.hpp"

#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/map/map_file.hpp>

namespace consumer {

using device = photongrid::serial_backend;
using map = photongrid::map_buffers<device>;

// Library `search`, a function in each of its two files.
[[gnu::visibility("default")]] map map_of_photons(device& d);
[[gnu::visibility("default")]] glm::vec4 estimate_at_point(device& d, const map& m);

// Library `files`.
[[gnu::visibility("default")]] void save(device& d, const map& m, const std::filesystem::path& file);
[[gnu::visibility("default")]] map load(device& d, const std::filesystem::path& file);

} // namespace consumer
