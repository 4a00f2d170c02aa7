// The panel's controls for settings and backend, and their keys: by the rows of setting_table.hpp.
#pragma once

#include "document.hpp"
#include "window_input.hpp"

#include <optional>

namespace photongrid::viewer {

class settings_panel {
public:
    /// `d` must outlive it.
    explicit settings_panel(document& d) : document_(d) { begin_anew(); }
    /// The document has another scene. Its grid, or one of 32 x 32 x 32 where it names none, is what "fitted grid" goes
    /// back to.
    void begin_anew();

    /// Within an ImGui window. `shown_exposure`: of the screen, EV.
    void draw(double shown_exposure);
    /// A key without Ctrl, while no text is being typed.
    void key(const key_press& p, double shown_exposure);

private:
    template <class Row>
    void choice(const Row& row, const char* label, const char* help);
    template <class Row>
    void number(const Row& row, const char* label, int low, int high, const char* help);
    template <class Row>
    void measure(const Row& row, const char* label, float low, float high, const char* format, bool logarithmic,
        const char* help);
    template <class Change>
    void change(const std::string& name, Change apply);
    bool begun(const char* name);
    void draw_backend();
    void draw_grid();
    void draw_exposure(double shown);

    document& document_;
    glm::uvec3 grid_{32};         ///< that is not fitted
    std::optional<version> held_; ///< before the item that is held was edited
};

} // namespace photongrid::viewer
