// The files that the window writes: pictures, and its scene with its changes. None replaces another file.
#pragma once

#include "window.hpp"

#include <string>

namespace photongrid::viewer {

class saved_files {
public:
    explicit saved_files(const window_options& o)
        : stem_(o.stem), scene_path_(o.scene_path), scene_text_(o.scene_text), last_(o.begin)
    {
    }

    /// Writes a picture as PNG, at `exposure`, EV, and as EXR. Returns what to tell the user.
    std::string save(const image& picture, double exposure) const;
    /// Writes the scene and its settings, unless they cannot be rendered. Returns what to tell the user.
    std::string save(const version& v);
    /// Whether `v` has changes that are neither in the scene's file nor in the last one saved.
    bool lacks(const version& v) const { return v.scene != last_.scene || v.settings != last_.settings; }

private:
    std::string stem_, scene_path_, scene_text_;
    version last_;
};

} // namespace photongrid::viewer
