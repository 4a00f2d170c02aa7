// The picture in the window, what the mouse does there, and the renderer's report over it.
#pragma once

#include "document.hpp"
#include "render_thread.hpp"

#include <imgui.h>

#include <optional>
#include <vector>

namespace photongrid::viewer {

/// The picture. The mouse selects and moves parts of the scene on it, and the camera.
class picture_pane {
public:
    /// `d` must outlive it, and an OpenGL context must be current.
    explicit picture_pane(document& d);
    picture_pane(const picture_pane&) = delete;
    picture_pane& operator=(const picture_pane&) = delete;

    /// Takes another picture, or the same with another exposure, EV.
    void upload(const image& p, double exposure);
    /// Within an ImGui window, which it fills. Without a picture it only follows the mouse.
    void draw(bool has_picture);

private:
    void mouse(const ImVec2& corner, const ImVec2& size);
    void drag(const sight_line& line, bool level);

    document& document_;
    unsigned texture_ = 0;
    std::vector<unsigned char> bytes_;
    std::optional<grip> pressed_; ///< where a button went down
    bool moved_ = false, moves_part_ = false;
};

/// Draws what is wrong with a scene's file over the lower part of the picture.
void draw_scene_error(const std::string& what);

/// Draws what failed over the picture and, if `numbers` are wanted, what runs and for how long.
void draw_report(const render_report& r, const frame& shown, bool numbers);

} // namespace photongrid::viewer
