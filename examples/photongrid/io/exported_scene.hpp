// What a writer of scenes is told, and what it made.
#pragma once

#include <photongrid/io/imported_scene.hpp>

#include <string>
#include <vector>

namespace photongrid {

/// How to write a scene.
struct export_settings {
    bool strict = false; ///< what would be replaced or left out is an error
    /// The file that the scene was read from: pictures that the scene names are sought in its folder; empty: in the
    /// current one.
    std::string source{};
};

/// What was written, and how it differs from the scene.
struct exported_scene {
    std::vector<std::string> files; ///< paths, that of the scene last
    std::vector<import_note> notes; ///< what the format does not have
};

} // namespace photongrid
