// The interactive loop (section 3.4): a picture that is started, stepped, looked at at any time, changed and cancelled.
// The photon map is built again only when geometry, materials or lights change (figure 1).
//
//     progressive_render<B> drawing(device);
//     for (drawing.start(scene, settings); !drawing.finished(); show(drawing.picture()))
//         drawing.step(16ms);
#pragma once

#include <photongrid/progressive_view.hpp>
#include <photongrid/render_progress.hpp>

#include <atomic>
#include <chrono>
#include <limits>

namespace photongrid {

/// A picture that comes about step by step. One thread starts, steps and looks; any may cancel.
template <backend B>
class progressive_render {
public:
    using milliseconds = std::chrono::duration<double, std::milli>; ///< of a step
    static constexpr milliseconds no_limit{
        std::numeric_limits<double>::infinity()}; ///< a step that ends with the picture

    /// `b` must outlive it.
    explicit progressive_render(B& b) : b_(b) {}

    /// From now on draws `s`, seen by its camera. Work in flight is given up, but for a map that serves the new picture
    /// too (same_map). Cheap: all work is step's.
    /// \throws std::invalid_argument for a scene or settings that check() refuses; what was drawn before is then still there.
    /// \snippet snippets.cpp progressive_render
    void start(const scene& s, const render_settings& settings, const first_looks& looks = {})
    {
        check(s);
        check(settings);
        stop_asked_ = false;
        view_.reset();
        if (!same_map(scene_, map_for_, s, settings))
            drop_maps();
        stats_.trace_rays = {};
        stats_.radiance_estimate = {};
        stats_.estimate = {};
        stats_.invalid_pixels = 0;
        scene_ = s;
        settings_ = settings;
        looks_ = looks;
        early_.reset();
        state_ = {};
        pictures_before_ = 0;
        started_ = true;
        if (!looks.wanted)
            drop_early_map();
    }
    /// Goes on from a state() of the same scene, settings and device, without first looks: the picture ends with the
    /// same bytes. To be called after start() and before step(), which throws std::invalid_argument for a state of
    /// another size.
    void resume(view_state s)
    {
        state_ = std::move(s);
        looks_.wanted = false;
        drop_early_map();
    }
    /// What the picture has so far, for resume().
    view_state state() { return view_ && !built_is_early_ ? view_->state() : state_; }

    /// Works for about `budget`: whole passes, at least one, until time is up, the picture is finished, or another
    /// thread cancels. Returns whether the picture is finished.
    /// \throws std::logic_error before start(), std::runtime_error when the lights store too few photons, backend_error. The
    ///         next step begins the picture anew.
    bool step(milliseconds budget = no_limit)
    {
        if (!started_)
            throw std::logic_error("progressive_render::step: nothing was started; call start()");
        const auto begin = clock::now();
        try {
            while (!finished()) {
                advance();
                if (stop_asked_.exchange(false) || clock::now() - begin >= budget)
                    break;
            }
        } catch (...) {
            view_.reset();
            drop_maps();
            throw;
        }
        return finished();
    }

    /// Makes the step that runs in another thread end after the pass in flight, whatever its budget. The next step goes
    /// on; start() begins anew.
    void cancel() { stop_asked_ = true; }

    /// True when picture() is the picture.
    bool finished() const { return view_ && !built_is_early_ && view_->finished(); }
    /// How many pictures there have been since start(); 0: picture() has nothing to show.
    std::uint64_t pictures() const { return pictures_before_ + (view_ ? view_->pictures() : 0); }
    /// The best picture so far, in the whole size.
    /// \throws std::logic_error when there is none yet, backend_error.
    image picture()
    {
        if (view_ && view_->pictures() > 0)
            return view_->picture();
        if (!early_)
            throw std::logic_error("progressive_render::picture: there is none yet; see pictures()");
        return *early_;
    }

    /// Where it is.
    render_progress progress() const
    {
        const std::uint64_t pixels = std::uint64_t{settings_.width} * settings_.height;
        if (finished())
            return {"finished", 1, 0, 1, settings_.photons};
        if (building_)
            return {building_->fraction() < 1 ? "trace_photons" : "build_map", building_->fraction(), pixels, 1,
                building_with_.photons};
        if (!view_)
            return {"trace_photons", 0, pixels, 1, settings_.photons};
        return {view_->looking() ? "first_looks" : "radiance_estimate", view_->fraction(), view_->unfinished(),
            view_->divisor(), built_with_.photons};
    }
    /// Of the map in use, and of the picture so far; whole after picture() of the finished picture.
    const render_stats& stats() const { return stats_; }
    /// Maps that were begun since this object was made.
    std::uint64_t maps() const { return maps_; }

private:
    using clock = std::chrono::steady_clock;

    void drop_maps()
    {
        building_.reset();
        built_.reset();
        built_is_early_ = false;
        stats_ = {};
    }

    /// Who wants no looks has no use for a map of fewer photons.
    void drop_early_map()
    {
        if (built_is_early_)
            built_.reset();
        built_is_early_ = false;
        if (building_ && building_with_.photons < settings_.photons)
            building_.reset();
    }

    /// One pass: of the map, or of the picture. The picture waits for a map; the whole map, for a look from an early
    /// one.
    void advance()
    {
        if (!built_ || (built_is_early_ && view_ && view_->pictures() > 0))
            advance_map();
        else if (!view_)
            start_view();
        else
            advance_view();
    }

    void advance_map()
    {
        if (!building_) {
            building_with_ = map_for_ = settings_;
            if (!built_ && looks_.wanted)
                lessen(building_with_);
            building_stats_ = {};
            building_.emplace(b_, scene_, building_with_, building_stats_);
            ++maps_;
            return;
        }
        building_->advance();
        if (building_->finished())
            use_map();
    }

    void use_map()
    {
        if (view_) { // what is seen from the early map stays until there is better
            early_ = view_->picture();
            pictures_before_ += view_->pictures();
            view_.reset();
        }
        built_.emplace(building_->take());
        building_.reset();
        built_with_ = building_with_;
        built_is_early_ = built_with_.photons < settings_.photons;
        stats_.trace_photons = building_stats_.trace_photons;
        stats_.build_map = building_stats_.build_map;
        stats_.map = building_stats_.map;
        ms_a_photon_ = (stats_.trace_photons.ms + stats_.build_map.ms) / built_with_.photons;
    }

    /// Fewer photons, and k, where tracing all would take too long for a first look.
    void lessen(render_settings& s) const
    {
        uint fewer = 1;
        while (fewer < 64 && s.photons / fewer > 1024 && s.photons / fewer * ms_a_photon_ > 2 * looks_.target_ms)
            fewer *= 2;
        s.photons /= fewer;
        s.k = std::max(1u, s.k / fewer);
    }

    void start_view()
    {
        auto settings = settings_;
        if (built_is_early_)
            settings.k = std::max(1u, settings.k / std::max(1u, settings.photons / built_with_.photons));
        view_.emplace(b_, *built_, scene_.camera, settings, stats_, looks_.wanted ? looks() : std::vector<first_look>{},
            pass_size::small);
        if (state_.rays > 0)
            view_->resume(std::exchange(state_, {}));
    }

    void advance_view()
    {
        const auto before = view_->pictures();
        const double pixels = static_cast<double>(detail::raster_of(settings_, view_->divisor()).size());
        view_->advance();
        if (view_->pictures() == before)
            return;
        const double ms = stats_.trace_rays.ms + stats_.radiance_estimate.ms;
        if (view_->finished())
            ms_a_pixel_ = ms / pixels;
        else if (before == 0)
            ms_a_look_pixel_ = ms / pixels;
    }

    /// As large pixels as must be, then smaller ones, then more photons an estimate.
    std::vector<first_look> looks() const
    {
        const auto pixels
            = [&](uint divisor) { return static_cast<double>(detail::raster_of(settings_, divisor).size()); };
        if (!built_is_early_ && pixels(1) * ms_a_pixel_ <= looks_.target_ms)
            return {};    // the picture is as fast as a look should be
        uint divisor = 1; // of which something can be recognised
        while (std::min(settings_.width, settings_.height) / divisor >= 64
            && pixels(divisor) * ms_a_look_pixel_ > looks_.target_ms)
            divisor *= 2;
        if (built_is_early_)
            return {{divisor, std::max(1u, 16 / std::max(1u, settings_.photons / built_with_.photons))}};
        std::vector<first_look> all;
        for (divisor = early_ ? std::max(1u, divisor / 2) : divisor; divisor > 1; divisor /= 2)
            all.push_back({divisor, 16});
        // Where there is little light the growing search goes out to the maximum radius whatever k is, so that a look
        // in the picture's own pixels would take as long as the picture (3.1).
        if (all.empty() || settings_.search != search_kind::at_least_k)
            all.push_back({1, 16});
        if (settings_.k > 32 && settings_.search != search_kind::at_least_k) // k / 16 is less
            all.push_back({1, 4});
        return all;
    }

    B& b_;
    bool started_ = false;
    scene scene_;
    render_settings settings_;
    first_looks looks_;
    render_stats stats_, building_stats_;
    render_settings map_for_, building_with_,
        built_with_; ///< what maps were made for, and with: the latter may have fewer photons
    std::optional<map_building<B>> building_;
    std::optional<built_map<B>> built_;
    bool built_is_early_ = false;             ///< it has fewer photons, for a first look
    std::optional<progressive_view<B>> view_; ///< of built_
    std::optional<image> early_;              ///< what was seen from an early map
    view_state state_;                        ///< to go on from
    std::uint64_t pictures_before_ = 0, maps_ = 0;
    std::atomic<bool> stop_asked_ = false;
    // What work takes; at first a guess between a GPU and one thread of a CPU.
    double ms_a_photon_ = 2e-3, ms_a_look_pixel_ = 1e-2, ms_a_pixel_ = std::numeric_limits<double>::infinity();
};

} // namespace photongrid
