// What it gains to leave finished elements out of a pass (3.3, 4.3), against passes over all elements until all are
// done: a mask for each element, tiles that the device skips, lists of those that go on. Radiance estimates by the
// paper's search, whose steps differ from point to point; with little work a pass, as the paper's, and with as much as
// photongrid does.
//
//   unfinished [REPETITIONS [POINTS]]
#include "data_sets.hpp"
#include "median.hpp"

#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/fitting_grid.hpp>
#include <photongrid/map/map_builders.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>

namespace {

using namespace photongrid;
using bench::data_set;
using bench::median;
using bench::vec4;

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

/// One way to treat finished elements: estimates the set, and says how many passes that took and a sum of what was
/// found.
struct version {
    std::string name;
    std::function<std::pair<uint, double>()> estimate;
    std::vector<double> ms{};
    uint passes = 0;
    double found = 0;
};

template <class B>
version with(std::string name, B& b, const data_set& s, uint visits)
{
    struct prepared {
        map_buffers<B> map;
        buffer_of<B, vec4> points;
    };
    photons<B> p{b.upload(std::span<const vec4>(s.positions)), b.upload(std::span<const vec4>(s.powers))};
    const auto g = fitting_grid(b, p, s.k);
    auto kept = std::make_shared<prepared>(
        prepared{sorted_map(b, std::move(p), g), b.upload(std::span<const vec4>(s.points))});
    auto settings = as_paper(knn_settings{.k = s.k, .max_radius = 2});
    if (visits > 0) {
        settings.visits_per_pass = visits;
        settings.ranges_per_pass = std::max(visits / 4, 2u);
    }
    return {std::move(name), [&b, kept, settings] {
                knn_search<B> search(b, kept->map, kept->points, settings);
                const uint passes = search.advance().passes;
                const auto e = search.estimates();
                b.finish();
                double sum = 0;
                for (const auto& v : b.download(e.irradiance))
                    sum += static_cast<double>(v.x);
                return std::pair(passes, sum);
            }};
}

bool measure(const char* backend, const data_set& s, const char* work, std::vector<version> versions, int repetitions)
{
    for (int i = 0; i <= repetitions; ++i) // in turn; kernels compile in the first
        for (auto& v : versions) {
            const auto start = std::chrono::steady_clock::now();
            std::tie(v.passes, v.found) = v.estimate();
            if (i > 0)
                v.ms.push_back(
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
    bool same = true;
    for (const auto& v : versions) {
        same = same && v.found == versions[0].found;
        std::printf("| %s | %s | %s | %s | %u | %.0f | %.2f | %s |\n", s.name.c_str(), backend, work, v.name.c_str(),
            v.passes, median(v.ms), median(versions[0].ms) / median(v.ms), v.found == versions[0].found ? "" : "WRONG");
    }
    std::fflush(stdout);
    return same;
}

} // namespace

int main(int argc, char** argv)
{
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
    const auto most = static_cast<std::size_t>(argc > 2 ? std::max(1, std::atoi(argv[2])) : 1 << 30);
    bool same = true;
    try {
        gl_backend tiles, small_tiles({.tile = 16}), mask({.tile = 2048});
        every_element<gl_backend> plain_gl;
        vulkan_backend lists;
        every_element<vulkan_backend> plain_vulkan;
        std::printf("gl: %s; vulkan: %s\n\n| set | backend | photons per pass | finished elements | passes | ms | gain "
                    "over none | |\n|---|---|---|---|---|---|---|---|\n",
            tiles.caps().device.c_str(), lists.caps().device.c_str());
        for (const int number : {1, 3}) {
            auto s = bench::make_data_set(number);
            s.points.resize(std::min(s.points.size(), most));
            for (const uint visits : {32u, 0u}) {
                const char* work = visits > 0 ? "32" : "3072";
                same = measure("gl", s, work,
                           {with("computed all the same", plain_gl, s, visits),
                               with("masked one by one", mask, s, visits),
                               with("left out in tiles of 64 x 64", tiles, s, visits),
                               with("left out in tiles of 16 x 16", small_tiles, s, visits)},
                           repetitions)
                    && same;
                same = measure("vulkan", s, work,
                           {with("computed all the same", plain_vulkan, s, visits),
                               with("not in the list", lists, s, visits)},
                           repetitions)
                    && same;
            }
        }
    } catch (const backend_error& e) {
        std::fprintf(stderr, "unfinished: %s\n", e.what());
        return 2;
    }
    return same ? 0 : 3;
}
