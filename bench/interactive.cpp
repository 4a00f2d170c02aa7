// How soon a change is seen (section 3.4): the Cornell box with the paper's settings, camera and lamp moved again and
// again, in the loop that the window and the program use. Exit status 1 when a row misses its target:
// docs/reference/measures.md.
#include "backends.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/io/scene_file.hpp>
#include <photongrid/render/progressive_render.hpp>

#include <cstdio>

namespace {

using namespace photongrid;
using bench::median;
using bench::ms_of;

/// What a user waits for, ms.
struct waits {
    double first_picture;    ///< of a program that has just started: from start() to a whole picture on the CPU
    double camera_picture;   ///< after the camera moved, a whole picture
    double camera_converged; ///< … the last one
    double light_picture;    ///< after the lamp moved, a whole picture
    double light_converged;  ///< … the last one
};

template <backend B>
void first_picture(progressive_render<B>& drawing)
{
    while (drawing.pictures() == 0)
        drawing.step(typename progressive_render<B>::milliseconds(0));
    (void)drawing.picture();
}

template <backend B>
waits measure(B& b, const scene& s, const render_settings& settings, uint repetitions)
{
    std::vector<double> first, camera, camera_end, light, light_end;
    const auto finish = [&](progressive_render<B>& drawing) {
        drawing.step();
        (void)drawing.picture();
    };
    {
        progressive_render<B> compiling(b); // kernels, where the backend compiles any; they are kept between starts
        compiling.start(s, settings);
        finish(compiling);
    }
    for (uint i = 0; i < repetitions; ++i) {
        progressive_render<B> drawing(b);
        drawing.start(s, settings);
        first.push_back(ms_of([&] { first_picture(drawing); }));
        finish(drawing);
        const auto numbers = drawing.settings(); // as the window keeps them
        auto moved = s;
        for (int step = 0; step < 8; ++step) {
            moved.camera.position.x += 0.01;
            camera.push_back(ms_of([&] {
                drawing.start(moved, numbers);
                first_picture(drawing);
            }));
        }
        moved.camera.position.x += 0.01;
        camera_end.push_back(ms_of([&] {
            drawing.start(moved, numbers);
            finish(drawing);
        }));
        for (int step = 0; step < 4; ++step) {
            moved.rectangle_lights.at(0).corner.x += 0.01;
            light.push_back(ms_of([&] {
                drawing.start(moved, numbers);
                first_picture(drawing);
            }));
        }
        moved.rectangle_lights.at(0).corner.x += 0.01;
        light_end.push_back(ms_of([&] {
            drawing.start(moved, numbers);
            finish(drawing);
        }));
    }
    return {median(first), median(camera), median(camera_end), median(light), median(light_end)};
}

/// Prints rows for a backend. Returns whether all are as fast as they should be.
template <backend B>
bool report(B& b, const scene& s, uint repetitions, bool wanted)
{
    bool all = true;
    for (const uint size : {160u, 512u})
        for (const bool paper : {true, false}) {
            auto settings = paper ? as_paper(s) : s.render;
            settings.output.width = settings.output.height = size;
            settings.output.passes = 1; // whole: the first complete pass
            const auto w = measure(b, s, settings, repetitions);
            const bool fast = size == 160
                ? w.first_picture <= 150 && w.camera_picture <= 1000.0 / 15 && w.light_converged <= 700
                : w.first_picture <= 400;
            all = all && (fast || !wanted);
            std::printf("| %s | %u x %u | %s | %.0f | %.1f | %.0f | %.0f | %.0f | %s |\n", b.caps().backend.c_str(),
                size, size, paper ? "`at_least_k`, the paper's" : "`exact_k`", w.first_picture, 1000 / w.camera_picture,
                w.camera_converged, w.light_picture, w.light_converged,
                !wanted    ? ""
                    : fast ? "PASS"
                           : "FAIL");
            std::fflush(stdout);
        }
    return all;
}

struct arguments {
    std::string scene;
    uint repetitions = 9;
    std::vector<std::string> backends{"cpu"};
};

int run_interactive(const arguments& a)
{
    const auto s = read_scene(a.scene);
    std::printf("| backend | pixels | estimate | first picture, ms | updates per second, camera moving | camera "
                "rests, whole, ms | lamp moved, first picture, ms | lamp moved, whole, ms | wanted "
                "|\n|---|---|---|---|---|---|---|---|---|\n");
    bool fast = true;
    for (const auto& name : a.backends)
        fast = bench::on_backend(name, [&](auto&& b) { return report(b, s, a.repetitions, name == "cpu"); }) && fast;
    return fast ? 0 : 1;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_interactive(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    verb.add_option("scene", a->scene)->required();
    verb.add_option("backends", a->backends)->check(CLI::IsMember(backend_names));
    verb.add_option("--repetitions", a->repetitions)->check(CLI::PositiveNumber);
    return [a] { return run_interactive(*a); };
}
