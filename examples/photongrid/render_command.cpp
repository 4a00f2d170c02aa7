#include "render_command.hpp"

#include "advice.hpp"
#include "picture_series.hpp"
#include "progress_bar.hpp"
#include "resume_file.hpp"
#include "scene_notes.hpp"
#include "stats_file.hpp"
#include <photongrid/backends/any/module.hpp>
#include <photongrid/io/scene_writer.hpp>
#include <photongrid/io/setting_texts.hpp>
#include <photongrid/io/tone_map.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace photongrid {

namespace {
    /// The folder for compiled kernels; "": none.
    std::string shader_cache_folder(const render_options& o)
    {
        if (o.shader_cache)
            return *o.shader_cache == "none" ? "" : *o.shader_cache;
        if (const char* caches = std::getenv("XDG_CACHE_HOME");
            caches != nullptr && caches[0] == '/') // relative paths are invalid by its specification
            return std::string(caches) + "/photongrid";
        if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/')
            return std::string(home) + "/.cache/photongrid";
        return "";
    }

    std::string percent(double fraction) { return std::to_string(static_cast<int>(100 * fraction)) + " %"; }

    /// An unfinished picture, and the file from which it can be continued.
    class resumable {
    public:
        /// An empty path: there is no file.
        /// \throws file_error for a file of another picture.
        resumable(renderer& drawing, std::string path, const scene& s, const render_settings& settings)
            : drawing_(drawing), path_(std::move(path))
        {
            if (path_.empty())
                return;
            check_file_path(path_);
            try {
                identity_ = picture_identity(s, settings, drawing_.caps());
            } catch (const std::invalid_argument& e) {
                throw file_error(path_ + ": a picture of this scene cannot be resumed: " + e.what());
            }
            if (auto state = read_resume_file(path_, identity_))
                try {
                    drawing_.resume(std::move(*state));
                } catch (const std::invalid_argument& e) {
                    throw file_error(path_ + ": is damaged: " + e.what() + "; remove it to begin the picture anew");
                }
        }
        /// Saves the state if any work is done. Returns whether there is a file.
        bool keep()
        {
            if (path_.empty())
                return false;
            saved_ = clock::now();
            const auto state = drawing_.state();
            if (!state.empty())
                write_resume_file(path_, identity_, state);
            return std::filesystem::exists(path_);
        }
        /// Saves every half minute, so that a crash of the machine loses no more than that.
        void keep_sometimes()
        {
            if (!path_.empty() && clock::now() - saved_ > std::chrono::seconds(30))
                keep();
        }
        /// The picture is complete: removes the file. One that a stop rule ended may go on, so it is kept.
        void done(ended_by by)
        {
            if (by == ended_by::passes && !path_.empty())
                std::filesystem::remove(path_);
            else
                keep();
        }

    private:
        using clock = std::chrono::steady_clock;
        renderer& drawing_;
        std::string path_, identity_;
        clock::time_point saved_ = clock::now();
    };
} // namespace

std::string file_stem(const std::string& name)
{
    std::string stem;
    for (const char c : name) {
        const bool plain
            = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
        stem += plain ? c : '_';
    }
    return stem.empty() ? "picture" : stem;
}

renderer_options renderer_asked(const render_options& o)
{
    if (o.threads.value_or(0) > 4096)
        throw std::invalid_argument("--threads " + std::to_string(*o.threads) + ": at most 4,096; 0: all");
    return {.backend = o.backend,
        .threads = o.threads.value_or(0),
        .device = o.device,
        .shader_cache = shader_cache_folder(o),
        .time_passes = o.time_passes};
}

namespace {
    /// What the command line asks for, apart from pictures on the way.
    struct render_plan {
        render_settings settings;
        renderer_options backend;
        std::vector<std::string> outputs;
    };
    /// \throws std::invalid_argument for what cannot be done.
    render_plan plan_of(const scene& s, const render_options& o)
    {
        render_plan plan{settings_for(s, o), renderer_asked(o), o.outputs};
        if (plan.outputs.empty())
            plan.outputs.push_back(file_stem(s.name) + ".png");
        for (const auto& path : plan.outputs)
            check_image_path(path);
        if (!o.stats.empty())
            check_file_path(o.stats);
        return plan;
    }

    std::string named(const renderer_options& o)
    {
        return o.backend + (o.device.empty() ? "" : ", device " + o.device);
    }
    /// The fastest of the backends that "auto" may stand for. Says which, and why. A picture that is to be resumed is
    /// not timed: it must find the same one again.
    renderer_options fastest(const render_plan& plan, const scene& s, const render_options& o)
    {
        const auto all = candidates(plan.backend);
        auto fastest = all.front();
        if (o.backend != "auto")
            return fastest;
        std::string why = "with --resume";
        if (all.size() > 1 && o.resume.empty()) {
            why.clear();
            const auto timed = by_speed(all, s, plan.settings);
            fastest = timed.front().options;
            for (const auto& t : timed)
                why += (why.empty() ? "" : "; ") + named(t.options) + ": "
                    + (t.failure.empty() ? progress_bar::with_digits(1000 * t.pass_seconds) + " ms a pass" : t.failure);
        } else if (all.size() == 1) {
            why = any::has_module("vulkan") ? "no hardware Vulkan device" : "vulkan is not built";
            why += fastest.backend == "cpu" ? "" : ", built without cpu";
        }
        if (!o.quiet)
            std::cerr << "photongrid: --backend auto: " << named(fastest) << " (" << why << ")\n";
        return fastest;
    }

    series_options series_asked(const scene& s, const render_options& o, const render_settings& settings)
    {
        return {.folder = o.progressive,
            .stem = file_stem(s.name),
            .strip = o.strip,
            .strip_crop = o.strip_crop,
            .reference = o.reference,
            .size = {settings.output.width, settings.output.height},
            .exposure = settings.output.exposure,
            .every_ms = o.every};
    }

    /// Returns false if a stop is asked for before settings are chosen.
    bool choose_settings(renderer& drawing, progress_bar& bar, const std::function<bool()>& stop_asked)
    {
        while (is_automatic(drawing.settings()) && !stop_asked()) {
            bar.show(drawing.progress(), drawing.stats().end.error);
            drawing.step(renderer::milliseconds(0));
        }
        bar.clear();
        return !is_automatic(drawing.settings());
    }
    /// Draws until the picture is complete or a stop is asked for.
    void draw_until_done(renderer& drawing, picture_series& series, resumable& file, progress_bar& bar,
        const std::function<bool()>& stop_asked)
    {
        const renderer::milliseconds slice(series.enabled() ? 0 : 50);
        for (std::uint64_t seen = 0; !stop_asked() && !drawing.step(slice);) {
            bar.show(drawing.progress(), drawing.stats().end.error);
            if (drawing.pictures() > seen && series.due()) {
                seen = drawing.pictures();
                series.add(drawing.picture());
            }
            file.keep_sometimes();
        }
        bar.clear();
    }

    /// The settings that were chosen, as options.
    std::string as_options(const render_settings& was, const render_settings& is)
    {
        std::string all;
        const auto values = nlohmann::json::parse(settings_text(is));
        for_each_setting([&](const auto& row) {
            if constexpr (requires { row.values.automatic; })
                if (row.of(was) == row.values.automatic)
                    all += " " + option_of_setting(row.name) + " " + values[row.name].dump();
        });
        return all;
    }

    /// "12 passes, error at most 0.019 in 95 % of the pixels; another would end after --seconds; with more passes
    /// 0.01 in about 45 s"
    std::string end_of(const end_stats& end, const render_settings& settings, const render_progress& now)
    {
        const auto& o = settings.output;
        std::string all = std::to_string(end.passes) + (end.passes == 1 ? " pass" : " passes");
        if (std::isfinite(end.error))
            all += std::string(reports_bias(settings) ? ", error" : ", noise") + " at most "
                + progress_bar::with_digits(end.error) + " in " + progress_bar::with_digits(100 * o.percentile)
                + " % of the pixels";
        if (o.has_stop_rule())
            all += end.by == ended_by::error  ? "; --until-error is reached"
                : end.by == ended_by::seconds ? "; another would end after --seconds"
                                              : "; there may be no more";
        return all + progress_bar::foreseen(now, "; with more passes ");
    }

    void print_strip(const render_options& o, const picture_series& series)
    {
        std::cout << o.strip << '\n';
        if (o.quiet)
            return;
        std::cerr << "photongrid: --strip, from the left, ms:";
        for (const double ms : series.strip_times())
            std::cerr << ' ' << static_cast<long>(ms);
        std::cerr << '\n';
    }
} // namespace

exit_code run_render(const render_options& o, const std::function<bool()>& stop_asked)
{
    const auto imported = open_scene(o.scene_path, o.how, o.quiet);
    const auto& s = imported.scene;
    render_plan plan;
    std::optional<picture_series> series;
    try {
        plan = plan_of(s, o);
        series.emplace(series_asked(s, o, plan.settings));
    } catch (const std::invalid_argument& e) {
        std::cerr << "photongrid: error: on the command line: " << e.what() << '\n';
        return usage_error;
    }

    const auto start = std::chrono::steady_clock::now();
    progress_bar bar(o.quiet);
    const auto drawing = make_renderer(fastest(plan, s, o));
    drawing->start(s, plan.settings,
        {.enabled = series->enabled() || plan.settings.output.seconds > 0,
            .running_estimates = true,
            .only_first = !series->enabled()});
    if (!choose_settings(*drawing, bar, stop_asked)) {
        std::cerr << "photongrid: interrupted; there is no picture yet\n";
        return interrupted;
    }
    const auto settings = drawing->settings();
    if (is_automatic(plan.settings) && !o.quiet)
        std::cerr << "photongrid: chosen:" << as_options(plan.settings, settings) << '\n';
    resumable file(*drawing, o.resume, s, settings);
    draw_until_done(*drawing, *series, file, bar, stop_asked);
    const bool finished = drawing->finished();
    const bool kept = !finished && file.keep();
    const auto go_on = kept ? "; run the same command again to resume from " + o.resume : "";
    if (drawing->pictures() == 0) {
        std::cerr << "photongrid: interrupted; there is no picture yet" << go_on << '\n';
        return interrupted;
    }

    const auto done = drawing->progress().whole;
    const auto picture = drawing->picture();
    const double total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const bool is_png = std::any_of(plan.outputs.begin(), plan.outputs.end(),
        [](const auto& path) { return std::filesystem::path(path).extension() == ".png"; });
    for (const auto& warning : warnings(s, settings, drawing->stats(), picture, is_png))
        std::cerr << "photongrid: warning: " << warning << '\n';
    series->finish(picture);
    const double exposure = exposure_for(picture, settings.output.exposure);
    if (is_png && !settings.output.exposure && !o.quiet)
        std::cerr << "photongrid: exposure: " << exposure << " EV, fitted to the picture; --exposure sets it\n";
    for (const auto& path : plan.outputs) {
        write_image(path, picture, exposure, picture_notes(s, settings, *drawing));
        std::cout << path << '\n';
    }
    if (!o.strip.empty())
        print_strip(o, *series);
    if (!finished) {
        std::cerr << "photongrid: interrupted at " << percent(done) << "; wrote the best picture so far" << go_on
                  << '\n';
        return interrupted;
    }
    const auto& end = drawing->stats().end;
    file.done(end.by);
    if (end.passes == 0)
        std::cerr << "photongrid: warning: no pass ended within " << settings.output.seconds
                  << " s; wrote the best picture so far\n";
    else if ((settings.output.has_stop_rule() || std::isfinite(end.error)) && !o.quiet)
        std::cerr << "photongrid: " << end_of(end, settings, drawing->progress())
                  << (end.by == ended_by::passes || o.resume.empty()
                             ? ""
                             : "; a smaller error or a longer time goes on from " + o.resume)
                  << '\n';
    if (!o.stats.empty())
        write_file(o.stats, stats_json(imported, settings, *drawing, total_ms));
    return success;
}

} // namespace photongrid
