// The stages of a pass over the pixels of a view, from a photon map (sections 2.4 and 2.3; figure 1, right).
#pragma once

#include <photongrid/core/copy_vectors.kernel.hpp>
#include <photongrid/core/zero_vectors.kernel.hpp>
#include <photongrid/render/add_error.kernel.hpp>
#include <photongrid/render/add_estimate.kernel.hpp>
#include <photongrid/render/canvas.hpp>
#include <photongrid/render/gathered_paths.hpp>
#include <photongrid/render/interpolated_estimates.hpp>
#include <photongrid/render/no_light.kernel.hpp>
#include <photongrid/render/picture_search.hpp>
#include <photongrid/render/preview_image.hpp>
#include <photongrid/render/previews.hpp>
#include <photongrid/render/row_bands.hpp>
#include <photongrid/render/scene_map.hpp>
#include <photongrid/render/shade.kernel.hpp>
#include <photongrid/render/shade_bias.kernel.hpp>
#include <photongrid/render/tally_error.kernel.hpp>
#include <photongrid/render/tally_search.kernel.hpp>

#include <array>
#include <optional>
#include <utility>

#include <photongrid/core/exact_begin.hpp>

namespace photongrid {

/// How a view is drawn. The bytes of the picture do not depend on it.
struct view_pass_settings {
    std::optional<photongrid::preview> preview{}; ///< the preview to draw; empty: draw the picture
    step_size size = step_size::largest;          ///< size of the steps
    bool wants_running_estimates = false;         ///< provide them while the search runs, if it can (3.4)
    /// If the backend's own search cannot, run the kernel search first and show its estimates
    /// (preview_settings::running_estimates).
    bool may_search_twice = false;
    std::optional<row_band> band{}; ///< the rows of the picture to draw; empty: all
};

/// One pass over a band of the picture's rows, or over a preview.
template <backend B>
class view_pass {
public:
    /// It draws nothing yet. It adds times to `stats`. `built` and `stats` must outlive it.
    /// \throws std::invalid_argument for a camera or settings that check() rejects, backend_error.
    view_pass(B& device, const built_map<B>& built, const camera& view, const render_settings& settings,
        const view_pass_settings& how, render_stats& stats)
        : device_(device), built_(built), view_(view), settings_(settings), how_(how), stats_(stats),
          branches_(1u << detail::splits_of(built.scene().layout))
    {
        check_numbers(settings);
        check(view);
        if (const auto& p = how_.preview; p && (p->divisor < 1 || p->k_divisor < 1))
            throw std::invalid_argument("view_pass: preview: divisor and k_divisor must be at least 1");
        if (settings.output.only != light_part::direct && gathers(settings) != built.gather.has_value())
            throw std::invalid_argument(std::string("view_pass: the map was built ")
                + (built.gather ? "with" : "without") + " a final gather, which the settings "
                + (built.gather ? "do not ask for" : "ask for") + "; build it with the settings of the picture");
        if (settings.output.only != light_part::direct && (settings.map.caustic_photons > 0) != built.splits_caustics)
            throw std::invalid_argument(std::string("view_pass: the map was built ")
                + (built.splits_caustics ? "with caustic photons in a map of their own" : "of all photons together")
                + ", unlike what the settings ask for (caustic_photons " + std::to_string(settings.map.caustic_photons)
                + "); build it with the settings of the picture");
        auto r = detail::raster_of(settings_, divisor());
        if (how_.band && *how_.band != row_band{0, r.height}) {
            r.first_row = how_.band->first;
            r.height = how_.band->rows;
        }
        detail::time_stage(device_, stats_.trace_rays, [&] {
            const std::size_t layers = !is_preview() && settings_.output.aov ? r.size() : 0;
            const std::size_t biases = !is_preview() && reports_bias(settings_) ? r.size() : 0;
            canvas_ = {r, 0, dark(r.size()), dark(r.size()), dark(layers), {dark(biases), dark(biases), dark(biases)}};
        });
        own_samples_.resize(branches_);
    }
    view_pass(B&, const built_map<B>&&, const camera&, const render_settings&, const view_pass_settings&, render_stats&)
        = delete; // it keeps a reference
    view_pass(const view_pass&) = delete;
    view_pass& operator=(const view_pass&) = delete;

    /// Takes the first samples from those that a preview of the same pass kept, and keeps them there if it is a
    /// preview. `kept` must outlive it.
    void use_samples(kept_samples<B>& kept)
    {
        kept_ = &kept;
        if (how_.band && *how_.band != row_band{0, settings_.output.height})
            kept.clear(); // they were traced for the whole picture, not for this band
        kept.resize(branches_);
        for (auto& k : kept)
            if (k && k->direct.size() != canvas_.raster.size())
                k.reset();
    }

    /// Gives the estimates of a picture radii from another map, which must outlive this pass. Previews find their own.
    void use_radii(const pass_radii<B>& radii) { radii_ = is_preview() ? pass_radii<B>{} : radii; }

    /// The number of eye rays per pixel, counting each combination of Fresnel branches. A preview has one sample.
    uint rays() const { return (is_preview() ? 1u : settings_.view.spp) * branches_; }

    /// The most searches per pixel: one in each map where rays end.
    uint searches() const { return rays() * static_cast<uint>(built_.lights.size()); }

    /// A step of the right side of figure 1, which runs for every view: traces eye rays, computes direct light and
    /// irradiance at their hits, and adds both to the pixels. Returns whether it was the last.
    /// \throws backend_error.
    bool advance()
    {
        using stage = bool (view_pass::*)(uint ray);
        static constexpr std::array<stage, 5> stages{&view_pass::trace_eye, &view_pass::direct_light,
            &view_pass::gather, &view_pass::irradiance, &view_pass::shade};
        if (canvas_.rays < rays() && (this->*stages[stage_])(canvas_.rays))
            stage_ = (stage_ + 1) % stages.size();
        return canvas_.rays == rays();
    }

    /// The number of pixels of the whole picture.
    std::size_t picture_size() const { return std::size_t{settings_.output.width} * settings_.output.height; }
    /// The side of the pixels, in pixels of the picture.
    uint divisor() const { return how_.preview ? how_.preview->divisor : 1u; }
    bool is_preview() const { return how_.preview.has_value(); }
    /// Approximate fraction of the work that is done, 0 to 1.
    double fraction() const
    {
        const double pixels = static_cast<double>(canvas_.raster.size());
        // As if each ray of a final gather and the search at the end of the eye ray took the same time.
        const double to_gather = rays_of_gather(settings_);
        const double finished
            = search_ ? to_gather + 1.0 - static_cast<double>(unfinished()) / pixels : static_cast<double>(gathered_);
        return (canvas_.rays + finished / (to_gather + 1)) / rays();
    }
    /// The number of pixels whose estimates for the current eye ray are not finished.
    std::uint64_t unfinished() const { return search_ ? search_->unfinished() : 0; }
    /// The number of complete samples per pixel: all their Fresnel branches were added.
    uint samples() const { return canvas_.rays / branches_; }
    /// Whether all samples that were begun are complete.
    bool has_whole_samples() const { return canvas_.rays % branches_ == 0; }

    /// How often running_estimate() has improved; 0: there is none yet, or the first sample is complete.
    uint grown() const { return canvas_.rays < branches_ ? running_pictures_ : 0; }
    /// The first sample so far, while its searches run (3.4), as an image of the picture's size: the light of the
    /// Fresnel branches that are done, and what the search for the next has found.
    /// \throws backend_error.
    image running_estimate(std::uint64_t& invalid)
    {
        auto running = copy(canvas_.pixels);
        auto ignored = device_.template make<glm::vec4>(running.size());
        const float share = 1.0f / static_cast<float>(settings_.view.spp);
        if (search_ && search_->has_running_estimates())
            shade(search_->running_estimates(), share, running, ignored);
        return detail::to_image(
            device_.download(running), canvas_.raster, settings_, static_cast<float>(settings_.view.spp), invalid);
    }
    /// The mean of the complete samples, as an image of the picture's size. There must be at least one, and no
    /// incomplete one.
    /// \throws backend_error.
    image mean_of_samples(std::uint64_t& invalid)
    {
        const float scale
            = is_preview() ? 1.0f : static_cast<float>(settings_.view.spp) / static_cast<float>(samples());
        return detail::to_image(device_.download(canvas_.pixels), canvas_.raster, settings_, scale, invalid);
    }
    /// A copy of the light so far, for display.
    canvas<B> snapshot() { return {canvas_.raster, canvas_.rays, copy(canvas_.pixels), {}, {}, {}}; }

    /// The light of all rays so far.
    const canvas<B>& light() const { return canvas_; }
    canvas<B> take() { return std::move(canvas_); }
    /// Continues from light() of the same map, view and settings.
    /// \throws std::invalid_argument for light of another size.
    void resume(canvas<B> c)
    {
        const auto n = canvas_.raster.size();
        if (c.rays > rays() || c.pixels.size() != n || c.searches.size() != n
            || c.errors.size() != canvas_.errors.size() || c.biases.bias.size() != canvas_.biases.bias.size()
            || c.biases.tilt.size() != canvas_.biases.tilt.size() || c.biases.jump.size() != canvas_.biases.jump.size())
            throw std::invalid_argument("view_pass::resume: the state is of another picture: "
                + std::to_string(c.pixels.size()) + " pixels and " + std::to_string(c.rays)
                + " rays per pixel; this one has " + std::to_string(n) + " and " + std::to_string(rays()));
        c.raster = canvas_.raster;
        canvas_ = std::move(c);
    }

private:
    // Each stage does part of its work for eye ray `ray` (sample x branches + branch), and returns whether it has
    // finished that ray.

    /// Traces eye rays through mirrors and glass to their ends (2.4).
    bool trace_eye(uint ray);

    /// Traces shadow rays from there to the lights (2.4).
    bool direct_light(uint ray);

    /// Adds the light of a final gather there, if the picture has one (final_gather.hpp).
    bool gather(uint ray);

    /// Estimates the irradiance there from the photon map (2.3).
    bool irradiance(uint ray)
    {
        bool finished = false;
        detail::time_stage(device_, stats_.radiance_estimate, [&] {
            if (!search_)
                search_.emplace(device_, sources(next_light()), pixels_of(ray), samples_->hits.points,
                    samples_->hits.directions, next_light() > 0 ? running_estimate_kind::none : shown_while_running(),
                    how_.size);
            // Previews have the light of all branches; running estimates among them must, too.
            if (search_->is_shown() && (how_.may_search_twice || canvas_.rays + 1 == branches_))
                ++running_pictures_;
            finished = search_->advance();
            if (finished && next_light() > 0) {
                found_.push_back(search_->take());
                search_.reset();
                finished = false;
            }
        });
        return finished;
    }

    /// Adds the radiance of direct and indirect light to the pixels (2.4).
    bool shade(uint ray);

    running_estimate_kind shown_while_running() const
    {
        return running_estimate_of<B>(
            sources(0).search_in_map(), how_.wants_running_estimates && !is_preview(), how_.may_search_twice);
    }
    /// The number of the light map that is searched next. The first comes last: its estimates may be shown while they
    /// grow.
    std::size_t next_light() const
    {
        const bool are_all = settings_.output.only != light_part::indirect; // caustics are none
        return (are_all ? built_.lights.size() : 1) - 1 - found_.size();
    }
    /// What estimates in the light map with this number come from.
    estimate_sources<B> sources(std::size_t number) const
    {
        const auto& light = built_.lights[number];
        const auto k = light.request.are_caustics_of_others ? detail::search_for_caustics(settings_)
                                                            : detail::search_for(settings_);
        return {.scene = &built_.scene(),
            .map = &light.map,
            .radii = radii_.first(number),
            .share2 = radii_.share2,
            .search = how_.preview ? detail::search_for_preview(k, *how_.preview) : k,
            .edges = settings_.estimate.edges};
    }
    /// The guide to the sky. Previews have none: it takes too long to learn while a camera moves.
    const buffer_of<B, glm::vec4>* sky_guide()
    {
        const auto& o = settings_.output;
        return is_preview() ? nullptr : built_.world->sky_guide(device_, view_, 1.0 * o.width / o.height);
    }
    /// Settings with fewer shadow rays if pixels are large.
    render_settings light_settings() const
    {
        render_settings s = settings_;
        if (divisor() > 1)
            s.view.light_samples = std::max(1u, s.view.light_samples / 4);
        return s;
    }

    /// Branches but the first are of few pixels, mostly.
    estimate_pixels pixels_of(uint ray) const
    {
        const bool are_few = ray % branches_ != 0;
        return {{canvas_.raster.width, canvas_.raster.height},
            is_preview() || are_few ? 0.0 : settings_.estimate.interpolation, are_few};
    }

    /// Runs `stage` over the next part of the pixels. Returns whether it was the last part.
    template <class Stage>
    bool over_pixels(stage_stats& stats, const Stage& stage)
    {
        const auto n = canvas_.raster.size();
        const std::size_t part = how_.size == step_size::small ? std::min<std::size_t>(n - done_, 65536) : n - done_;
        detail::time_stage(device_, stats, [&] { stage(launch(part, static_cast<uint>(done_))); });
        done_ = done_ + part == n ? 0 : done_ + part;
        return done_ == 0;
    }

    knn_estimates<B> shade(
        knn_estimates<B> found, float share, buffer_of<B, glm::vec4>& pixels, buffer_of<B, glm::vec4>& searches);

    /// Adds the biases of estimates to those of the pixels, if the settings ask for them.
    void shade_bias(const estimate_biases<B>& of, float share);

    buffer_of<B, glm::vec4> dark(std::size_t n);
    buffer_of<B, glm::vec4> copy(const buffer_of<B, glm::vec4>& original);

    B& device_;
    const built_map<B>& built_;
    camera view_;
    render_settings settings_;
    view_pass_settings how_;
    render_stats& stats_;
    uint branches_; ///< combinations of Fresnel branches, a pass over the pixels each

    std::size_t stage_ = 0; ///< the next one

    // Data passed from stage to stage.
    kept_samples<B> own_samples_; ///< used unless others are given
    kept_samples<B>* kept_ = &own_samples_;
    std::optional<eye_samples<B>> samples_;
    buffer_of<B, uint> own_branches_; ///< which branches of an eye ray have light of their own (eye_rays.hpp)
    bool lit_ = false;                ///< the samples already have their direct and gathered light
    uint gathered_ = 0;               ///< rays of this eye ray's final gather that are done
    std::size_t done_ = 0;            ///< pixels that the stage has finished
    pass_radii<B> radii_;
    std::optional<interpolated_estimates<B>> search_; ///< of the eye ray that is drawn
    std::vector<knn_estimates<B>> found_;             ///< its light from the light maps before
    uint running_pictures_ = 0;
    canvas<B> canvas_;
};

// Defined outside the class: functions defined inside are implicitly inline, and `extern template` does not suppress
// them.

template <backend B>
bool view_pass<B>::trace_eye(uint ray)
{
    if (ray < branches_ && (*kept_)[ray]) {
        samples_ = std::exchange((*kept_)[ray], std::nullopt);
        lit_ = true;
        return true;
    }
    if (!samples_) {
        const auto n = canvas_.raster.size();
        samples_.emplace(eye_samples<B>{
            detail::eye_hits<B>(device_, n, canvas_.raster.first_pixel()), device_.template make<glm::vec4>(n)});
    }
    const auto trace = [&](uint r, launch pixels) {
        detail::trace_eye_rays(
            device_, built_.scene(), {view_, canvas_.raster}, {settings_, r, pixels}, samples_->hits, own_branches_);
    };
    if (own_branches_.size() == 0) {
        own_branches_ = device_.template make<uint>(canvas_.raster.size());
        // Resumed in the middle of a sample: retrace the earlier branches to learn which later ones must be traced.
        for (uint earlier = ray - ray % branches_; earlier < ray; ++earlier)
            trace(earlier, launch(canvas_.raster.size(), 0));
    }
    lit_ = false;
    return over_pixels(stats_.trace_rays, [&](launch pixels) { trace(ray, pixels); });
}

template <backend B>
bool view_pass<B>::direct_light(uint ray)
{
    if (lit_)
        return true;
    const bool drawn = settings_.output.only == light_part::all || settings_.output.only == light_part::direct;
    return over_pixels(stats_.trace_rays, [&](launch pixels) {
        if (drawn) {
            const auto with = light_settings();
            detail::direct_light(
                device_, built_.scene(), {with, ray, pixels}, samples_->hits, samples_->direct, sky_guide());
        } else {
            device_.template run<kernels::zero_vectors>(pixels, {}, reads(), writes(samples_->direct));
            device_.template run<kernels::no_light>(pixels, {}, reads(), writes(samples_->hits.emissions));
        }
        if (built_.on_rough
            && (settings_.output.only == light_part::all || settings_.output.only == light_part::caustic))
            detail::add_light_of_photons(
                device_, built_.scene(), *built_.on_rough, {settings_, ray, pixels}, radii_.share2, samples_->hits);
    });
}

template <backend B>
bool view_pass<B>::gather(uint ray)
{
    if (lit_ || !has_gather_rays(settings_))
        return true;
    const bool all_pixels = over_pixels(stats_.trace_rays, [&](launch pixels) {
        const detail::gather_ray first{{settings_, ray, pixels}, gathered_};
        const auto* guide = sky_guide();
        near_light<B> near{built_.caustics(), {}, guide};
        if (follows_paths(settings_)) {
            near.radii = radii_;
            add_path(device_, built_.scene(), near, samples_->hits, first, samples_->direct);
        } else {
            const gather_sources<B> from{built_.scene(), *built_.gather, std::move(near)};
            add_gather_rays(device_, from, samples_->hits, first, samples_->direct);
        }
    });
    if (all_pixels)
        ++gathered_;
    return gathered_ == rays_of_gather(settings_);
}

template <backend B>
bool view_pass<B>::shade(uint ray)
{
    detail::time_stage(device_, stats_.radiance_estimate, [&] {
        const float share = is_preview() ? 1.0f : 1.0f / static_cast<float>(settings_.view.spp);
        const auto found = shade(search_->take(), share, canvas_.pixels, canvas_.searches);
        if (canvas_.errors.size() > 0)
            device_.template run<kernels::tally_error>(canvas_.errors.size(), {},
                reads(samples_->hits.points, found.irradiance, found.standard_error), writes(canvas_.errors));
        shade_bias(found.biases, share);
        for (const auto& before : found_)
            shade_bias(before.biases, share);
    });
    search_.reset();
    found_.clear();
    gathered_ = 0;
    // Else what photons brought there is of this map, paths saw caustics with radii of their own, and no guide led
    // shadow rays to the sky.
    if (is_preview() && !follows_paths(settings_) && !built_.on_rough
        && !detail::number_of_environment(built_.scene().layout)) {
        (*kept_)[ray] = std::move(samples_); // the next pass may have the same pixels
        samples_.reset();
    }
    ++canvas_.rays;
    return true;
}

template <backend B>
knn_estimates<B> view_pass<B>::shade(
    knn_estimates<B> found, float share, buffer_of<B, glm::vec4>& pixels, buffer_of<B, glm::vec4>& searches)
{
    const auto& hits = samples_->hits;
    for (const auto& before : found_) {
        device_.template run<kernels::add_estimate>(
            pixels.size(), {}, reads(before.irradiance), writes(found.irradiance));
        device_.template run<kernels::tally_search>(
            pixels.size(), {}, reads(hits.points, before.irradiance, before.used), writes(searches));
        if (found.standard_error.size() > 0)
            device_.template run<kernels::add_error>(
                pixels.size(), {}, reads(before.standard_error), writes(found.standard_error));
    }
    device_.template run<kernels::shade>(pixels.size(), {.share = share},
        reads(hits.points, hits.throughputs, hits.emissions, samples_->direct, found.irradiance, found.used),
        writes(pixels, searches));
    return found;
}

template <backend B>
void view_pass<B>::shade_bias(const estimate_biases<B>& of, float share)
{
    auto& biases = canvas_.biases;
    if (biases.bias.size() > 0)
        device_.template run<kernels::shade_bias>(biases.bias.size(), {.share = share},
            reads(samples_->hits.points, samples_->hits.throughputs, of.bias, of.tilt, of.jump),
            writes(biases.bias, biases.tilt, biases.jump));
}

template <backend B>
buffer_of<B, glm::vec4> view_pass<B>::dark(std::size_t n)
{
    auto light = device_.template make<glm::vec4>(n);
    device_.template run<kernels::zero_vectors>(n, {}, reads(), writes(light));
    return light;
}

template <backend B>
buffer_of<B, glm::vec4> view_pass<B>::copy(const buffer_of<B, glm::vec4>& original)
{
    auto light = device_.template make<glm::vec4>(original.size());
    device_.template run<kernels::copy_vectors>(original.size(), {}, reads(original), writes(light));
    return light;
}

} // namespace photongrid

#include <photongrid/core/exact_end.hpp>
