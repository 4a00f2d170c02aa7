// What is edited in the window: a scene, its settings, the part that is selected, and the way back. Knows no window.
#pragma once

#include "scene_parts.hpp"

#include <string>
#include <vector>

namespace photongrid::viewer {

/// Everything that undo brings back.
struct version {
    photongrid::scene scene; ///< its own settings are not looked at
    render_settings settings;
    std::string backend; ///< as --backend takes it, not auto

    bool operator==(const version&) const = default; ///< of every member
};

class document {
public:
    explicit document(version v) : now_(std::move(v)), parts_(parts_of(now_.scene)) {}

    const version& now() const { return now_; }
    const std::vector<scene_part>& parts() const { return parts_; }
    /// Index into parts(); nothing where none is selected.
    std::optional<std::size_t> selected() const { return selected_; }
    void select(std::optional<std::size_t> part) { selected_ = part; }

    /// Changes until the next begin() are one step of undo, which `name` says. Redo is forgotten.
    void begin(const std::string& name);
    /// The version that is drawn, to be changed; after begin().
    version& edit() { return now_; }
    /// Takes back, or does again, one step; says which, or "" where there is none.
    std::string undo();
    std::string redo();

    // The camera. Angles in degrees.
    /// Turns about the point that is looked at; up stays up.
    void orbit(double across, double upward);
    /// Moves camera and point by parts of the picture's height.
    void pan(double right, double up);
    /// Nearer by a factor above 1.
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
