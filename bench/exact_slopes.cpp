// How fast the error of exact pictures (as_exact) falls with passes and with time: in two scenes whose light is known,
// or in scenes from files against the reference renderer. relMSE of the pixels in which caustics are at least a tenth
// of the light, and of those in which they are less than a thousandth; the reference's own noise is subtracted. Prints
// the errors after 1, 2, 4 ... passes, the mean of several seeds, and the slopes of their logarithms over the last
// three decades and the last one. One eye ray, shadow ray and path per pixel and pass.
//
//   exact_slopes PASSES SEEDS [SIZE EYE_PATHS LIGHT_PATHS SCENE...]
//
//   EYE_PATHS, LIGHT_PATHS: of the reference, per pixel and in all
//
//   exact_slopes 8192 8
//   exact_slopes 1024 2 48x36 65536 1e9 examples/scenes/cornell_box.json
#include "known_light.hpp"

#include <photongrid/backends/any/any.hpp>
#include <photongrid/io/scene_file.hpp>
#include <photongrid/reference/reference.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

namespace {

using namespace photongrid;

struct row {
    double passes = 0, seconds = 0, caustics = 0, others = 0;
};

double relative(double difference, double known) { return difference / (known + 0.01); }

/// The pixels in which caustics are at least `least` and less than `most` of the light.
std::vector<std::size_t> pixels_with(const image& caustics, const image& all, double least, double most)
{
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < all.pixels.size(); ++i) {
        const auto light = [&](const image& im) { return double{im.pixels[i].x + im.pixels[i].y + im.pixels[i].z}; };
        if (light(caustics) >= least * light(all) && light(caustics) < most * light(all))
            found.push_back(i);
    }
    return found;
}

/// relMSE of some pixels, less the reference's own.
double error_of(const image& drawn, const reference_picture& known, const std::vector<std::size_t>& pixels)
{
    double sum = 0;
    for (const auto i : pixels)
        for (int c = 0; c < 3; ++c) {
            const double right{known.mean.pixels[i][c]}, own{known.standard_error.pixels[i][c]};
            sum += std::pow(relative(double{drawn.pixels[i][c]} - right, right), 2) - std::pow(relative(own, right), 2);
        }
    return sum / (3.0 * static_cast<double>(pixels.size()));
}

double slope(const std::vector<row>& rows, double row::*x, double row::*y, double from)
{
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& r : rows)
        if (r.*x >= from && r.*y > 0) {
            const double a = std::log(r.*x), b = std::log(r.*y);
            ++n, sx += a, sy += b, sxx += a * a, sxy += a * b;
        }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Draws up to so many passes, and adds the errors after 1, 2, 4 ... of them.
void add_errors(renderer& drawing, const scene& s, const render_settings& settings, const reference_picture& known,
    const std::vector<std::size_t>& bright, const std::vector<std::size_t>& dark, std::vector<row>& rows, double seeds)
{
    drawing.start(s, settings, {.enabled = false});
    for (auto& r : rows) {
        while (drawing.progress().passes < static_cast<std::uint32_t>(r.passes))
            drawing.step(renderer::milliseconds(0));
        const auto drawn = drawing.picture();
        r.seconds += drawing.state().seconds / seeds;
        r.caustics += error_of(drawn, known, bright) / seeds;
        r.others += error_of(drawn, known, dark) / seeds;
    }
}

void measure(renderer& drawing, const scene& s, render_settings settings, const reference_picture& known,
    const std::vector<std::size_t>& bright, const std::vector<std::size_t>& dark, std::uint32_t seeds)
{
    std::vector<row> rows;
    for (std::uint32_t passes = 1; passes <= settings.output.passes; passes *= 2)
        rows.push_back({static_cast<double>(passes), 0, 0, 0});
    for (settings.seed = 1; settings.seed <= seeds; ++settings.seed)
        add_errors(drawing, s, settings, known, bright, dark, rows, seeds);
    std::printf("%s, %zu pixels with caustics, %zu without\n\n", s.name.c_str(), bright.size(), dark.size());
    const auto cell = [](bool has_pixels, const char* format, double value) {
        std::printf(" ");
        std::printf(has_pixels ? format : "-", value);
        std::printf(" |");
    };
    const auto cells = [&](const char* format, double with, double without) {
        cell(!bright.empty(), format, with);
        cell(!dark.empty(), format, without);
        std::printf("\n");
    };
    std::printf("| passes | seconds | relMSE with caustics | without |\n|---|---|---|---|\n");
    for (const auto& r : rows) {
        std::printf("| %.0f | %.3f |", r.passes, r.seconds);
        cells("%.3g", r.caustics, r.others);
    }
    for (const int decades : {3, 1}) {
        const auto slopes = [&](const char* by, double row::*x) {
            const double from = rows.back().*x / std::pow(10, decades);
            std::printf("| slope over the last %s, by %s | |", decades == 1 ? "decade" : "three decades", by);
            cells("%.2f", slope(rows, x, &row::caustics, from), slope(rows, x, &row::others, from));
        };
        slopes("passes", &row::passes);
        slopes("seconds", &row::seconds);
    }
    std::printf("\n");
    std::fflush(stdout);
}

std::vector<std::size_t> all_pixels(const image& im)
{
    std::vector<std::size_t> all(im.pixels.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

void measure_known(renderer& drawing, known_scene k, std::uint32_t passes, std::uint32_t seeds)
{
    k.s.render.output.passes = passes;
    reference_picture known;
    known.mean = k.light;
    known.standard_error = {k.light.width, k.light.height, std::vector<glm::vec3>(k.light.pixels.size())};
    const auto all = all_pixels(k.light);
    const bool is_caustic = k.s.render.output.only == light_part::caustic;
    measure(drawing, k.s, k.s.render, known, is_caustic ? all : std::vector<std::size_t>{},
        is_caustic ? std::vector<std::size_t>{} : all, seeds);
}

void measure_file(renderer& drawing, const std::string& path, char** arguments)
{
    const auto s = read_scene(path);
    unsigned width = 0, height = 0;
    if (std::sscanf(arguments[2], "%ux%u", &width, &height) != 2)
        throw std::invalid_argument("SIZE: must be WIDTHxHEIGHT");
    const auto count = [&](int i) { return static_cast<std::uint32_t>(std::atof(arguments[i])); };
    auto settings = cheap_exact(s.render);
    settings.output.width = width;
    settings.output.height = height;
    settings.output.passes = count(0);
    settings.output.until_error = settings.output.seconds = 0;

    auto fine = reference_settings_for(settings);
    fine.spp = count(3);
    fine.paths = static_cast<std::uint64_t>(std::atof(arguments[4]));
    fine.seed = 99;
    const auto known = render_reference(s, s.camera, fine);
    auto only = settings;
    only.output.only = light_part::caustic;
    only.output.passes = 64;
    drawing.start(s, only, {.enabled = false});
    drawing.step();
    const auto caustics = drawing.picture();
    measure(drawing, s, settings, known, pixels_with(caustics, known.mean, 0.1, 1e30),
        pixels_with(caustics, known.mean, -1, 1e-3), count(1));
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 3 && argc < 7) {
        std::fprintf(stderr, "exact_slopes PASSES SEEDS [SIZE EYE_PATHS LIGHT_PATHS SCENE...]\n");
        return 2;
    }
    const auto drawing = make_renderer(chosen({.backend = "cpu"}));
    const auto count = [&](int i) { return static_cast<std::uint32_t>(std::atoi(argv[i])); };
    if (argc == 3) {
        measure_known(*drawing, second_bulb_in_a_mirror(), count(1), count(2));
        measure_known(*drawing, floor_before_a_sunlit_wall(), count(1), count(2));
    }
    for (int i = 6; i < argc; ++i)
        measure_file(*drawing, argv[i], argv + 1);
    return 0;
}
