#include "question.hpp"

#include "display.hpp"

#include <iterator>
#include <utility>

namespace photongrid::viewer {

namespace {
    constexpr const char* title = "The scene has changes that are not saved";

    /// How the question is put, by what it is about.
    struct wording {
        const char* why; ///< may be empty
        const char* answers[3];
    };
    constexpr wording wordings[] = {{"", {"save scene and close", "close without saving", "stay"}},
        {"", {"save scene and open", "open without saving", "stay"}},
        {"One of its files has changed. What you have moved would go back to where the file has it.",
            {"save scene and read again", "read again without saving", "stay"}}};
} // namespace

void question::ask(about what)
{
    asked_ = what;
    opens_ = true;
}

std::optional<question::answer> question::draw()
{
    if (!asked_)
        return std::nullopt;
    if (std::exchange(opens_, false))
        ImGui::OpenPopup(title);
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove))
        return std::nullopt;
    const auto& w = wordings[static_cast<std::size_t>(*asked_)];
    if (w.why[0] != 0)
        ImGui::TextUnformatted(w.why);
    std::optional<answer> given;
    for (std::size_t i = 0; i < std::size(w.answers); ++i) {
        if (ImGui::Button(w.answers[i]))
            given = static_cast<answer>(i);
        placed(w.answers[i]);
        ImGui::SameLine();
    }
    if (given) {
        asked_.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return given;
}

} // namespace photongrid::viewer
