// The interactive loop (section 3.4): a picture is started, advanced in steps, displayed at any time, changed and
// cancelled. It has the only loop over passes, each of which is figure 1 of the paper:
//
//     world  -> pilot, if settings are automatic
//     world  -> trace_photons -> build_map ------------------+
//     camera -> trace_eye -> direct_light -> gather -> irradiance (2.3) -> shade -> film
//
// The photon map is rebuilt only if geometry, materials or lights change.
//
//     progressive_render<B> drawing(device);
//     for (drawing.start(scene, settings); !drawing.finished(); show(drawing.picture()))
//         drawing.step(16ms);
#pragma once

#include <photongrid/render/map_keeper.hpp>
#include <photongrid/render/pass_drawing.hpp>
#include <photongrid/render/picture_end.hpp>
#include <photongrid/render/pilot.hpp>
#include <photongrid/render/renderer.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// A renderer on one backend.
template <backend B>
class progressive_render : public renderer {
public:
    /// `device` must outlive it.
    explicit progressive_render(B& device);

    void start(const scene& s, const render_settings& settings, const preview_settings& previews = {}) override
    {
        check(s);
        check(settings);
        stop_asked_ = false;
        if (!started_ || !same_light_paths(scene_, s)) {
            making_world_.reset(); // it has a reference to scene_
            ++wanted_world_;
        }
        scene_ = s;
        settings_ = settings;
        previews_ = previews;
        begin_picture();
        started_ = true;
    }
    void resume(render_state s) override
    {
        if (!started_)
            throw std::logic_error("progressive_render::resume: no picture was started; call start()");
        if (is_automatic(settings_))
            throw std::logic_error("progressive_render::resume: settings are automatic; call step() until they are "
                                   "numbers, or start() with numbers");
        check(s, settings_);
        if (preview_ || number_ || film_.passes() > 0)
            throw std::logic_error(
                "progressive_render::resume: the picture has begun; call it between start() and step()");
        film_ = std::move(s.film);
        unfinished_ = std::move(s.pass);
        previews_.enabled = false;
        clock_ = work_clock(s.seconds);
        judge_.resume(film_, s.seconds);
        stats_.end = judge_.result();
        if (film_.passes() > 0)
            ++pictures_;
    }
    render_state state() override
    {
        render_state s{film_, unfinished_, clock_.seconds()};
        if (!pass_) // no pass has begun; what resume() gave, if anything, is still to come
            return s;
        s.pass = {*number_, rows_done()};
        s.pass.light = pass_->light();
        if (const auto* band = pass_->band()) {
            const auto& light = band->light();
            s.pass.rays = light.rays;
            s.pass.band
                = {device_.download(light.pixels), device_.download(light.searches), device_.download(light.errors),
                    {device_.download(light.biases.bias), device_.download(light.biases.tilt),
                        device_.download(light.biases.jump)}};
        }
        return s;
    }

    bool step(milliseconds budget = no_limit) override
    {
        if (!started_)
            throw std::logic_error("progressive_render::step: no picture was started; call start()");
        const auto begin = std::chrono::steady_clock::now();
        clock_.go_on();
        try {
            while (!finished()) {
                advance();
                note_new_picture();
                judge_.during_pass(clock_.seconds(), pictures_ > 0);
                stats_.end = judge_.result();
                if (stop_asked_.exchange(false) || std::chrono::steady_clock::now() - begin >= budget)
                    break;
            }
        } catch (...) {
            preview_.reset();
            pass_.reset();
            maps_.clear();
            radius_maps_.clear();
            making_world_.reset();
            pilot_.reset();
            world_.reset();
            begin_picture();
            throw;
        }
        clock_.pause();
        return finished();
    }

    image picture() override
    {
        if (pictures_ == 0)
            throw std::logic_error(
                "progressive_render::picture: no picture yet; call step() until pictures() is above 0");
        if (film_.passes() > 0) {
            auto developed = film_.picture();
            stats_.invalid_pixels = developed.invalid_pixels;
            return std::move(developed.picture);
        }
        std::uint64_t invalid = 0;
        if (auto* band = drawn_band(); band != nullptr && band->grown() > 0 && !has_bands())
            return band->running_estimate(invalid);
        auto shown = shown_
            ? detail::to_image(device_.download(shown_->pixels), shown_->raster, settings_, shown_scale_, invalid)
            : image{settings_.output.width, settings_.output.height, std::vector<glm::vec3>(picture_size())};
        std::uint64_t invalid_above = 0;
        const auto above = detail::finite_pixels(finished_bands().pixels, 1, invalid_above);
        std::copy(above.begin(), above.end(), shown.pixels.begin());
        return shown;
    }

    render_progress progress() const override
    {
        auto p = progress_of_stage();
        const auto foreseen = forecast(p);
        p.whole = foreseen.fraction;
        p.seconds_left = foreseen.seconds_left;
        p.errors = judge_.foreseen_errors(judge_.pass_seconds(), clock_.seconds() - judge_.last_end());
        return p;
    }
    std::uint64_t maps() const override { return maps_.begun(); }
    const capabilities& caps() const override { return device_.caps(); }
    const std::map<std::string, kernel_cost>& costs() const override { return device_.costs(); }

private:
    render_progress progress_of_stage() const
    {
        const std::uint64_t pixels = std::uint64_t{settings_.output.width} * settings_.output.height;
        if (finished())
            return {"finished", 1, 0, 1, settings_.map.photons, film_.passes()};
        if (!has_world())
            return {"prepare_scene", making_world_ ? making_world_->fraction() : 0.0, pixels};
        if (is_automatic(settings_))
            return {"choose_settings", pilot_ ? pilot_->fraction() : 0.0, pixels};
        const auto& made = radius_maps_.making_photons() ? radius_maps_ : maps_;
        if (const auto photons = made.making_photons(); photons || (!preview_ && !pass_ && rows_done() == 0))
            return {made.fraction() < 1 ? "trace_photons" : "build_map", made.fraction(), pixels, 1,
                photons.value_or(settings_.map.photons), film_.passes()};
        const uint photons = maps_.source().settings.map.photons;
        if (preview_)
            return {
                "preview", preview_->fraction(), preview_->unfinished(), preview_->divisor(), photons, film_.passes()};
        const auto* band = pass_ ? pass_->band() : nullptr;
        const std::uint64_t done = finished_bands().pixels.size() + (band != nullptr ? band->light().raster.size() : 0);
        return {"radiance_estimate", pass_ ? pass_->fraction() : 0.0,
            pixels - done + (band != nullptr ? band->unfinished() : 0), 1, photons, film_.passes()};
    }
    /// A pass takes as long as those before. Within the first, what is drawn of it tells how long the rest takes.
    picture_forecast forecast(const render_progress& now) const
    {
        const double seconds = clock_.seconds(), since = seconds - judge_.last_end();
        double of_pass = judge_.pass_seconds();
        if (of_pass == 0 && now.stage == "radiance_estimate" && now.fraction > 0)
            of_pass = drawing_since_ + (seconds - drawing_since_) / now.fraction - judge_.last_end();
        if (!(of_pass > 0))
            return judge_.forecast(0, std::numeric_limits<double>::infinity(), seconds);
        return judge_.forecast(std::clamp(since / of_pass, 0.0, 1.0), of_pass, seconds);
    }

    void begin_picture()
    {
        pilot_.reset();
        preview_.reset();
        pass_.reset();
        number_.reset();
        kept_.clear();
        shown_.reset();
        film_ = {};
        unfinished_ = {};
        pictures_ = 0;
        judge_ = picture_judge(settings_.output);
        clock_ = work_clock();
        drawing_since_ = 0;
        early_ = previews_of();
        whole_ = previews_of();
        if (!maps_.serves(key_of_pass(next_pass())))
            stats_ = {};
        stats_.prepare_scene = has_world() ? world_->prepared : stage_stats{};
        stats_.trace_rays = stats_.radiance_estimate = {};
        stats_.estimate = {};
        stats_.photons = {};
        stats_.invalid_pixels = 0;
        stats_.pilot.reset();
        stats_.end = {};
    }

    /// Takes the next step of the picture; returns whether there was one. Each function that it calls takes one step
    /// and returns true, or returns false if it has nothing left to do.
    bool advance();

    // The world.

    /// Whether scene_ is on the device.
    bool has_world() const { return world_ && world_number_ == wanted_world_; }
    bool prepare_world()
    {
        if (has_world())
            return false;
        if (!making_world_)
            making_world_.emplace(device_, scene_, world_);
        if (making_world_->advance()) {
            world_ = making_world_->take();
            making_world_.reset();
            world_number_ = wanted_world_;
            stats_.prepare_scene = world_->prepared;
        }
        return true;
    }

    /// Replaces automatic settings by numbers.
    bool choose_settings();

    // Maps.

    /// The inputs of the map for pass `number`.
    map_key key_of_pass(uint number) const { return {wanted_world_, settings_of_pass(settings_, number), number}; }
    bool make_map(const map_key& wanted)
    {
        if (maps_.serves(wanted))
            return false;
        if (!maps_.advance(wanted, world_))
            return true;
        const auto& made = maps_.map().stats;
        if (film_.passes() == 0)
            stats_.trace_photons = stats_.build_map = {};
        detail::add_map(stats_, made);
        if (const auto photons = maps_.map().map().photons.size(); photons > 0)
            costs_.ms_per_photon = (made.trace_photons.ms + made.build_map.ms) / photons;
        return true;
    }
    /// Makes the map that gives the first radii of all passes.
    bool find_first_radii()
    {
        if (!has_shrinking_radii(settings_))
            return false;
        const map_key wanted{wanted_world_, settings_of_radius_map(settings_, device_.caps()), radius_pass};
        if (radius_maps_.serves(wanted))
            return false;
        if (radius_maps_.advance(wanted, world_)) {
            const auto& made = radius_maps_.map().stats;
            detail::add(stats_.trace_photons, made.trace_photons);
            detail::add(stats_.build_map, made.build_map);
        }
        return true;
    }

    // Previews.

    /// The previews that are drawn with one map.
    struct previews_of {
        std::optional<map_key> map;                ///< once it is known
        std::optional<std::vector<preview>> to_do; ///< once the map is there; the last one first
        bool done = false;
    };

    /// Whether previews are drawn, and not running estimates in their place.
    bool has_previews() const { return previews_.enabled && !shows_running_estimates(); }
    bool shows_running_estimates() const
    {
        return previews_.running_estimates && !has_bands() && !has_shrinking_radii(settings_)
            && detail::sums_while_growing(detail::search_for(settings_));
    }
    /// If there is no map yet and tracing all photons would take long: a preview with fewer photons.
    bool draw_early_previews()
    {
        if (!early_.done && !early_.map) {
            early_.map = early_map();
            early_.done = !early_.map;
        }
        return draw_previews(early_);
    }
    std::optional<map_key> early_map() const
    {
        auto fewer = key_of_pass(first_pass());
        if (!has_previews() || maps_.serves(fewer) || settings_.output.only == light_part::direct)
            return {};
        if (maps_.serves_preview_of(fewer))
            return maps_.source();
        auto& with = fewer.settings;
        const uint photons = preview_photons(with, costs_, previews_.target_ms);
        if (photons == with.map.photons || maps_.is_making(fewer))
            return {};
        const uint divisor = with.map.photons / photons;
        divide_k(with.estimate, divisor);
        if (with.map.caustic_photons > 0)
            with.map.caustic_photons = std::max(1u, with.map.caustic_photons / divisor);
        with.map.photons = photons;
        return fewer;
    }
    /// Previews with all photons.
    bool draw_whole_previews()
    {
        if (!whole_.done && !whole_.map)
            whole_.map = key_of_pass(first_pass());
        return draw_previews(whole_);
    }
    bool draw_previews(previews_of& p)
    {
        if (p.done)
            return false;
        if (make_map(*p.map))
            return true;
        if (!p.to_do) {
            const uint photons = maps_.source().settings.map.photons;
            const bool early_shown = pictures_ > 0; // before the map with all photons there is no other picture
            p.to_do.emplace();
            if (has_previews() && !(previews_.only_first && early_shown))
                p.to_do = preview_schedule(settings_, photons, early_shown, costs_, previews_.target_ms);
            if (previews_.only_first && !p.to_do->empty())
                p.to_do->resize(1);
            std::reverse(p.to_do->begin(), p.to_do->end());
        }
        if (!preview_ && !p.to_do->empty()) {
            begin_preview(p.to_do->back());
            p.to_do->pop_back();
        }
        p.done = !preview_ && p.to_do->empty();
        if (p.done)
            return false;
        if (preview_->advance())
            end_preview();
        return true;
    }
    void begin_preview(const preview& p)
    {
        const uint number = begin_views(first_pass());
        auto with = settings_of_pass(settings_, number);
        divide_k(with.estimate, std::max(1u, with.map.photons / maps_.source().settings.map.photons));
        preview_.emplace(device_, maps_.map(), scene_.camera, with, view_settings(p), stats_);
        preview_->use_samples(kept_);
    }
    void end_preview()
    {
        if (pictures_ == 0)
            costs_.ms_per_preview_pixel = ms_of_views() / static_cast<double>(preview_->light().pixels.size());
        show(preview_->take(), 1);
        preview_.reset();
    }
    /// For a map with so many times fewer photons.
    static void divide_k(estimate_settings& e, uint divisor)
    {
        for (const bool of_caustics : {false, true})
            e.sought(of_caustics) = std::max(1u, e.sought(of_caustics) / divisor);
    }

    // Passes.

    std::size_t picture_size() const { return std::size_t{settings_.output.width} * settings_.output.height; }
    bool has_bands() const { return bands_of(settings_.output).size() > 1; }
    /// Of the pass that is drawn.
    const pass_pixels& finished_bands() const { return pass_ ? pass_->light() : unfinished_.light; }
    uint rows_done() const { return static_cast<uint>(finished_bands().pixels.size() / settings_.output.width); }
    view_pass<B>* drawn_band() { return pass_ ? pass_->band() : nullptr; }

    /// The pass to draw next: first one that was begun, then one for the map in use, then one that needs another map.
    /// With a stop rule the one for the map in use has to wait: which passes a picture has must depend on their number
    /// alone.
    uint next_pass() const
    {
        if (!unfinished_.empty())
            return unfinished_.number;
        if (!settings_.output.has_stop_rule() && has_map_of_unfinished_pass())
            return maps_.source().pass;
        uint first = 0;
        while (film_.holds(first))
            ++first;
        return first;
    }
    bool has_map_of_unfinished_pass() const
    {
        const uint kept = maps_.source().pass;
        return kept < settings_.output.passes_at_most() && !film_.holds(kept) && maps_.serves(key_of_pass(kept));
    }
    /// The pass of the map before passes begin: previews may have any.
    uint first_pass() const
    {
        return has_previews() && unfinished_.empty() && has_map_of_unfinished_pass() ? maps_.source().pass
                                                                                     : next_pass();
    }
    bool draw_pass()
    {
        if (!number_ && !choose_pass())
            return false;
        if (make_map(key_of_pass(*number_)))
            return true;
        if (!pass_)
            begin_pass();
        const uint rows = rows_done();
        pass_->advance();
        if (rows_done() > rows)
            end_band(rows_done() - rows);
        if (pass_->finished())
            end_pass();
        return true;
    }
    /// Returns whether there is another pass to draw.
    bool choose_pass()
    {
        judge_.before_pass(film_, clock_.seconds());
        if (!judge_.ended())
            number_ = next_pass();
        return number_.has_value();
    }
    void begin_pass()
    {
        begin_views(*number_);
        pass_.emplace(
            device_, maps_.map(), scene_.camera, settings_of_pass(settings_, *number_), view_settings({}), stats_);
        pass_->use_samples(kept_);
        if (has_shrinking_radii(settings_))
            pass_->use_radii(
                radii_of_pass(radius_maps_.map(), settings_of_radius_map(settings_, device_.caps()), *number_));
        pass_->resume(std::exchange(unfinished_, {}));
        pass_->begin_band();
        if (rows_done() == 0)
            drawing_since_ = clock_.seconds();
    }
    void end_band(uint rows)
    {
        costs_.ms_per_pixel = ms_of_views() / (1.0 * rows * settings_.output.width);
        begin_views(*number_);
        if (!pass_->finished() && film_.passes() == 0)
            ++pictures_;
    }
    void end_pass()
    {
        if (film_.size() == 0)
            film_ = film_for(scene_, world_->scene.layout, settings_);
        film_.add(*number_, pass_->take());
        pass_.reset();
        number_.reset();
        judge_.after_pass(film_, clock_.seconds(), stats_);
        shown_.reset();
        ++pictures_;
        if (!judge_.ended() && choose_pass() && maps_.serves(key_of_pass(*number_)))
            begin_pass();
    }

    // Views: previews and bands.

    /// Views of pass `number` follow. Returns it.
    uint begin_views(uint number)
    {
        if (std::exchange(views_of_, number) != number)
            kept_.clear(); // of a preview of another pass
        ms_before_ = stats_.trace_rays.ms + stats_.radiance_estimate.ms;
        samples_shown_ = grown_shown_ = 0;
        return number;
    }
    double ms_of_views() const { return stats_.trace_rays.ms + stats_.radiance_estimate.ms - ms_before_; }
    view_pass_settings view_settings(std::optional<preview> p) const
    {
        return {p, step_size::small, previews_.enabled && !has_bands(), shows_running_estimates(), {}};
    }
    void show(canvas<B> c, float scale)
    {
        shown_.emplace(std::move(c));
        shown_scale_ = scale;
        ++pictures_;
    }
    /// During the first pass the picture improves after each sample, and while a growing search runs (3.4).
    void note_new_picture()
    {
        auto* band = drawn_band();
        if (band == nullptr || film_.passes() > 0 || has_bands())
            return;
        if (band->grown() > grown_shown_) {
            grown_shown_ = band->grown();
            ++pictures_;
        }
        if (band->has_whole_samples() && band->samples() > samples_shown_) {
            samples_shown_ = band->samples();
            show(band->snapshot(), static_cast<float>(settings_.view.spp) / static_cast<float>(samples_shown_));
        }
    }

    B& device_;
    scene scene_;
    preview_settings previews_;
    work_costs costs_;
    picture_judge judge_;
    work_clock clock_;         ///< of the picture
    double drawing_since_ = 0; ///< when the light of a pass began to be drawn, s

    std::shared_ptr<world<B>> world_; ///< of scene_, or of the one before until that of scene_ is ready
    std::optional<world_building<B>> making_world_;
    std::uint64_t world_number_ = 0, wanted_world_ = 0; ///< numbers of world_, and of the world of scene_
    std::optional<pilot<B>> pilot_;
    map_keeper<B> maps_;
    map_keeper<B> radius_maps_; ///< shrinking_radii.hpp

    // Pictures.
    previews_of early_, whole_;
    std::optional<view_pass<B>> preview_;
    unfinished_pass unfinished_; ///< to resume from
    std::optional<uint> number_; ///< of the pass that is drawn, or whose map is made
    std::optional<pass_drawing<B>> pass_;
    uint views_of_ = 0;              ///< the pass that preview_ and pass_ are of
    kept_samples<B> kept_;           ///< of that pass
    std::optional<canvas<B>> shown_; ///< until the first pass is finished
    float shown_scale_ = 1;
    uint samples_shown_ = 0, grown_shown_ = 0; ///< of the view that is drawn
    double ms_before_ = 0;                     ///< time spent on views before it
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
progressive_render<B>::progressive_render(B& device)
    : device_(device), maps_(device), radius_maps_(device, map_use::first_radii)
{
}

template <backend B>
bool progressive_render<B>::choose_settings()
{
    if (!is_automatic(settings_))
        return false;
    if (settings_.estimate.max_radius == automatic_length)
        settings_.estimate.max_radius = radius_for(world_->scene.layout);
    if (!pilot_ && needs_pilot(settings_))
        pilot_.emplace(device_, world_, scene_, settings_);
    if (pilot_ && pilot_->advance()) {
        stats_.pilot = pilot_->measures();
        settings_ = chosen_settings(*stats_.pilot, settings_);
        pilot_.reset();
        judge_ = picture_judge(settings_.output);
    }
    return true;
}

template <backend B>
bool progressive_render<B>::advance()
{
    return prepare_world() || choose_settings() || draw_early_previews() || draw_whole_previews() || find_first_radii()
        || draw_pass();
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
