// Every algorithm on every backend, by number of photons and by how evenly they lie in cells:
// docs/reference/measures.md. Names are ALGORITHM/BACKEND/photons:N/ands:A; Google Benchmark's options choose among
// them, set how long each is measured, and write JSON (--benchmark_out). Items are photons, for the searches points.
//
// Photons lie in a unit cube of 32 x 32 x 32 cells. Each of the 15 bits of a photon's cell is the AND of A + 1 random
// bits (Thearling and Smith 1992), which leaves 15, 12.2 and 5.1 bits of entropy a key for A = 0, 1 and 3; `all_ands`
// stands for all photons in one cell, 0 bits. Inside a cell they lie evenly.
#include "backends.hpp"
#include "verbs.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/fitting_grid.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/photon_cell.kernel.hpp>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <random>

namespace {

using namespace photongrid;
using glm::vec3;
using glm::vec4;

constexpr uint all_ands = 99;
constexpr uint cells_per_axis = 32;
constexpr uint k = 50;
constexpr uint most_points = 16384;

const grid& key_grid()
{
    static const grid g = make_grid(vec3(0), vec3(1), glm::uvec3(cells_per_axis));
    return g;
}

/// Bits of entropy of a cell's number.
double key_entropy(uint ands)
{
    const double one = std::exp2(-static_cast<double>(ands) - 1);
    return ands >= all_ands ? 0 : 15 * -(one * std::log2(one) + (1 - one) * std::log2(1 - one));
}

/// Positions of n photons in random order; those of the last call are kept.
const std::vector<vec4>& photon_positions(uint n, uint ands)
{
    static std::vector<vec4> kept;
    static uint kept_ands = ~0u;
    if (kept.size() == n && kept_ands == ands)
        return kept;
    std::mt19937 engine(1);
    const auto random = [&] { return static_cast<float>(engine() >> 8) * 0x1p-24f; };
    kept.resize(n);
    for (auto& p : kept) {
        uint cell = 0;
        if (ands < all_ands) {
            cell = static_cast<uint>(engine());
            for (uint a = 0; a < ands; ++a)
                cell &= static_cast<uint>(engine());
        }
        const auto coordinate
            = [&](uint bits) { return (static_cast<float>(bits % cells_per_axis) + random()) / cells_per_axis; };
        p = vec4(coordinate(cell), coordinate(cell >> 5), coordinate(cell >> 10), 0);
    }
    kept_ands = ands;
    return kept;
}

template <backend B>
photons<B> upload_photons(B& b, uint n, uint ands)
{
    const std::vector<vec4> powers(n, vec4(1, 1, 1, 0));
    return {b.upload(std::span<const vec4>(photon_positions(n, ands))), b.upload(std::span<const vec4>(powers))};
}

template <backend B>
buffer_of<B, glm::uvec2> cell_keys(B& b, const photons<B>& p)
{
    auto keys = b.template make<glm::uvec2>(p.size());
    b.template run<kernels::photon_cell>(p.size(), {.grid = key_grid(), .photons = p.size(), .parts = every_part},
        reads(p.positions, p.powers), writes(keys));
    return keys;
}

/// Measures `work` on what `prepare` makes anew for every iteration, apart; the device is waited for. Kernels compile
/// in a first run that does not count.
template <backend B, class Prepare, class Work>
void measure(benchmark::State& state, B& b, std::size_t items, Prepare&& prepare, Work&& work)
{
    using clock = std::chrono::steady_clock;
    const auto seconds = [&] {
        auto what = prepare();
        b.finish();
        const auto start = clock::now();
        work(what);
        b.finish();
        return std::chrono::duration<double>(clock::now() - start).count();
    };
    seconds();
    for (auto _ : state)
        state.SetIterationTime(seconds());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
    state.counters["key_entropy_bits"] = key_entropy(static_cast<uint>(state.range(1)));
}

template <backend B>
void sort_pairs(benchmark::State& state, B& b, uint n, uint ands)
{
    const auto keys = b.download(cell_keys(b, upload_photons(b, n, ands)));
    sort_report report;
    measure(
        state, b, n, [&] { return b.upload(std::span<const glm::uvec2>(keys)); },
        [&](auto& pairs) { report = bitonic_sort(b, pairs); });
    state.counters["passes"] = report.passes;
}

template <backend B>
void index_cells(benchmark::State& state, B& b, uint n, uint ands)
{
    auto pairs = cell_keys(b, upload_photons(b, n, ands));
    bitonic_sort(b, pairs);
    measure(
        state, b, n, [] { return 0; }, [&](int) { grid_index(b, pairs, cell_count(key_grid())); });
}

template <backend B>
void sum_up(benchmark::State& state, B& b, uint n, uint)
{
    const std::vector<uint> ones(n, 1u);
    const auto terms = b.upload(std::span<const uint>(ones));
    measure(
        state, b, n, [] { return 0; }, [&](int) { prefix_sums(b, terms); });
}

template <backend B>
void build_sorted_map(benchmark::State& state, B& b, uint n, uint ands)
{
    std::uint64_t bytes = 0;
    measure(
        state, b, n, [&] { return upload_photons(b, n, ands); },
        [&](auto& p) {
            const auto map = sorted_map(b, std::move(p), key_grid());
            bytes = b.bytes();
        });
    state.counters["map_bytes_per_photon"] = static_cast<double>(bytes) / n;
}

template <backend B>
void route_photons(benchmark::State& state, B& b, uint n, uint ands)
{
    const auto p = upload_photons(b, n, ands);
    measure(
        state, b, n, [] { return 0; }, [&](int) { stencil_route(b, p, key_grid(), 4); });
}

/// At most 16,384 points where photons are, in the order of the map's cells.
template <backend B>
void search(benchmark::State& state, B& b, uint n, uint ands, search_kind kind)
{
    auto p = upload_photons(b, n, ands);
    const auto g = fitting_grid(b, p, k, b.caps().cells_per_radius);
    const auto map = sorted_map(b, std::move(p), g);
    std::vector<vec4> at = b.download(map.photons.positions), few;
    const std::size_t step = std::max<std::size_t>(1, n / most_points);
    for (std::size_t i = 0; i < n; i += step)
        few.emplace_back(vec3(at[i]), 1.0f);
    const auto points = b.upload(std::span<const vec4>(few));
    const knn_settings settings{.k = k, .max_radius = 2, .search = kind};
    std::optional<knn_estimates<B>> e;
    measure(
        state, b, few.size(), [] { return 0; }, [&](int) { e = knn_grid_estimate(b, map, points, settings); });
    double used = 0, visited = 0;
    for (const auto& u : b.download(e->used)) {
        used += u.x;
        visited += u.y;
    }
    state.counters["used"] = used / static_cast<double>(few.size());
    state.counters["visited"] = visited / static_cast<double>(few.size());
}

/// Registers every algorithm on `b`, which must stay.
template <backend B>
void add(B& b)
{
    const std::vector<std::int64_t> sizes{1 << 12, 1 << 14, 1 << 16, 1 << 18, 1 << 20, 1 << 22},
        all_entropies{0, 1, 3, all_ands};
    const auto algorithm = [&](const std::string& name, const std::vector<std::int64_t>& entropies, auto run) {
        benchmark::RegisterBenchmark((name + "/" + b.caps().backend).c_str(),
            [&b, run](benchmark::State& state) {
                try {
                    run(state, b, static_cast<uint>(state.range(0)), static_cast<uint>(state.range(1)));
                } catch (const backend_error& e) {
                    state.SkipWithError(e.what());
                }
            })
            ->ArgsProduct({sizes, entropies})
            ->ArgNames({"photons", "ands"})
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    };
    algorithm("bitonic_sort", all_entropies, sort_pairs<B>);
    algorithm("grid_index", all_entropies, index_cells<B>);
    algorithm("prefix_sums", {0}, sum_up<B>);
    algorithm("sorted_map", all_entropies, build_sorted_map<B>);
    algorithm("stencil_route", all_entropies, route_photons<B>);
    algorithm("at_least_k", all_entropies, [](auto& state, auto& backend_, uint n, uint ands) {
        search(state, backend_, n, ands, search_kind::at_least_k);
    });
    algorithm("exact_k", all_entropies,
        [](auto& state, auto& backend_, uint n, uint ands) { search(state, backend_, n, ands, search_kind::exact_k); });
}

int run_algorithms(std::vector<std::string> words)
{
    words.insert(words.begin(), "algorithms");
    std::vector<char*> arguments;
    for (auto& word : words)
        arguments.push_back(word.data());
    auto count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data()))
        return 2;
    serial_backend serial;
    cpu_backend cpu;
    vulkan_backend vulkan;
    gl_backend gl;
    for (const auto& c : {serial.caps(), cpu.caps(), vulkan.caps(), gl.caps()})
        benchmark::AddCustomContext(c.backend, c.device);
    add(serial);
    add(cpu);
    add(vulkan);
    add(gl);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_algorithms(CLI::App& verb)
{
    verb.prefix_command();
    return [&verb] { return run_algorithms(verb.remaining()); };
}
