// The document of the window: a scene, its settings, the selected part, and undo. Independent of the window itself.
#pragma once

#include "scene_parts.hpp"

#include <string>
#include <vector>

namespace photongrid::viewer {

/// Everything that undo restores.
struct version {
    photongrid::scene scene; ///< its own settings are ignored
    render_settings settings;
    std::string backend; ///< as --backend takes it, not auto

    bool operator==(const version&) const = default;
};

/// A scene whose file has changed from `was` to `is` while the window shows `now`: the file's, but what was changed in
/// the window of the camera, the settings and the backend stays.
version read_again(const version& now, const version& was, const version& is);

/// Whether `now` has shapes or lights elsewhere than `was`.
bool moves_parts(const version& now, const version& was);

class document {
public:
    explicit document(version v) : now_(std::move(v)), parts_(parts_of(now_.scene)) {}

    const version& now() const { return now_; }
    const std::vector<scene_part>& parts() const { return parts_; }
    /// Index into parts(); empty if none is selected.
    std::optional<std::size_t> selected() const { return selected_; }
    void select(std::optional<std::size_t> part) { selected_ = part; }

    /// Changes until the next begin() are one step of undo, called `name`. Clears redo.
    void begin(const std::string& name);
    /// The version that is drawn. Call begin() before changing it.
    version& edit() { return now_; }
    /// Undoes or redoes one step; returns its name, or "" if there is none.
    std::string undo();
    std::string redo();

    // The camera. Angles in degrees.
    /// Turns around the camera's target; the up direction does not change.
    void orbit(double across, double upward);
    /// Moves camera and target by fractions of the picture's height.
    void pan(double right, double up);
    /// A factor above 1 moves nearer.
    void zoom(double factor);

private:
    struct step {
        version before;
        std::string name;
    };
    version now_;
    std::vector<scene_part> parts_;
    std::optional<std::size_t> selected_;
    std::vector<step> past_, future_;
};

} // namespace photongrid::viewer
