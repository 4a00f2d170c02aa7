#include <photongrid/backends/any/any.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace photongrid {

namespace {
    /// The picture with `share` of its pixels and photons, and with no more passes than are timed.
    render_settings smaller(render_settings s, double share)
    {
        const auto scaled = [](std::uint32_t& n, double by) {
            n = std::min(n, std::max(static_cast<std::uint32_t>(std::lround(n * by)), 1u));
        };
        scaled(s.output.width, std::sqrt(share));
        scaled(s.output.height, std::sqrt(share));
        scaled(s.map.photons, share);
        scaled(s.map.caustic_photons, share);
        s.output.passes = std::min(s.output.passes_at_most(), 2u);
        s.output.until_error = s.output.seconds = 0;
        s.output.report_bias = reports_bias(s) ? bias_report::yes : bias_report::no;
        return s;
    }

    /// Draws a picture. Returns the seconds of one of its passes, without those of preparing the scene.
    double seconds_of_pass(renderer& device, const scene& s, const render_settings& settings)
    {
        using clock = std::chrono::steady_clock;
        device.start(s, settings, {.enabled = false});
        auto begin = clock::now();
        while (!device.step(renderer::milliseconds(0)))
            if (device.progress().stage == "prepare_scene")
                begin = clock::now();
        return std::chrono::duration<double>(clock::now() - begin).count() / settings.output.passes;
    }
} // namespace

std::vector<timed_backend> by_speed(
    std::span<const renderer_options> backends, const scene& s, const render_settings& settings)
{
    std::vector<timed_backend> all;
    for (const auto& options : backends)
        all.push_back({.options = options});
    auto chosen = settings;
    for (auto b = all.rbegin(); b != all.rend(); ++b) // the last needs no compilation to choose settings
        try {
            const auto device = make_renderer(b->options);
            if (is_automatic(chosen))
                chosen = chosen_settings(*device, s, chosen);
            const auto quarter = smaller(chosen, 1.0 / 4);
            seconds_of_pass(*device, s, quarter); // with compilation
            const double least = seconds_of_pass(*device, s, smaller(chosen, 1.0 / 16)),
                         more = seconds_of_pass(*device, s, quarter);
            b->pass_seconds = std::max(least + 5 * (more - least), more);
        } catch (const backend_error& e) {
            b->failure = e.what();
        }
    std::stable_sort(
        all.begin(), all.end(), [](const auto& a, const auto& b) { return a.pass_seconds < b.pass_seconds; });
    return all;
}

} // namespace photongrid
