// A view of a built map, drawn pass by pass (sections 2.4 and 3.4; figure 1, right): first looks with larger pixels and
// fewer photons, then the picture itself, one eye ray a pixel after the other. No photon pass runs.
#pragma once

#include <photongrid/edge_correction.hpp>
#include <photongrid/eye_rays.hpp>
#include <photongrid/knn_grid_estimate.hpp>
#include <photongrid/render_progress.hpp>
#include <photongrid/scene_map.hpp>

#include <optional>

namespace photongrid {

/// How large its passes are.
enum class pass_size {
    largest, ///< as few as possible: nobody looks before the end
    small,   ///< of some ms on a CPU: somebody watches, or may give up
};

namespace detail {
    /// What to ask the photon map.
    inline knn_settings estimate_settings(const render_settings& s, float min_radius)
    {
        knn_settings k;
        k.k = s.k;
        k.max_radius = s.only == light_part::direct ? 0.0f : static_cast<float>(s.max_radius);
        k.search = s.search;
        k.kernel = s.kernel;
        k.bias = s.bias;
        k.leaks = s.leaks;
        k.errors = s.aov;
        k.min_radius = min_radius;
        return k;
    }

    /// Pixels as an image of the whole size. Squares are spread out; between their middles values are interpolated as v
    /// / (1 + v) of what the exposure leaves, so that a lamp does not shine on its neighbours. Pixels that are NaN or
    /// infinite become 0 and are counted.
    inline image to_image(const std::vector<glm::vec4>& pixels, const raster& r, const render_settings& s, float scale,
        std::uint64_t& invalid)
    {
        image out;
        out.width = s.width;
        out.height = s.height;
        out.pixels.reserve(std::size_t{s.width} * s.height);
        invalid = 0;
        std::vector<glm::vec3> good;
        good.reserve(pixels.size());
        for (const auto& p : pixels) {
            const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            invalid += finite ? 0u : 1u;
            good.push_back(finite ? glm::vec3(p) * scale : glm::vec3(0));
        }
        if (r.divisor == 1) {
            out.pixels = std::move(good);
            return out;
        }
        struct neighbours {
            uint low, high;
            float share; ///< of the higher one
        };
        const auto between = [&](uint pixel, uint count) {
            const float at = std::max(0.0f, (static_cast<float>(pixel) + 0.5f) / static_cast<float>(r.divisor) - 0.5f);
            const uint low = std::min(static_cast<uint>(at), count - 1);
            return neighbours{low, std::min(low + 1, count - 1), at - static_cast<float>(low)};
        };
        std::vector<neighbours> columns;
        for (uint x = 0; x < s.width; ++x)
            columns.push_back(between(x, r.width));
        const float exposure = static_cast<float>(std::exp2(s.exposure));
        for (auto& p : good)
            p = glm::min(p / (1.0f + p * exposure), 0.999999f / exposure);
        for (uint y = 0; y < s.height; ++y) {
            const auto row = between(y, r.height);
            const auto* above = &good[std::size_t{row.low} * r.width];
            const auto* below = &good[std::size_t{row.high} * r.width];
            for (const auto& c : columns) {
                const auto p = glm::mix(glm::mix(above[c.low], above[c.high], c.share),
                    glm::mix(below[c.low], below[c.high], c.share), row.share);
                out.pixels.push_back(p / (1.0f - p * exposure));
            }
        }
        return out;
    }
} // namespace detail

/// A picture of a built map that comes about pass by pass. Its last bytes do not depend on looks, on sizes of passes,
/// or on when it was looked at.
template <backend B>
class progressive_view {
public:
    /// Draws nothing yet. `built` and `stats`, where times go, must outlive it.
    /// \throws std::invalid_argument for a camera or settings that check() refuses, or a look with a 0.
    progressive_view(B& b, const built_map<B>& built, const camera& view, const render_settings& settings,
        render_stats& stats, std::vector<first_look> looks = {}, pass_size size = pass_size::largest)
        : b_(b), built_(built), view_(view), settings_(settings), stats_(stats), looks_(std::move(looks)), size_(size),
          branches_(1u << detail::branchings_of(built.scene.about))
    {
        check(settings);
        check(view);
        for (const auto& l : looks_)
            if (l.divisor < 1 || l.fewer < 1)
                throw std::invalid_argument("progressive_view: looks: divisor and fewer must be at least 1");
        kept_.resize(branches_);
    }
    progressive_view(const progressive_view&) = delete;
    progressive_view& operator=(const progressive_view&) = delete;

    /// True when picture() is the picture.
    bool finished() const { return look_ > looks_.size(); }
    /// Roughly, of the picture's work, looks apart, what is done: 0 to 1.
    double fraction() const
    {
        if (finished() || looking())
            return finished() ? 1.0 : 0.0;
        const double pixels = static_cast<double>(settings_.width) * settings_.height;
        const double of_this_ray = search_ ? 1.0 - static_cast<double>(unfinished_) / pixels : 0.0;
        return (ray_ + of_this_ray) / (static_cast<double>(settings_.spp) * branches_);
    }
    /// Pixels of the look or ray in flight whose estimates are not done.
    std::uint64_t unfinished() const { return unfinished_; }
    /// How many pictures there have been so far, each better than the last; 0: picture() has nothing to show.
    std::uint64_t pictures() const { return pictures_; }
    /// True while first looks are drawn.
    bool looking() const { return look_ < looks_.size(); }
    /// What is drawn now: the side of its pixels, in the picture's.
    uint divisor() const { return looking() ? looks_[look_].divisor : 1u; }

    /// Runs the next pass.
    /// \throws backend_error.
    void advance()
    {
        if (finished())
            return;
        if (search_)
            advance_search();
        else
            advance_rays();
    }

    /// The best picture so far, in the whole size. NaN and infinite pixels are 0. Of the finished picture they are
    /// counted, as are its searches and the map's photons: only then are the statistics whole.
    /// \throws std::logic_error when there is none yet, backend_error.
    image picture()
    {
        if (pictures_ == 0)
            throw std::logic_error("progressive_view::picture: there is none yet; see pictures()");
        std::uint64_t invalid = 0;
        if (shows_running_estimate()) {
            auto running = copy(canvas_->pixels);
            auto ignored = b_.template make<glm::vec4>(running.size());
            shade(search_->estimates(), 1.0f / static_cast<float>(settings_.spp), running, ignored);
            return detail::to_image(
                b_.download(running), canvas_->raster, settings_, static_cast<float>(settings_.spp), invalid);
        }
        image im = detail::to_image(b_.download(shown_->pixels), shown_->raster, settings_, shown_->scale, invalid);
        if (!finished())
            return im;
        account();
        stats_.invalid_pixels = invalid;
        if (settings_.aov) {
            const auto tallies = b_.download(shown_->searches), errors = b_.download(shown_->errors);
            for (std::size_t i = 0; i < im.pixels.size(); ++i) {
                const float mean = tallies[i].w > 0 ? 1.0f / tallies[i].w : 0.0f; // per search
                im.layers.radius.push_back(tallies[i].y * mean);
                im.layers.count.push_back(tallies[i].x * mean);
                im.layers.relative_error.push_back(errors[i].x * mean);
            }
        }
        return im;
    }

    /// What the picture has so far, looks apart.
    view_state state()
    {
        if (finished())
            return {settings_.spp * branches_, b_.download(shown_->pixels), b_.download(shown_->searches),
                b_.download(shown_->errors)};
        if (looking() || !canvas_)
            return {};
        return {ray_, b_.download(canvas_->pixels), b_.download(canvas_->searches), b_.download(canvas_->errors)};
    }
    /// Goes on from a state of the same map, view and settings: the picture ends with the same bytes.
    /// \throws std::invalid_argument for a state of another size.
    void resume(const view_state& s)
    {
        const auto n = detail::raster_of(settings_, 1).size();
        if (s.rays == 0)
            return;
        if (s.rays > settings_.spp * branches_ || s.pixels.size() != n || s.searches.size() != n
            || s.errors.size() != (settings_.aov ? n : 0))
            throw std::invalid_argument(
                "progressive_view::resume: state: is of another picture: " + std::to_string(s.pixels.size())
                + " pixels and " + std::to_string(s.rays) + " rays a pixel; this one has " + std::to_string(n) + " and "
                + std::to_string(settings_.spp * branches_));
        search_.reset();
        current_.reset();
        traced_ = 0;
        look_ = looks_.size();
        ray_ = s.rays;
        canvas_.emplace(canvas{
            detail::raster_of(settings_, 1), upload(b_, s.pixels), upload(b_, s.searches), upload(b_, s.errors)});
        if (ray_ % branches_ == 0)
            show_samples();
    }

private:
    struct canvas {
        detail::raster raster;
        buffer_of<B, glm::vec4> pixels, searches, errors;
        float scale = 1; ///< of the pixels, for what is not in them yet
    };
    struct traced_ray {
        detail::eye_hits<B> hits;
        buffer_of<B, glm::vec4> direct;
    };

    /// The picture's own search, looks apart.
    knn_settings search_settings() const
    {
        return detail::estimate_settings(settings_, least_radius(built_.map.cells_of));
    }
    /// Where light is added up while a search runs, who looks can look at it (3.4).
    bool grows() const
    {
        return !looking() && !looks_.empty() && knn_search<B>::shows_running_estimate(search_settings());
    }
    /// The first sample's other ways through the scene must be there already.
    bool shows_running_estimate() const { return search_ && grows() && grown_ > 0 && ray_ + 1 == branches_; }

    buffer_of<B, glm::vec4> dark(std::size_t n)
    {
        auto light = b_.template make<glm::vec4>(n);
        b_.template run<kernels::no_light>(n, {}, reads(), writes(light));
        return light;
    }
    buffer_of<B, glm::vec4> copy(const buffer_of<B, glm::vec4>& original)
    {
        auto light = b_.template make<glm::vec4>(original.size());
        b_.template run<kernels::copy_light>(original.size(), {}, reads(original), writes(light));
        return light;
    }

    /// The next part of the picture's eye rays, and their direct light; behind the last part, the search is made.
    void advance_rays()
    {
        detail::stage_clock<B> clock(b_, stats_.trace_rays);
        const auto r = detail::raster_of(settings_, divisor());
        const std::size_t n = r.size();
        if (!canvas_)
            canvas_.emplace(canvas{r, dark(n), dark(n), dark(!looking() && settings_.aov ? n : 0)});
        if (ray_ < branches_ && kept_[ray_]) {
            current_ = std::move(kept_[ray_]);
            kept_[ray_].reset();
            traced_ = n;
        }
        if (!current_)
            current_.emplace(traced_ray{detail::eye_hits<B>(b_, n), b_.template make<glm::vec4>(n)});
        if (traced_ < n) {
            const launch pixels(size_ == pass_size::small ? std::min<std::size_t>(n - traced_, 65536) : n - traced_,
                static_cast<uint>(traced_));
            detail::trace_eye_rays(b_, built_.scene, view_, settings_, r, ray_, pixels, current_->hits);
            if (settings_.only == light_part::all || settings_.only == light_part::direct) {
                detail::direct_light(
                    b_, built_.scene, current_->hits, light_settings(), ray_, pixels, current_->direct);
            } else {
                b_.template run<kernels::no_light>(pixels, {}, reads(), writes(current_->direct));
                b_.template run<kernels::no_light>(pixels, {}, reads(), writes(current_->hits.emissions));
            }
            traced_ += pixels.elements;
        }
        if (traced_ == n)
            start_search();
        clock.stop();
    }

    /// Fewer shadow rays where pixels are large.
    render_settings light_settings() const
    {
        render_settings s = settings_;
        if (divisor() > 1)
            s.light_samples = std::max(1u, s.light_samples / 4);
        return s;
    }

    knn_settings wanted() const
    {
        knn_settings k = search_settings();
        if (looking()) {
            k.k = std::min(k.k, std::max(8u, k.k / looks_[look_].fewer));
            k.errors = false;
            if (k.search == search_kind::exact_k)
                k.bias = bias_kind::unbiased; // the paper's reads k / (k - 1) too high, which few photons would show
        } else if (grows()) {
            k.visits_per_pass = 256;
            k.ranges_per_pass = 64;
        }
        return k;
    }

    void start_search()
    {
        traced_ = 0;
        grown_ = 0;
        unfinished_ = current_->direct.size();
        search_.emplace(b_, built_.map, current_->hits.points, current_->hits.surfaces, wanted());
    }

    void advance_search()
    {
        detail::stage_clock<B> clock(b_, stats_.radiance_estimate);
        const uint passes = size_ == pass_size::largest ? nowhere : grows() ? std::max(1u, grown_) : 8u;
        const auto did = search_->advance(passes);
        const bool whole = did.finished;
        if (whole)
            unfinished_ = 0;
        else if (!did.active.empty())
            unfinished_ = did.active.back();
        if (grows()) { // pictures after 1, 2, 4, 8, … passes
            grown_ += passes;
            pictures_ += !whole && shows_running_estimate() ? 1u : 0u;
        }
        if (whole)
            end_search();
        clock.stop();
    }

    void end_search()
    {
        const auto found = shade(std::move(*search_).estimates(),
            looking() ? 1.0f : 1.0f / static_cast<float>(settings_.spp), canvas_->pixels, canvas_->searches);
        if (canvas_->errors.size() > 0)
            b_.template run<kernels::tally_error>(canvas_->errors.size(), {},
                reads(current_->hits.points, found.irradiance, found.standard_error), writes(canvas_->errors));
        search_.reset();
        if (looking() && (look_ + 1 < looks_.size() ? looks_[look_ + 1].divisor : 1u) == divisor())
            kept_[ray_] = std::move(current_); // the next look sees the same points
        current_.reset();
        ++ray_;
        if (ray_ % branches_ == 0)
            show_samples();
    }

    knn_estimates<B> shade(
        knn_estimates<B> found, float share, buffer_of<B, glm::vec4>& pixels, buffer_of<B, glm::vec4>& searches)
    {
        const auto& hits = current_->hits;
        if (settings_.edges != edge_correction::none)
            correct_edges(b_, built_.scene, hits.points, hits.surfaces, found, settings_.kernel,
                least_radius(built_.map.cells_of));
        b_.template run<kernels::shade>(pixels.size(), {.scene_layout = built_.scene.about.layout, .share = share},
            reads(built_.scene.records, hits.points, hits.weights, hits.surfaces, hits.emissions, current_->direct,
                found.irradiance, found.used),
            writes(pixels, searches));
        return found;
    }

    /// All ways of a sample are in the canvas: there is a new picture.
    void show_samples()
    {
        ++pictures_;
        const uint samples = ray_ / branches_;
        if (looking() || samples == settings_.spp) {
            shown_ = std::move(canvas_);
            canvas_.reset();
            ray_ = 0;
            ++look_;
        } else {
            shown_.emplace(canvas{canvas_->raster, copy(canvas_->pixels), {}, {},
                static_cast<float>(settings_.spp) / static_cast<float>(samples)});
        }
    }

    /// All passes have run: what is read back now disturbs none.
    void account()
    {
        const double searched = static_cast<double>(shown_->pixels.size()) * settings_.spp * branches_;
        glm::dvec4 sum(0);
        for (const auto& p : b_.download(shown_->searches))
            sum += glm::dvec4(p);
        if (!(sum.w >= 0) || !(sum.w <= searched))
            throw backend_error(b_.caps().backend + ": shade: the device says that " + std::to_string(sum.w)
                + " points were searched for; there are " + std::to_string(searched));
        stats_.estimate.points = static_cast<std::uint64_t>(sum.w);
        const double points = std::max(sum.w, 1.0);
        stats_.estimate.mean_count = sum.x / points;
        stats_.estimate.mean_radius = sum.y / points;
        stats_.estimate.mean_visited = sum.z / points;
        stats_.photons = count_photons(b_, built_.trace, built_.map.photons.size());
        stats_.map = built_.about;
        if (built_.about.builder == map_builder::route)
            stats_.map.redistributed_flux = redistributed_flux(b_, built_.map);
        stats_.peak_device_bytes = b_.peak_bytes();
    }

    B& b_;
    const built_map<B>& built_;
    camera view_;
    render_settings settings_;
    render_stats& stats_;
    std::vector<first_look> looks_;
    pass_size size_;
    uint branches_;

    std::size_t look_ = 0;         ///< past the looks: the picture; past that: finished
    uint ray_ = 0;                 ///< of this look: sample x branches + way through the glass
    std::size_t traced_ = 0;       ///< pixels whose eye rays are traced
    std::uint64_t unfinished_ = 0; ///< pixels that the search in flight is not done with
    uint grown_ = 0;               ///< passes of a growing search
    std::uint64_t pictures_ = 0;
    std::optional<traced_ray> current_;
    std::vector<std::optional<traced_ray>> kept_; ///< for the next look: the first sample's, one a way
    std::optional<knn_search<B>> search_;
    std::optional<canvas> canvas_; ///< what is being drawn
    std::optional<canvas> shown_;
};

} // namespace photongrid
