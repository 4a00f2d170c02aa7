// The paper's Table 2 for our kernels: what a pass of each has to do, counted in optimized SPIR-V, beside the figures
// of 2003; and what integer addresses save (section 4.1): a step of the bitonic sort with float addresses, counted and
// timed. Prints Markdown.
#include "stopwatch.hpp"
#include "verbs.hpp"

#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/estimate/gather_photons.kernel.hpp>
#include <photongrid/estimate/knn_visit.kernel.hpp>
#include <photongrid/estimate/kth_distance.kernel.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/bitonic_step.kernel.hpp>
#include <photongrid/map/first_in_cell.kernel.hpp>
#include <photongrid/map/photon_cell.kernel.hpp>
#include <photongrid/map/route_photon.kernel.hpp>
#include <photongrid/trace/bounce_photon.kernel.hpp>
#include <photongrid/trace/direct_light.kernel.hpp>
#include <photongrid/trace/emit_photon.kernel.hpp>
#include <photongrid/trace/eye_bounce.kernel.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include <photongrid/core/begin.hpp>
namespace photongrid::kernels {
struct bitonic_step_float {
#include "kernels/bitonic_step_float.glsl"
};
} // namespace photongrid::kernels
#include <photongrid/core/end.hpp>

namespace {

using namespace photongrid;
using bench::median;
using bench::ms_of;

/// Instructions in a module's functions, by what they are for.
struct tally {
    std::uint64_t all = 0, reads = 0, integer = 0, casts = 0;
};

tally count(const std::vector<std::uint32_t>& words)
{
    constexpr std::uint32_t op_variable = 59, op_load = 61, op_access_chain = 65, op_in_bounds_access_chain = 66,
                            op_image_fetch = 95, op_bitcast = 124;
    constexpr std::uint32_t uniform = 2, storage_buffer = 12;
    tally t;
    t.all = vulkan::count_instructions(words);
    std::set<std::uint32_t> in_buffers; // pointers
    vulkan::for_each_instruction(words, [&](std::uint32_t op, std::size_t at, std::size_t) {
        if (op == op_variable && (words[at + 3] == storage_buffer || words[at + 3] == uniform))
            in_buffers.insert(words[at + 2]);
        if ((op == op_access_chain || op == op_in_bounds_access_chain) && in_buffers.count(words[at + 3]) != 0)
            in_buffers.insert(words[at + 2]);
        t.reads += op == op_image_fetch || (op == op_load && in_buffers.count(words[at + 3]) != 0) ? 1u : 0u;
        // IAdd, ISub, IMul, UDiv, SDiv, UMod, SRem, SMod; shifts; or, xor, and, not
        t.integer += op == 128 || op == 130 || op == 132 || (op >= 134 && op <= 135) || (op >= 137 && op <= 139)
                || (op >= 194 && op <= 200)
            ? 1u
            : 0u;
        t.casts += op == op_bitcast ? 1u : 0u;
    });
    return t;
}

void row(const char* name, const tally& t, const char* paper)
{
    std::printf("| `%s` | %llu | %llu | %llu | %llu | %s |\n", name, static_cast<unsigned long long>(t.all),
        static_cast<unsigned long long>(t.reads), static_cast<unsigned long long>(t.integer),
        static_cast<unsigned long long>(t.casts), paper);
}

void print_table(vulkan_backend& b)
{
    std::printf("| kernel | instructions | buffer reads | integer operations | bit casts | the paper's Inst, TEX, "
                "Addr, Pack |\n|---|---|---|---|---|---|\n");
    row("bitonic_step", count(b.spirv<kernels::bitonic_step>(0)), "Bitonic Sort: 52, 2, 13, 0");
    row("bitonic_step_float", count(b.spirv<kernels::bitonic_step_float>(0)), "the same, with float addresses");
    row("first_in_cell", count(b.spirv<kernels::first_in_cell>(0)), "Binary Search, one iteration: 18, 1, 13, 0");
    row("route_photon", count(b.spirv<kernels::route_photon>(0)), "Stencil Routing: 42, 0, 25, 0");
    row("knn_visit", count(b.iterate_spirv<kernels::knn_visit>(0)),
        "Rad. Estimate: 202, 6, 47, 41 (sort); 193, 5, 20, 41 (route)");
    row("kth_distance", count(b.iterate_spirv<kernels::kth_distance>(0)), "");
    row("gather_photons", count(b.iterate_spirv<kernels::gather_photons>(0)), "");
    row("photon_cell", count(b.spirv<kernels::photon_cell>(0)), "");
    row("emit_photon", count(b.spirv<kernels::emit_photon>()), "");
    row("bounce_photon", count(b.spirv<kernels::bounce_photon>()), "");
    row("eye_bounce", count(b.iterate_spirv<kernels::eye_bounce>()), "");
    row("direct_light", count(b.spirv<kernels::direct_light>()), "");
}

/// Times ten steps of each kind on a million pairs, in turn. Returns whether they give the same.
bool compare_steps(vulkan_backend& b)
{
    constexpr uint n = 1u << 20, stride = 1024;
    std::mt19937 engine(1);
    std::vector<glm::uvec2> pairs;
    for (uint i = 0; i < n; ++i)
        pairs.emplace_back(static_cast<uint>(engine()), i);
    const auto in = b.upload(std::span<const glm::uvec2>(pairs));
    auto by_integers = b.make<glm::uvec2>(n), by_floats = b.make<glm::uvec2>(n);
    const auto ms = [&](const auto& pass) {
        b.finish();
        return ms_of([&] {
            for (int i = 0; i < 10; ++i)
                pass();
            b.finish();
        }) / 10;
    };
    std::vector<double> integers, floats;
    for (int i = 0; i < 6; ++i) {
        const double a = ms([&] {
            b.run<kernels::bitonic_step>(n, {.run = 2 * stride, .stride = stride}, reads(in), writes(by_integers));
        });
        const double c = ms([&] {
            b.run<kernels::bitonic_step_float>(
                n, {.run = 2.0f * stride, .stride = stride}, reads(in), writes(by_floats));
        });
        if (i > 0) { // kernels compile in the first
            integers.push_back(a);
            floats.push_back(c);
        }
    }
    const bool same = b.download(by_integers) == b.download(by_floats);
    std::printf("\nA step over %u pairs on %s: %.1f ms with integer addresses, %.1f ms with float addresses; ratio "
                "%.2f; results %s.\n",
        n, b.caps().device.c_str(), median(integers), median(floats), median(floats) / median(integers),
        same ? "equal" : "DIFFER");
    return same;
}

int run_kernels()
{
    vulkan_backend b;
    std::ifstream file(PHOTONGRID_BENCH_KERNELS "/bitonic_step_float.glsl");
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const text_file texts[] = {{"bench/kernels/bitonic_step_float.glsl", text}};
    b.add_texts(texts);
    print_table(b);
    return compare_steps(b) ? 0 : 3;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_kernels(CLI::App&) { return run_kernels; }
