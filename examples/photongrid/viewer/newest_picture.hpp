// The newest picture on the screen: its exposure, and the curves of what it changed and how wrong it is.
#pragma once

#include "picture_pane.hpp"
#include "render_thread.hpp"

#include <optional>
#include <vector>

namespace photongrid::viewer {

class newest_picture {
public:
    /// `r` and `pane` must outlive it. `reference`: to compute errors against.
    newest_picture(const render_thread& r, picture_pane& pane, std::optional<image> reference)
        : renderer_(r), pane_(pane), reference_(std::move(reference))
    {
    }

    /// Takes what the renderer has made since, and shows it. `exposure`: as set, EV; none: one that fits.
    void take_news(std::optional<double> exposure);
    /// Shows the picture at another exposure.
    void show(std::optional<double> exposure);
    /// Another scene follows, with which the reference has nothing to do.
    void forget_reference() { reference_.reset(); }
    /// Within an ImGui window.
    void draw_curves() const;

    const frame& shown() const { return shown_; }
    const render_report& report() const { return report_; }
    double exposure() const { return exposure_; } ///< of the screen, EV

private:
    /// Whether the picture shown is the last of its request.
    bool is_whole() const { return report_.whole && report_.request == shown_.request; }

    const render_thread& renderer_;
    picture_pane& pane_;
    std::optional<image> reference_;
    frame shown_;
    render_report report_;
    double exposure_ = 0;
    bool fitted_to_whole_ = false;        ///< exposure_ is fitted to the last picture of its request
    std::vector<float> changes_, errors_; ///< log10, since the last request
};

} // namespace photongrid::viewer
