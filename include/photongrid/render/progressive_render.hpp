// The interactive loop (section 3.4): a picture is started, advanced in steps, displayed at any time, changed and
// cancelled. It has the only loop over passes; stages.hpp has those of a pass. The photon map is rebuilt only if
// geometry, materials or lights change (figure 1).
//
//     progressive_render<B> drawing(device);
//     for (drawing.start(scene, settings); !drawing.finished(); show(drawing.picture()))
//         drawing.step(16ms);
#pragma once

#include <photongrid/render/map_keeper.hpp>
#include <photongrid/render/passes.hpp>
#include <photongrid/render/picture_end.hpp>
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
            ++world_wanted_;
        }
        scene_ = s;
        settings_ = settings;
        settings_.output.passes = settings.output.passes_at_most();
        previews_ = previews;
        begin_picture();
        started_ = true;
    }
    void resume(render_state s) override
    {
        if (!started_)
            throw std::logic_error("progressive_render::resume: no picture was started; call start()");
        check(s, settings_);
        film_ = std::move(s.film);
        unfinished_ = std::move(s.pass);
        light_ = std::move(unfinished_.light);
        previews_.enabled = false;
        clock_ = work_clock(s.seconds);
        judge_.resume(film_, s.seconds);
        stats_.end = judge_.result();
        if (film_.passes() > 0)
            ++pictures_;
        steps_ = picture_steps();
    }
    render_state state() override
    {
        render_state s{film_, unfinished_, clock_.seconds()};
        if (unfinished_.empty()) // otherwise resume()'s state has not been consumed
            s.pass = {pass_, rows_done()};
        if (view_ && !view_->is_preview()) {
            const auto& band = view_->light();
            s.pass.rays = band.rays;
            s.pass.band
                = {device_.download(band.pixels), device_.download(band.searches), device_.download(band.errors),
                    {device_.download(band.biases.bias), device_.download(band.biases.tilt),
                        device_.download(band.biases.jump)}};
        }
        s.pass.light = light_;
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
                steps_.advance();
                note_new_picture();
                judge_.during_pass(clock_.seconds(), pictures_ > 0);
                stats_.end = judge_.result();
                if (stop_asked_.exchange(false) || std::chrono::steady_clock::now() - begin >= budget)
                    break;
            }
        } catch (...) {
            view_.reset();
            maps_.clear();
            radius_maps_.clear();
            making_world_.reset();
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
        if (view_ && view_->grown() > 0 && !has_bands())
            return view_->running_estimate(invalid);
        auto shown = shown_
            ? detail::to_image(device_.download(shown_->pixels), shown_->raster, settings_, shown_scale_, invalid)
            : image{settings_.output.width, settings_.output.height, std::vector<glm::vec3>(picture_size())};
        std::uint64_t invalid_above = 0;
        const auto above = detail::finite_pixels(light_.pixels, 1, invalid_above);
        std::copy(above.begin(), above.end(), shown.pixels.begin());
        return shown;
    }

    render_progress progress() const override
    {
        auto p = progress_of_stage();
        const auto foreseen = forecast(p);
        p.whole = foreseen.fraction;
        p.seconds_left = foreseen.seconds_left;
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
            return {"prepare_scene", making_world_ ? making_world_->fraction() : 0.0, pixels, 1, settings_.map.photons,
                film_.passes()};
        if (const auto photons = maps_.making_photons(); photons || (!view_ && rows_done() == 0))
            return {maps_.fraction() < 1 ? "trace_photons" : "build_map", maps_.fraction(), pixels, 1,
                photons.value_or(settings_.map.photons), film_.passes()};
        if (view_ && view_->is_preview())
            return {"preview", view_->fraction(), view_->unfinished(), view_->divisor(),
                maps_.of().settings.map.photons, film_.passes()};
        const std::uint64_t above = light_.pixels.size(), band = view_ ? view_->light().raster.size() : 0;
        const double drawn = static_cast<double>(above) + (view_ ? view_->fraction() * static_cast<double>(band) : 0);
        return {"radiance_estimate", drawn / static_cast<double>(pixels),
            pixels - above - band + (view_ ? view_->unfinished() : 0), 1, maps_.of().settings.map.photons,
            film_.passes()};
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
        view_.reset();
        kept_.clear();
        shown_.reset();
        film_ = {};
        unfinished_ = {};
        light_ = {};
        pictures_ = 0;
        judge_ = picture_judge(settings_.output);
        clock_ = work_clock();
        drawing_since_ = 0;
        if (!maps_.serves(pass(next_pass())))
            stats_ = {};
        stats_.prepare_scene = has_world() ? world_->prepared : stage_stats{};
        stats_.trace_rays = stats_.radiance_estimate = {};
        stats_.estimate = {};
        stats_.photons = {};
        stats_.invalid_pixels = 0;
        stats_.end = {};
        steps_ = picture_steps();
    }

    // The order of work. Each list is created when it is reached.

    /// Whether previews are drawn, and not running estimates in their place.
    bool has_previews() const { return previews_.enabled && !shows_running_estimates(); }
    bool shows_running_estimates() const
    {
        return previews_.running_estimates && !has_bands() && !has_shrinking_radii(settings_)
            && detail::sums_while_growing(detail::search_for(settings_));
    }

    /// The scene, a preview with few photons, the map, previews with all photons, then the passes.
    step_list picture_steps()
    {
        step_list steps;
        if (!has_world())
            steps.add("prepare_scene", [this] { return prepare_world(); });
        steps.expand([this] { return early_preview_steps(); });
        steps.expand([this] { return steps_to_map(pass(first_pass())); });
        steps.expand([this] { return preview_steps(); });
        steps.expand([this] { return steps_to_radii(); });
        steps.repeat(film_.passes(), settings_.output.passes, [this](uint) {
            judge_.before_pass(film_, clock_.seconds());
            return judge_.ended() ? step_list() : pass_steps(next_pass());
        });
        return steps;
    }
    /// If there is no map yet and tracing all photons would take long: a preview with fewer photons.
    step_list early_preview_steps()
    {
        auto fewer = pass(first_pass());
        if (!has_previews() || maps_.serves(fewer) || settings_.output.only == light_part::direct)
            return {};
        step_list steps;
        if (!maps_.serves_preview_of(fewer)) {
            auto& with = fewer.settings;
            const uint photons = preview_photons(with, costs_, previews_.target_ms);
            if (photons == with.map.photons || maps_.is_making(fewer))
                return {};
            const uint divisor = with.map.photons / photons;
            divide_k(with.estimate, divisor);
            if (with.map.caustic_photons > 0)
                with.map.caustic_photons = std::max(1u, with.map.caustic_photons / divisor);
            with.map.photons = photons;
            steps.expand([this, fewer] { return steps_to_map(fewer); });
        }
        steps.expand([this] { return preview_steps(); });
        return steps;
    }
    step_list preview_steps()
    {
        step_list steps;
        if (!has_previews())
            return steps;
        const uint photons = maps_.of().settings.map.photons;
        const bool early_shown = pictures_ > 0; // before the map with all photons there is no other picture
        for (const auto& p : preview_schedule(settings_, photons, early_shown, costs_, previews_.target_ms)) {
            steps.expand([this, p] { return steps_of_view(first_pass(), p); });
            steps.expand([this] { return end_preview(); });
        }
        return steps;
    }
    step_list pass_steps(uint number)
    {
        step_list steps;
        steps.expand([this, number] { return steps_to_map(pass(number)); });
        steps.expand([this, number] {
            return band_steps(
                settings_.output, rows_done(), [this, number](row_band b) { return steps_of_view(number, {}, b); },
                [this] { end_band(); });
        });
        steps.expand([this, number] { return end_pass(number); });
        return steps;
    }

    /// For a map with so many times fewer photons.
    static void divide_k(estimate_settings& e, uint divisor)
    {
        for (const bool of_caustics : {false, true})
            e.sought(of_caustics) = std::max(1u, e.sought(of_caustics) / divisor);
    }
    std::size_t picture_size() const { return std::size_t{settings_.output.width} * settings_.output.height; }
    bool has_bands() const { return bands_of(settings_.output).size() > 1; }
    /// Of the pass that is drawn.
    uint rows_done() const { return static_cast<uint>(light_.pixels.size() / settings_.output.width); }

    /// The pass to draw next: first one that was begun, then one for the map in use, then one that needs another map.
    /// With a stop rule the one for the map in use has to wait: which passes a picture has must depend on their number
    /// alone.
    uint next_pass() const
    {
        if (!unfinished_.empty())
            return unfinished_.number;
        if (!settings_.output.has_stop_rule() && has_map_of_unfinished_pass())
            return maps_.of().pass;
        uint first = 0;
        while (film_.holds(first))
            ++first;
        return first;
    }
    bool has_map_of_unfinished_pass() const
    {
        const uint kept = maps_.of().pass;
        return kept < settings_.output.passes && !film_.holds(kept) && maps_.serves(pass(kept));
    }
    /// The pass of the map before passes begin: previews may have any.
    uint first_pass() const
    {
        return has_previews() && unfinished_.empty() && has_map_of_unfinished_pass() ? maps_.of().pass : next_pass();
    }
    /// The inputs of the map for pass `number`.
    map_key pass(uint number) const { return {world_wanted_, settings_of_pass(settings_, number), number}; }

    /// Whether scene_ is on the device.
    bool has_world() const { return world_ && world_is_ == world_wanted_; }
    /// Takes a step to that; returns whether it was the last.
    bool prepare_world()
    {
        if (!making_world_)
            making_world_.emplace(device_, scene_, world_);
        if (!making_world_->advance())
            return false;
        world_ = making_world_->take();
        making_world_.reset();
        world_is_ = world_wanted_;
        stats_.prepare_scene = world_->prepared;
        return true;
    }

    step_list steps_to_map(const map_key& source)
    {
        if (maps_.serves(source))
            return {};
        auto steps = maps_.steps_to(source, world_, [this] { view_.reset(); });
        steps.expand([this] { return use_map(); });
        return steps;
    }
    /// The map that gives the first radii of all passes.
    step_list steps_to_radii()
    {
        const map_key source{world_wanted_, settings_of_radius_map(settings_, device_.caps()), radius_pass};
        if (!has_shrinking_radii(settings_) || radius_maps_.serves(source))
            return {};
        auto steps = radius_maps_.steps_to(source, world_, [this] { view_.reset(); });
        steps.expand([this] {
            const auto& made = radius_maps_.map().stats;
            detail::add(stats_.trace_photons, made.trace_photons);
            detail::add(stats_.build_map, made.build_map);
            return step_list();
        });
        return steps;
    }
    step_list use_map()
    {
        const auto& made = maps_.map().stats;
        if (film_.passes() == 0)
            stats_.trace_photons = stats_.build_map = {};
        detail::add_map(stats_, made);
        if (const auto photons = maps_.map().map().photons.size(); photons > 0)
            costs_.ms_per_photon = (made.trace_photons.ms + made.build_map.ms) / photons;
        return {};
    }

    // Views.

    step_list steps_of_view(uint number, std::optional<preview> p, std::optional<row_band> band = {})
    {
        if (std::exchange(pass_, number) != number)
            kept_.clear(); // of a preview of another pass
        auto with = settings_of_pass(settings_, number);
        if (p)
            divide_k(with.estimate, std::max(1u, with.map.photons / maps_.of().settings.map.photons));
        ms_before_ = ms_of_views();
        if (!p && rows_done() == 0)
            drawing_since_ = clock_.seconds();
        samples_shown_ = grown_shown_ = 0;
        view_.emplace(device_, maps_.map(), scene_.camera, with,
            view_pass_settings{p, step_size::small, previews_.enabled && !has_bands(), shows_running_estimates(), band},
            stats_);
        view_->use_samples(kept_);
        if (!p && has_shrinking_radii(settings_))
            view_->use_radii(
                radii_of_pass(radius_maps_.map(), settings_of_radius_map(settings_, device_.caps()), number));
        if (!p && !unfinished_.empty()) {
            const auto& light = unfinished_.band;
            if (unfinished_.rays > 0)
                view_->resume({{}, unfinished_.rays, upload(device_, light.pixels), upload(device_, light.searches),
                    upload(device_, light.errors),
                    {upload(device_, light.biases.bias), upload(device_, light.biases.tilt),
                        upload(device_, light.biases.jump)}});
            unfinished_ = {};
        }
        return view_steps(*view_);
    }
    double ms_of_views() const { return stats_.trace_rays.ms + stats_.radiance_estimate.ms; }
    double ms_per_pixel_of_view() const
    {
        return (ms_of_views() - ms_before_) / static_cast<double>(view_->light().pixels.size());
    }
    step_list end_preview()
    {
        if (pictures_ == 0)
            costs_.ms_per_preview_pixel = ms_per_pixel_of_view();
        show(view_->take(), 1);
        view_.reset();
        return {};
    }
    void end_band()
    {
        costs_.ms_per_pixel = ms_per_pixel_of_view();
        finish_band(device_, *view_, light_, stats_);
        view_.reset();
        if (light_.pixels.size() < picture_size() && film_.passes() == 0)
            ++pictures_;
    }
    step_list end_pass(uint number)
    {
        finish_pass(device_, maps_.map(), stats_);
        if (film_.size() == 0)
            film_ = film_for(scene_, world_->scene.layout, settings_);
        film_.add(number, std::exchange(light_, {}));
        judge_.after_pass(film_, clock_.seconds(), stats_);
        unfinished_ = {};
        shown_.reset();
        ++pictures_;
        return {};
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
        if (!view_ || view_->is_preview() || film_.passes() > 0 || has_bands())
            return;
        if (view_->grown() > grown_shown_) {
            grown_shown_ = view_->grown();
            ++pictures_;
        }
        if (view_->has_whole_samples() && view_->samples() > samples_shown_) {
            samples_shown_ = view_->samples();
            show(view_->snapshot(), static_cast<float>(settings_.view.spp) / static_cast<float>(samples_shown_));
        }
    }

    B& device_;
    scene scene_;
    preview_settings previews_;
    work_costs costs_;
    step_list steps_; ///< those of the whole picture
    picture_judge judge_;
    work_clock clock_;         ///< of the picture
    double drawing_since_ = 0; ///< when the light of a pass began to be drawn, s

    std::shared_ptr<world<B>> world_; ///< of scene_, or of the one before until that of scene_ is ready
    std::optional<world_building<B>> making_world_;
    std::uint64_t world_is_ = 0, world_wanted_ = 0; ///< numbers of world_, and of the world of scene_
    map_keeper<B> maps_;
    map_keeper<B> radius_maps_; ///< shrinking_radii.hpp

    // Pictures.
    unfinished_pass unfinished_; ///< to resume from
    pass_pixels light_;          ///< the finished bands of the pass that is drawn
    std::optional<view_pass<B>> view_;
    uint pass_ = 0; ///< of view_
    kept_samples<B> kept_;
    std::optional<canvas<B>> shown_; ///< until the first pass is finished
    float shown_scale_ = 1;
    uint samples_shown_ = 0, grown_shown_ = 0; ///< of view_
    double ms_before_ = 0;                     ///< time spent on views before view_
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
progressive_render<B>::progressive_render(B& device)
    : device_(device), maps_(device), radius_maps_(device, radius_map_steps<B>)
{
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
