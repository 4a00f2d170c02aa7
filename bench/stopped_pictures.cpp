// Whether pictures that --until-error ends have the error that they claim: against the mean of many exact passes
// (as_exact) of another seed, which has next to no blur. Prints a table: the error asked for, passes, the error
// claimed, the true one of the same percentile and their ratio, each the mean of several seeds; the percentile of the
// pixels' standard errors, which would be the plainer claim; and that of the standard errors of the exact passes, which
// are part of the true error.
//
//   stopped_pictures SIZE EXACT_PASSES SEEDS [--exact] ERROR... -- SCENE...
//
//   --exact: the pictures themselves are exact, too
//   SCENE:   a file, or `second_bulb` or `sunlit_wall`: exact pictures of 16 x 16 pixels whose light is known
//
//   stopped_pictures 128 8000 1 0.05 0.02 -- examples/scenes/cornell_blocks.json
//   stopped_pictures 16 1 4 0.02 0.01 -- second_bulb sunlit_wall
#include "known_light.hpp"

#include <photongrid/backends/any/any.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/render/picture_error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace photongrid;

double percentile_of(std::vector<double> values, double share)
{
    if (values.empty())
        return 0;
    const auto at = std::min(static_cast<std::size_t>(share * static_cast<double>(values.size())), values.size() - 1);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

struct pixel {
    double mean, standard_error;
};
std::vector<pixel> pixels_of(const film& f)
{
    std::vector<pixel> all;
    f.visit_spread([&](double mean, double error) { all.push_back({mean, error}); });
    return all;
}

/// The pixels that have noise, in the mean of many passes.
struct converged {
    std::vector<pixel> pixels;
    std::vector<std::size_t> noisy;
    double dark = 0;

    explicit converged(const film& f) : pixels(pixels_of(f))
    {
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (detail::is_noisy(pixels[i].mean, pixels[i].standard_error))
                noisy.push_back(i);
        find_dark();
    }
    explicit converged(const image& light)
    {
        for (const auto& p : light.pixels) {
            noisy.push_back(pixels.size());
            pixels.push_back({static_cast<double>(p.x + p.y + p.z) / 3, 0});
        }
        find_dark();
    }
    void find_dark()
    {
        for (const auto i : noisy)
            dark += pixels[i].mean * detail::dark_share / static_cast<double>(noisy.size());
    }
    double error_of(const film& f, double share) const
    {
        const auto drawn = pixels_of(f);
        std::vector<double> errors;
        for (const auto i : noisy)
            errors.push_back(std::abs(drawn[i].mean - pixels[i].mean) / (pixels[i].mean + dark));
        return percentile_of(errors, share);
    }
    double standard_error_of(const film& f, double share) const { return standard_error_of(pixels_of(f), share); }
    double standard_error_of(const std::vector<pixel>& drawn, double share) const
    {
        std::vector<double> errors;
        for (const auto i : noisy)
            errors.push_back(drawn[i].standard_error / (drawn[i].mean + dark));
        return percentile_of(errors, share);
    }
};

void measure(renderer& drawing, const scene& s, const std::string& name, const converged& truth,
    render_settings settings, std::uint32_t seeds, const std::vector<double>& bounds)
{
    struct row {
        double passes = 0, claimed = 0, actual = 0, plain = 0;
    };
    std::vector<row> rows(bounds.size());
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        render_state state;
        for (std::size_t b = 0; b < bounds.size(); ++b) { // from large to small
            settings.seed = seed;
            settings.output.until_error = bounds[b];
            drawing.start(s, settings, {.enabled = false});
            if (!state.empty())
                drawing.resume(state);
            drawing.step();
            state = drawing.state();
            const auto& end = drawing.stats().end;
            rows[b].passes += end.passes / static_cast<double>(seeds);
            rows[b].claimed += end.error / seeds;
            rows[b].actual += truth.error_of(state.film, settings.output.percentile) / seeds;
            rows[b].plain += truth.standard_error_of(state.film, settings.output.percentile) / seeds;
        }
    }
    for (std::size_t b = 0; b < bounds.size(); ++b) {
        const auto& r = rows[b];
        std::printf("| %s | %g | %.0f | %.4f | %.4f | %.2f | %.4f | %.4f |\n", name.c_str(), bounds[b], r.passes,
            r.claimed, r.actual, r.actual / r.claimed, r.plain,
            truth.standard_error_of(truth.pixels, settings.output.percentile));
    }
    std::fflush(stdout);
}

void measure_file(renderer& drawing, const std::string& path, std::uint32_t size, std::uint32_t passes,
    std::uint32_t seeds, bool is_exact, const std::vector<double>& bounds)
{
    const auto s = read_scene(path);
    auto settings = s.render;
    settings.output.width = settings.output.height = size;
    settings.output.passes = 1; // the error ends them, not the scene's number
    auto many = cheap_exact(settings);
    if (is_exact)
        settings = many;
    many.seed = 1000;
    many.output.passes = passes;
    drawing.start(s, many, {.enabled = false});
    drawing.step();
    const converged truth(drawing.state().film);
    measure(drawing, s, std::filesystem::path(path).stem().string(), truth, settings, seeds, bounds);
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<double> bounds;
    const bool is_exact = argc > 4 && std::strcmp(argv[4], "--exact") == 0;
    int at = is_exact ? 5 : 4;
    for (; at < argc && std::strcmp(argv[at], "--") != 0; ++at)
        bounds.push_back(std::atof(argv[at]));
    if (bounds.empty() || at + 1 >= argc) {
        std::fprintf(stderr, "stopped_pictures SIZE EXACT_PASSES SEEDS [--exact] ERROR... -- SCENE...\n");
        return 2;
    }
    std::sort(bounds.rbegin(), bounds.rend());
    const auto count = [&](int i) { return static_cast<std::uint32_t>(std::atoi(argv[i])); };
    const auto drawing = make_renderer(chosen({.backend = "cpu"}));
    std::printf("| scene | asked for | passes | claimed | true | true / claimed | percentile of standard errors "
                "| of the exact passes |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (++at; at < argc; ++at) {
        const std::string name = argv[at];
        if (name == "second_bulb" || name == "sunlit_wall") {
            const auto k = name == "second_bulb" ? second_bulb_in_a_mirror() : floor_before_a_sunlit_wall();
            measure(*drawing, k.s, name, converged(k.light), k.s.render, count(3), bounds);
        } else {
            measure_file(*drawing, name, count(1), count(2), count(3), is_exact, bounds);
        }
    }
    return 0;
}
