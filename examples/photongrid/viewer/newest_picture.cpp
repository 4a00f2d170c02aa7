#include "newest_picture.hpp"

#include "display.hpp"
#include <photongrid/compare/image_difference.hpp>
#include <photongrid/io/tone_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace photongrid::viewer {

void newest_picture::take_news(std::optional<double> exposure)
{
    report_ = renderer_.report();
    auto next = renderer_.newer_than(shown_.number);
    if (!next) {
        if (is_whole() && !fitted_to_whole_)
            show(exposure);
        return;
    }
    if (next->request != shown_.request) {
        changes_.clear();
        errors_.clear();
    }
    shown_ = std::move(*next);
    if (shown_.change > 0)
        changes_.push_back(static_cast<float>(std::log10(shown_.change)));
    if (const auto& r = reference_; r && r->width == shown_.picture.width && r->height == shown_.picture.height)
        errors_.push_back(static_cast<float>(std::log10(std::max(1e-12, compare_images(shown_.picture, *r).relmse))));
    show(exposure);
}

void newest_picture::show(std::optional<double> exposure)
{
    // A fitted exposure follows the picture in steps, so that the screen does not flicker while it converges, and fits
    // the last picture, so that it does not depend on those before.
    fitted_to_whole_ = is_whole();
    if (const double fits = exposure_for(shown_.picture, exposure);
        exposure || fitted_to_whole_ || std::abs(fits - exposure_) > 0.25)
        exposure_ = fits;
    pane_.upload(shown_.picture, exposure_);
}

void newest_picture::draw_curves() const
{
    const auto plot = [](const char* label, const std::vector<float>& values, const char* help) {
        char last[48] = "";
        if (!values.empty())
            std::snprintf(last, sizeof last, "%.2g", std::pow(10.0, static_cast<double>(values.back())));
        ImGui::PlotLines(label, values.data(), static_cast<int>(values.size()), 0, last, -8, 2, {170, 60});
        tip(label, help);
    };
    plot("change", changes_,
        "relMSE from picture to picture since your last change, logarithmic: from 100 down to 1e-8.");
    if (reference_)
        plot("error", errors_, "relMSE to the reference, logarithmic: from 100 down to 1e-8.");
}

} // namespace photongrid::viewer
