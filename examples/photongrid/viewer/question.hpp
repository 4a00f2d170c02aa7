// The question that the window asks before changes are lost that are not saved.
#pragma once

#include <optional>

namespace photongrid::viewer {

class question {
public:
    /// What would lose the changes.
    enum class about { closing, opening, reading_again };
    enum class answer { save, without_saving, stay };

    /// Asks from the next draw() on, instead of what was asked before.
    void ask(about what);
    /// Whether it is being asked; empty if nothing is.
    std::optional<about> asked() const { return asked_; }
    /// Within an ImGui frame. Returns the answer when it is given.
    std::optional<answer> draw();

private:
    std::optional<about> asked_;
    bool opens_ = false;
};

} // namespace photongrid::viewer
