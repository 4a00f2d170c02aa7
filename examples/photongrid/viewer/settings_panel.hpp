// The panel's controls for settings and backend, and their keys: by the rows of setting_table.hpp.
#pragma once

#include "document.hpp"
#include "window_input.hpp"

#include <photongrid/scene/setting_table.hpp>

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
    template <class Row, class Value, std::size_t N>
    void control(const Row& row, const setting_table::one_of<Value, N>& choice, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::whole_range&, const char* label);
    template <class Row>
    void control(const Row& row, const real_range&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::whole_or_auto&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::length_or_auto&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::real_or_auto&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::cells&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::policies&, const char* label);
    template <class Row>
    void control(const Row& row, const setting_table::pixels&, const char* label);
    template <class Row>
    bool is_automatic(const Row& row, const char* label);
    template <class Row>
    void slide(const Row& row, const char* label, int flags);
    template <class Row>
    void explain(const Row& row, const char* label);
    template <class Change>
    void change(const std::string& name, Change apply);
    bool begun(const char* name);
    void draw_backend();

    document& document_;
    double shown_exposure_ = 0;   ///< EV
    glm::uvec3 grid_{32};         ///< that is not fitted
    std::optional<version> held_; ///< before the item that is held was edited
};

} // namespace photongrid::viewer
