// One pass over a view from its map, band by band: a function of the map, the view, the settings and, if there are any,
// the radii.
#pragma once

#include <photongrid/render/passes.hpp>
#include <photongrid/render/render_state.hpp>

#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// Draws one pass in steps.
template <backend B>
class pass_drawing {
public:
    /// It draws nothing yet. `settings`: those of the pass; `how` has neither preview nor band. It adds times and
    /// counts to `stats`. `built` and `stats` must outlive it.
    /// \throws std::invalid_argument for a camera or settings that check() rejects, a preview or a band; backend_error.
    pass_drawing(B& device, const built_map<B>& built, const camera& view, const render_settings& settings,
        const view_pass_settings& how, render_stats& stats)
        : device_(device), built_(built), view_(view), settings_(settings), how_(how), stats_(stats)
    {
        check_numbers(settings);
        if (how.preview || how.band)
            throw std::invalid_argument("pass_drawing: how: a pass has no preview, and all bands");
    }
    pass_drawing(B&, const built_map<B>&&, const camera&, const render_settings&, const view_pass_settings&,
        render_stats&)
        = delete; // it keeps a reference
    pass_drawing(const pass_drawing&) = delete;
    pass_drawing& operator=(const pass_drawing&) = delete;

    /// \name See view_pass
    /// @{
    void use_samples(kept_samples<B>& kept) { kept_ = &kept; }
    void use_radii(pass_radii<B> radii) { radii_ = std::move(radii); }
    /// @}
    /// Goes on from `before`, of the same pass.
    void resume(unfinished_pass before)
    {
        light_ = std::move(before.light);
        unfinished_ = std::move(before);
    }

    /// Takes a step; returns whether the pass is finished.
    /// \throws backend_error; std::invalid_argument for an unfinished pass of another picture.
    bool advance()
    {
        if (!finished()) {
            begin_band();
            if (band_->advance()) {
                finish_band(device_, *band_, light_, stats_);
                band_.reset();
            }
            begin_band();
        }
        return finished();
    }
    bool finished() const { return light_.pixels.size() == size(); }
    /// Approximate fraction of the work that is done, 0 to 1.
    double fraction() const
    {
        const double band = band_ ? band_->fraction() * static_cast<double>(band_->light().raster.size()) : 0;
        return (static_cast<double>(light_.pixels.size()) + band) / static_cast<double>(size());
    }

    /// The light of the finished bands.
    const pass_pixels& light() const { return light_; }
    /// The light of the finished pass, whose counts are added to the statistics.
    /// \throws backend_error.
    pass_pixels take()
    {
        finish_pass(device_, built_, stats_);
        return std::move(light_);
    }
    /// The band that is drawn; null between two.
    view_pass<B>* band() { return band_ ? &*band_ : nullptr; }
    const view_pass<B>* band() const { return band_ ? &*band_ : nullptr; }

    /// Begins the next band, if none is drawn.
    void begin_band()
    {
        if (band_ || finished())
            return;
        auto how = how_;
        for (const auto& b : bands_of(settings_.output))
            if (!how.band && b.first >= light_.pixels.size() / settings_.output.width)
                how.band = b;
        band_.emplace(device_, built_, view_, settings_, how, stats_);
        if (kept_ != nullptr)
            band_->use_samples(*kept_);
        band_->use_radii(radii_);
        const auto before = std::exchange(unfinished_, {});
        if (before.rays > 0)
            band_->resume({{}, before.rays, upload(device_, before.band.pixels), upload(device_, before.band.searches),
                upload(device_, before.band.errors),
                {upload(device_, before.band.biases.bias), upload(device_, before.band.biases.tilt),
                    upload(device_, before.band.biases.jump)}});
    }

private:
    std::size_t size() const { return std::size_t{settings_.output.width} * settings_.output.height; }

    B& device_;
    const built_map<B>& built_;
    camera view_;
    render_settings settings_;
    view_pass_settings how_;
    render_stats& stats_;
    kept_samples<B>* kept_ = nullptr;
    pass_radii<B> radii_;
    unfinished_pass unfinished_; ///< to go on from
    pass_pixels light_;
    std::optional<view_pass<B>> band_;
};

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
