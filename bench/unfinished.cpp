// What it gains to leave finished elements out of a pass (3.3, 4.3), against passes over all elements until all are
// done: a mask for each element, tiles that the device skips, lists of those that go on. The radiance estimates of the
// paper's three scenes, a quarter of the picture's pixels: by the paper's search, with little work a pass, as the
// paper's, and with as much as photongrid does; and by photongrid's own.
//
// A mask that the device tests before it runs a fragment, by stencil or depth, saves what a finished fragment costs
// now: reading its state and discarding it. The last column is the most that this could gain: the share of the time
// that fragments of finished elements take, which a kernel measures whose elements are all done but one.
#include "backends.hpp"
#include "stopwatch.hpp"
#include "unfinished_kernels.hpp"
#include "verbs.hpp"

#include <photongrid/io/scene_file.hpp>
#include <photongrid/render/picture_search.hpp>
#include <photongrid/render/render.hpp>

#include <algorithm>
#include <cstdio>

namespace {

using namespace photongrid;
using bench::median;
using bench::ms_of;
using glm::vec4;

/// Backend B, but every pass of run_until_done is over all elements; it asks after each eight of them whether all are
/// done, as often as B does.
template <backend B>
class every_element : public B {
public:
    using B::B;
    template <iterative_kernel K, class Reads, class Writes>
    progress run_until_done(launch l, const typename K::Params& args, Reads reads, Writes writes, uint passes)
    {
        progress p;
        while (!p.finished && p.passes < passes) {
            for (const uint end = std::min(p.passes + 8, passes); p.passes < end; ++p.passes)
                B::template run<K>(l, args, reads, writes);
            p.finished = B::template run_until_done<K>(l, args, reads, writes, 0).finished;
        }
        return p;
    }
};

/// The photons of a scene, and the points where its picture needs irradiance.
struct task {
    std::string name;
    std::vector<vec4> positions, powers, directions, photon_normals;
    grid cells{};
    std::vector<vec4> points{}, normals{};
    knn_settings search{};
};

/// `scene` by our estimate or the paper's, with the paper's numbers and a quarter of the pixels. `visits`: in a pass;
/// 0: photongrid's.
task task_of(const std::string& scene, bool paper, uint visits, uint divisor)
{
    auto s = read_scene("examples/scenes/" + scene + ".json");
    const auto of_paper = as_paper(s);
    auto settings = paper ? of_paper : with_numbers(s.render, of_paper);
    settings.estimate.max_radius = of_paper.estimate.max_radius;
    settings.output.width /= divisor;
    settings.output.height /= divisor;
    cpu_backend b;
    const auto built = build_map(b, s, settings);
    const auto& p = built.map().photons;
    const auto known = [&](const auto& buffer) { return buffer.size() > 0 ? b.download(buffer) : std::vector<vec4>(); };
    task t{.name = scene,
        .positions = b.download(p.positions),
        .powers = b.download(p.powers),
        .directions = known(p.directions),
        .photon_normals = known(p.normals),
        .cells = built.map().cells_of};
    const auto raster = detail::raster_of(settings, 1);
    detail::eye_hits<cpu_backend> hits(b, raster.size());
    auto branches = b.make<uint>(raster.size());
    detail::trace_eye_rays(
        b, built.scene(), {s.camera, raster}, {settings, 0, launch(raster.size(), 0)}, hits, branches);
    t.points = b.download(hits.points);
    t.normals = b.download(hits.surfaces);
    t.search = detail::search_for(settings);
    if (visits > 0) {
        t.search.visits_per_pass = visits;
        t.search.ranges_per_pass = std::max(visits / 4, 2u);
    }
    return t;
}

/// One way to treat finished elements: estimates the task, and says how many passes that took, how many elements were
/// unfinished in all of them together, and a sum of what was found.
struct outcome {
    std::uint64_t passes = 0, unfinished = 0;
    double found = 0;
};
struct version {
    std::string name;
    std::function<outcome()> estimate;
    double finished_ms = 0; ///< what a finished element costs in a pass; 0: not launched, or not known
    std::vector<double> ms{};
    outcome result{};
};

template <class B>
version with(std::string name, B& b, const task& t, double finished_ms = 0)
{
    struct prepared {
        map_buffers<B> map;
        buffer_of<B, vec4> points, normals;
    };
    const auto upload = [&](const std::vector<vec4>& v) { return b.upload(std::span<const vec4>(v)); };
    photons<B> p{upload(t.positions), upload(t.powers), upload(t.directions), upload(t.photon_normals)};
    auto kept = std::make_shared<prepared>(
        prepared{sorted_map(b, std::move(p), t.cells), upload(t.points), upload(t.normals)});
    return {std::move(name),
        [&b, kept, search = t.search] {
            outcome o;
            knn_search<B> running(b, kept->map, kept->points, kept->normals, search);
            const auto did = running.advance();
            o.passes = did.passes;
            for (const auto n : did.active)
                o.unfinished += n;
            for (const auto& v : b.download(running.estimates().irradiance))
                o.found += static_cast<double>(v.x);
            return o;
        },
        finished_ms};
}

/// What a finished element costs in a pass, ms: all are done but one, which counts down.
double ms_of_a_finished_element(gl_backend& b, std::size_t n)
{
    constexpr uint passes = 200;
    std::vector<vec4> states(n, vec4(0));
    states.back().x = passes;
    std::vector<double> ms;
    for (int i = 0; i < 4; ++i) {
        auto left = b.upload(std::span<const vec4>(states));
        b.finish();
        const double took = ms_of([&] {
            b.run_until_done<unfinished::count_down>({n, 0u, 0u}, {}, reads(), writes(left), passes);
            b.finish();
        });
        if (i > 0) // the first compiles
            ms.push_back(took);
    }
    return median(ms) / (static_cast<double>(passes) * static_cast<double>(n));
}

bool measure(const char* backend, const task& t, const char* work, std::vector<version> versions, int repetitions)
{
    for (int i = 0; i <= repetitions; ++i) // in turn; kernels compile in the first
        for (auto& v : versions) {
            const double ms = ms_of([&] { v.result = v.estimate(); });
            if (i > 0)
                v.ms.push_back(ms);
        }
    bool same = true;
    for (const auto& v : versions) {
        const bool right = v.result.found == versions[0].result.found;
        same = same && right;
        std::string most;
        if (v.finished_ms > 0) {
            const double finished
                = static_cast<double>(v.result.passes * t.points.size()) - static_cast<double>(v.result.unfinished);
            most = std::to_string(static_cast<int>(std::lround(100 * finished * v.finished_ms / median(v.ms)))) + " %";
        }
        std::printf("| %s | %s | %s | %s | %llu | %.0f | %.2f | %s | %s |\n", t.name.c_str(), backend, work,
            v.name.c_str(), static_cast<unsigned long long>(v.result.passes), median(v.ms),
            median(versions[0].ms) / median(v.ms), most.c_str(), right ? "" : "WRONG");
    }
    std::fflush(stdout);
    return same;
}

int run_unfinished(bool quick)
{
    const int repetitions = quick ? 1 : 3;
    bool same = true;
    gl_backend tiles, small_tiles({.tile = 16}), mask({.tile = 2048});
    every_element<gl_backend> plain_gl;
    vulkan_backend lists;
    every_element<vulkan_backend> plain_vulkan;
    const double finished = ms_of_a_finished_element(mask, 1 << 18);
    std::printf("gl: %s; vulkan: %s. A finished element that gl masks costs %.1f ns in a pass.\n\n| scene | backend "
                "| search | finished elements | passes | ms | gain over none | in finished elements | "
                "|\n|---|---|---|---|---|---|---|---|---|\n",
        tiles.caps().device.c_str(), lists.caps().device.c_str(), 1e6 * finished);
    for (const std::string scene : {"glass_ball", "ring", "cornell_box"})
        for (const auto& [paper, visits, work] : {std::tuple(true, 32u, "the paper's, 32 photons a pass"),
                 {true, 0u, "the paper's, 3072 a pass"}, {false, 0u, "photongrid's"}}) {
            const auto t = task_of(scene, paper, visits, quick ? 16 : 2);
            same = measure("gl", t, work,
                       {with("computed all the same", plain_gl, t), with("masked one by one", mask, t, finished),
                           with("left out in tiles of 64 x 64", tiles, t),
                           with("left out in tiles of 16 x 16", small_tiles, t)},
                       repetitions)
                && same;
            same = measure("vulkan", t, work,
                       {with("computed all the same", plain_vulkan, t), with("not in the list", lists, t)}, repetitions)
                && same;
        }
    return same ? 0 : 3;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_unfinished(CLI::App& verb)
{
    const auto quick = std::make_shared<bool>(false);
    verb.add_flag("--quick", *quick, "small pictures, once, to see that it runs");
    return [quick] { return run_unfinished(*quick); };
}
