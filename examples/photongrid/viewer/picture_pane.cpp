#include "picture_pane.hpp"

#include "../progress_bar.hpp"
#include "display.hpp"

#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

namespace photongrid::viewer {

picture_pane::picture_pane(document& d) : document_(d)
{
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const auto& [name, value] : {std::pair{GL_TEXTURE_MIN_FILTER, GL_LINEAR}, {GL_TEXTURE_MAG_FILTER, GL_LINEAR},
             {GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE}, {GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE}})
        glTexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(name), value);
}

void picture_pane::upload(const image& p, double exposure)
{
    if (p.pixels.empty())
        return;
    const tone_map to_screen(exposure);
    bytes_.clear();
    for (const auto& pixel : p.pixels)
        for (int c = 0; c < 3; ++c)
            bytes_.push_back(to_screen(pixel[c]));
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, static_cast<GLsizei>(p.width), static_cast<GLsizei>(p.height), 0, GL_RGB,
        GL_UNSIGNED_BYTE, bytes_.data());
}

void picture_pane::draw(bool has_picture)
{
    const auto& s = document_.now().settings;
    const auto room = ImGui::GetContentRegionAvail();
    const float scale = std::max(
        1e-3f, std::min(room.x / static_cast<float>(s.output.width), room.y / static_cast<float>(s.output.height)));
    const ImVec2 size(scale * static_cast<float>(s.output.width), scale * static_cast<float>(s.output.height));
    const ImVec2 corner(std::max(0.0f, 0.5f * (room.x - size.x)), std::max(0.0f, 0.5f * (room.y - size.y)));
    if (has_picture)
        ImGui::GetWindowDrawList()->AddImage(
            // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui's texture identifiers are pointers
            reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), corner,
            {corner.x + size.x, corner.y + size.y});
    ImGui::SetCursorPos(corner);
    ImGui::InvisibleButton("mouse", size,
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle | ImGuiButtonFlags_MouseButtonRight);
    mouse(corner, size);
    if (const auto part = document_.selected())
        if (const auto box = box_of(document_.now().scene, document_.parts()[*part], static_cast<double>(size.x),
                static_cast<double>(size.y)))
            ImGui::GetWindowDrawList()->AddRect(
                {corner.x + static_cast<float>(box->left) - 3, corner.y + static_cast<float>(box->top) - 3},
                {corner.x + static_cast<float>(box->right) + 3, corner.y + static_cast<float>(box->bottom) + 3},
                IM_COL32(255, 200, 60, 200), 4, 0, 1.5f);
}

void picture_pane::mouse(const ImVec2& corner, const ImVec2& size)
{
    const auto& io = ImGui::GetIO();
    const double width = static_cast<double>(size.x), height = static_cast<double>(size.y);
    const double x = static_cast<double>(io.MousePos.x - corner.x), y = static_cast<double>(io.MousePos.y - corner.y);
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
        document_.begin("zoom");
        document_.zoom(std::pow(1.1, static_cast<double>(io.MouseWheel)));
    }
    if (ImGui::IsItemActivated()) {
        pressed_ = pick(document_.now().scene, document_.parts(), width, height, x, y);
        moved_ = false;
        moves_part_ = ImGui::IsMouseDown(ImGuiMouseButton_Left) && pressed_ && document_.selected() == pressed_->part;
    }
    if (ImGui::IsItemActive()) {
        const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
        if (!moved_
            && ImGui::IsMouseDragging(left                        ? ImGuiMouseButton_Left
                    : ImGui::IsMouseDown(ImGuiMouseButton_Middle) ? ImGuiMouseButton_Middle
                                                                  : ImGuiMouseButton_Right,
                3.0f)) {
            moved_ = true;
            document_.begin(moves_part_    ? "move of " + document_.parts()[pressed_->part].name
                    : left && !io.KeyShift ? "turn"
                                           : "pan");
        }
        if (!moved_)
            return;
        if (moves_part_)
            drag(sight_line_at(document_.now().scene.camera, width, height, x, y), io.KeyShift);
        else if (left && !io.KeyShift)
            document_.orbit(180 * static_cast<double>(io.MouseDelta.x) / width,
                180 * static_cast<double>(io.MouseDelta.y) / height);
        else
            document_.pan(
                -static_cast<double>(io.MouseDelta.x) / height, static_cast<double>(io.MouseDelta.y) / height);
    }
    if (ImGui::IsItemDeactivated() && !moved_ && ImGui::IsMouseReleased(ImGuiMouseButton_Left))
        document_.select(pressed_ ? std::optional(pressed_->part) : std::nullopt);
}

void picture_pane::drag(const sight_line& line, bool level)
{
    const auto to = on_plane(document_.now().scene.camera, line, pressed_->position, level);
    if (!to)
        return;
    move(document_.edit().scene, document_.parts()[pressed_->part], *to - pressed_->position);
    pressed_->position = *to;
}

void draw_scene_error(const std::string& what)
{
    const auto room = ImGui::GetWindowSize();
    const float wide = std::max(100.0f, room.x - 16), high = ImGui::CalcTextSize(what.c_str(), nullptr, false, wide).y,
                top = std::max(8.0f, room.y - high - 12);
    auto* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({0, top - 6}, room, IM_COL32(40, 0, 0, 220));
    list->AddText(nullptr, 0, {8, top}, IM_COL32(255, 160, 130, 255), what.c_str(), nullptr, wide);
}

namespace {
    /// "picture 40 %  passes 12  left 8 s  error 0.034, 0.02 in about 15 s"; what is not known is left out.
    std::string of_whole_picture(const render_report& r)
    {
        char text[64];
        std::snprintf(text, sizeof text, "picture %.0f %%  passes %u", 100 * r.progress.whole, r.progress.passes);
        std::string all = text;
        if (std::isfinite(r.progress.seconds_left)) {
            std::snprintf(text, sizeof text, "  left %.0f s", r.progress.seconds_left);
            all += text;
        }
        if (std::isfinite(r.stats.end.error))
            all += "  error " + progress_bar::with_digits(r.stats.end.error) + progress_bar::foreseen(r.progress, ": ");
        return all;
    }
} // namespace

void draw_report(const render_report& r, const frame& shown, bool numbers)
{
    char text[512];
    const auto& st = r.stats;
    std::snprintf(text, sizeof text,
        "%s on %s\n%s %.0f %%  pictures %llu  after %.0f ms\nphotons %u  maps %llu  passes %llu  unfinished "
        "%llu\ntrace %.0f  build %.0f  rays %.0f  estimate %.0f ms\n%s",
        r.backend.c_str(), r.device.substr(0, 40).c_str(), std::string(r.progress.stage).c_str(),
        100 * r.progress.fraction, static_cast<unsigned long long>(shown.number), shown.ms, r.progress.photons,
        static_cast<unsigned long long>(r.maps), static_cast<unsigned long long>(r.passes),
        static_cast<unsigned long long>(r.progress.unfinished), st.trace_photons.ms, st.build_map.ms, st.trace_rays.ms,
        st.radiance_estimate.ms, of_whole_picture(r).c_str());
    auto* list = ImGui::GetWindowDrawList();
    if (numbers) {
        list->AddText({9, 9}, IM_COL32(0, 0, 0, 255), text);
        list->AddText({8, 8}, IM_COL32(255, 255, 255, 230), text);
    }
    if (!r.error.empty())
        list->AddText(nullptr, 0, {8, 96}, IM_COL32(255, 120, 90, 255), ("not drawn: " + r.error).c_str(), nullptr,
            std::max(100.0f, ImGui::GetWindowWidth() - 16));
}

} // namespace photongrid::viewer
