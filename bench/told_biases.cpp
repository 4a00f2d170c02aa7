// Whether the noise and the bias that pictures tell of their pixels cover the true error: against the mean of many
// passes of another seed, whose radii are much smaller; the noise of that mean counts with the pixels' own. Prints a
// table: the share of the pixels whose true error is within 2 (noise + |bias|), the same with the noise alone, the
// error that picture_error claims of 95 % of them, the one that they have, and means over the picture, as parts of its
// mean light: of the true difference, and of noise and |bias|.
//
//   told_biases SIZE TRUTH_PASSES PASSES... -- SCENE...
//
//   told_biases 96 3000 4 16 64 -- examples/scenes/cornell_blocks.json
//
// Draws each scene with its own settings, but k = 50 and one eye ray per pass, with radii per pass and shrinking ones.
// The truth has k = 6 and shrinking radii.
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

film drawn(renderer& drawing, const scene& s, const render_settings& settings)
{
    drawing.start(s, settings, {.enabled = false});
    drawing.step();
    return drawing.state().film;
}

struct pixel {
    double mean, noise, bias;
};
std::vector<pixel> pixels_of(const film& f)
{
    std::vector<pixel> all;
    f.visit_spread([&](double mean, double error) { all.push_back({mean, error, std::abs(f.bias_of(all.size()))}); });
    return all;
}

void measure(renderer& drawing, const std::string& path, std::uint32_t size, std::uint32_t truth_passes,
    const std::vector<std::uint32_t>& passes)
{
    const auto s = read_scene(path);
    auto settings = s.render;
    settings.output.width = settings.output.height = size;
    settings.output.until_error = settings.output.seconds = 0;
    settings.view.spp = 1;
    auto exact = settings;
    exact.seed = 1000;
    exact.estimate.k = 6;
    exact.estimate.radii = radius_kind::shrinking;
    exact.output.passes = truth_passes;
    const auto truth = pixels_of(drawn(drawing, s, exact));
    std::vector<std::size_t> noisy;
    double light = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        if (detail::is_noisy(truth[i].mean, truth[i].noise)) {
            noisy.push_back(i);
            light += truth[i].mean;
        }
    const double n = static_cast<double>(noisy.size()), dark = detail::dark_share * light / n;
    settings.estimate.k = 50;
    settings.output.tell_bias = bias_telling::yes;
    for (const auto radii : {radius_kind::per_pass, radius_kind::shrinking})
        for (const auto p : passes) {
            settings.estimate.radii = radii;
            settings.output.passes = p;
            const auto f = drawn(drawing, s, settings);
            const auto found = pixels_of(f);
            double covered = 0, by_noise = 0, difference = 0, noise = 0, bias = 0;
            std::vector<double> errors;
            for (const auto i : noisy) {
                const double error = std::abs(found[i].mean - truth[i].mean),
                             of_both = std::hypot(found[i].noise, truth[i].noise);
                covered += error <= 2 * (of_both + found[i].bias) ? 1 : 0;
                by_noise += error <= 2 * of_both ? 1 : 0;
                difference += found[i].mean - truth[i].mean;
                noise += found[i].noise;
                bias += found[i].bias;
                errors.push_back(error / (truth[i].mean + dark));
            }
            std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(0.95 * n), errors.end());
            std::printf("| %s | %s | %u | %.3f | %.3f | %.4f | %.4f | %+.4f | %.4f | %.4f |\n",
                std::filesystem::path(path).stem().c_str(), radii == radius_kind::per_pass ? "per pass" : "shrinking",
                p, covered / n, by_noise / n, picture_error(f, 0.95), errors[static_cast<std::size_t>(0.95 * n)],
                difference / light, noise / light, bias / light);
            std::fflush(stdout);
        }
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::uint32_t> passes;
    int at = 3;
    for (; at < argc && std::strcmp(argv[at], "--") != 0; ++at)
        passes.push_back(static_cast<std::uint32_t>(std::atoi(argv[at])));
    if (passes.empty() || at + 1 >= argc) {
        std::fprintf(stderr, "told_biases SIZE TRUTH_PASSES PASSES... -- SCENE...\n");
        return 2;
    }
    const auto count = [&](int i) { return static_cast<std::uint32_t>(std::atoi(argv[i])); };
    const auto drawing = make_renderer(chosen({.backend = "cpu"}));
    std::printf(
        "| scene | radii | passes | within 2 (noise + bias) | within 2 noise | 95 %% claimed | true | difference "
        "of the mean | noise | bias |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (++at; at < argc; ++at)
        measure(*drawing, argv[at], count(1), count(2), passes);
    return 0;
}
