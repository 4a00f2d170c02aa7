// The files that the window writes: pictures, and its scene with its changes. None replaces another file.
#pragma once

#include "document.hpp"
#include "scene_thread.hpp"
#include <photongrid/io/image_file.hpp>

#include <string>

namespace photongrid::viewer {

class saved_files {
public:
    explicit saved_files(const opened_scene& o)
        : stem_(o.stem), scene_path_(o.path), scene_text_(o.text),
          names_files_(o.files.size() > 1), last_{o.scene, o.settings, {}}
    {
    }

    /// Writes a picture as PNG, at `exposure`, EV, and as EXR. Returns what to tell the user.
    std::string save(const image& picture, double exposure) const;
    /// Writes the scene and its settings, unless they cannot be rendered; beside the scene's file if it names others.
    /// Returns what to tell the user.
    std::string save(const version& v);
    /// Whether `v` has changes that are neither in the scene's file nor in the last one saved.
    bool lacks(const version& v) const { return v.scene != last_.scene || v.settings != last_.settings; }

private:
    std::string stem_, scene_path_, scene_text_;
    bool names_files_; ///< which are sought in its folder
    version last_;
};

} // namespace photongrid::viewer
