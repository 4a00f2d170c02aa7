// The k nearest photons against CGAL, FLANN and nanoflann: docs/reference/measures.md. All at the same number of
// threads, same points, same k, unbounded radius, exact; every k-th squared distance is compared. Prints PASS or FAIL
// per data set; exits 1 where one is too slow or takes too much memory, 3 where distances differ. On one thread of the
// cpu backend it also builds maps against trees, and searches on two threads.
//
// photongrid makes whole estimates (it adds up the photons' power as well); peers only find. A peer takes every n-th
// run of 64 points so that it ends within S seconds; photongrid takes all.
#include "data_sets.hpp"
#include "device_searches.hpp"
#include "median.hpp"
#include "peers.hpp"
#include "verbs.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/map/fitting_grid.hpp>

#include <hwy/targets.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>
#include <thread>

namespace {

using namespace photongrid;
using namespace photongrid::bench;
using std::size_t;

struct arguments {
    std::string backend = "cpu";
    unsigned threads = 1;
    std::string sets = "12345";
    double seconds = 1;
    bool shuffle = false, avx2 = false;
};

/// On one thread of the cpu backend, builds and searches on two threads are measured as well.
bool is_alone(const arguments& a) { return a.backend == "cpu" && a.threads == 1; }

/// What the table must show: least ratios with AVX-512; with AVX2, half of them, and so for points in random order. 0:
/// whatever it is.
double wanted(const arguments& a, int number)
{
    constexpr double cpu[] = {4, 6, 18, 8, 22};
    if (a.backend == "cpu")
        return cpu[number - 1] * (a.shuffle || a.avx2 ? 0.5 : 1);
    return number != 3 || a.shuffle ? 0 : a.backend == "vulkan" ? 1.8 : 1.1;
}

/// The cpu backend's search on two threads.
class two_threads {
public:
    two_threads(const data_set& s, const grid& g)
        : map_(sorted_map(b_, upload_photons(b_, s), g)), points_(b_.upload(std::span<const vec4>(s.points)))
    {
    }
    double rate(const knn_settings& settings, double seconds)
    {
        std::optional<knn_estimates<cpu_backend>> e;
        return points_per_second(b_, map_, points_, settings, seconds, e);
    }

private:
    cpu_backend b_{2};
    map_buffers<cpu_backend> map_;
    cpu_backend::buffer<vec4> points_;
};

constexpr double least_build
    = 8; ///< how many times as fast as the fastest tree's build a million photons' is, on one thread
constexpr double most_bytes = 48;    ///< per photon, after the build
constexpr double least_by_two = 1.8; ///< points per second on two threads over those on one

/// What is measured of one data set.
struct measured {
    double rate = 0, peers_rate = 0; ///< points per second; the fastest peer's
    std::string fastest_peer;
    double build_ms = 0, build_ratio = 0; ///< how many times as fast as the fastest peer's build
    double bytes_per_photon = 0;          ///< after the build
    std::optional<double> by_two{};       ///< points per second on two threads over those on one
    size_t wrong = 0;                     ///< k-th distances that differ
};

/// Prints a row of the table. Returns the exit code.
int report(const data_set& s, const grid& g, const measured& m, int number, const arguments& a)
{
    const double ratio = m.rate / m.peers_rate, least = wanted(a, number);
    const bool large = s.positions.size() >= 1000000;
    const bool pass = ratio >= least && m.wrong == 0
        && (!is_alone(a)
            || (m.by_two.value_or(least_by_two) >= least_by_two && m.bytes_per_photon <= most_bytes
                && (!large || a.avx2 || m.build_ratio >= least_build)));
    std::printf("| %s | %s | %u | %u x %u x %u | %.0f | %.1f | %s | %.1f | %g | %.1f | %.1f | %.0f |", s.name.c_str(),
        s.what.c_str(), s.k, g.resolution.x, g.resolution.y, g.resolution.z, m.rate / 1000, m.peers_rate / 1000,
        m.fastest_peer.c_str(), ratio, least, m.build_ms, m.build_ratio, m.bytes_per_photon);
    if (is_alone(a))
        std::printf(" %.2f |", m.by_two.value_or(0));
    std::printf(" %zu | %s |\n", m.wrong, pass ? "PASS" : "FAIL");
    std::fflush(stdout);
    return m.wrong > 0 ? 3 : pass ? 0 : 1;
}

template <backend B>
int measure(B& b, int number, const arguments& a)
{
    auto s = make_data_set(number);
    if (a.shuffle) {
        std::mt19937 engine(2);
        std::shuffle(s.points.begin(), s.points.end(), engine);
    }
    const auto g = fitting_grid(b, upload_photons(b, s), s.k, b.caps().cells_per_radius);
    const auto points = b.upload(std::span<const vec4>(s.points));
    const knn_settings settings{.k = s.k, .max_radius = 1e18f};
    std::vector<double> builds, searches, searches_by_two, peer_rates[8];
    map_buffers<B> map;
    for (int repetition = 0; repetition < 9; ++repetition) {
        auto p = upload_photons(b, s);
        builds.push_back(seconds_of([&] {
            map = sorted_map(b, std::move(p), g);
            b.finish();
        }));
    }
    const auto after = b.bytes();
    const auto peers = all_peers(s);
    std::vector<peer_search> peer_searches;
    for (const auto& p : peers)
        peer_searches.emplace_back(p, s, s.k, a.threads, a.seconds);
    kth_distances known(s.points.size());
    std::optional<two_threads> two;
    if (is_alone(a) && std::thread::hardware_concurrency() > 1)
        two.emplace(s, g);
    size_t wrong = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
        std::optional<knn_estimates<B>> e;
        searches.push_back(points_per_second(b, map, points, settings, a.seconds, e));
        if (two)
            searches_by_two.push_back(two->rate(settings, a.seconds));
        const auto found = b.download(e->irradiance);
        for (size_t i = 0; i < found.size(); ++i)
            wrong += known.differs(i, found[i].w) ? 1u : 0u;
        for (size_t i = 0; i < peers.size(); ++i)
            peer_rates[i].push_back(peer_searches[i].rate(known, wrong));
    }
    size_t best = 0;
    double best_build = 1e9;
    for (size_t i = 0; i < peers.size(); ++i) {
        if (median(peer_rates[i]) > median(peer_rates[best]))
            best = i;
        best_build = std::min(best_build, peers[i].build_seconds);
    }
    measured m{.rate = median(searches),
        .peers_rate = median(peer_rates[best]),
        .fastest_peer = peers[best].name,
        .build_ms = median(builds) * 1000,
        .build_ratio = best_build / median(builds),
        .bytes_per_photon = static_cast<double>(after - 16 * s.points.size()) / static_cast<double>(s.positions.size()),
        .wrong = wrong};
    if (two)
        m.by_two = median(searches_by_two) / m.rate;
    return report(s, g, m, number, a);
}

void print_head(const arguments& a)
{
    std::printf("%s, %u thread%s%s%s\n\n", a.backend.c_str(), a.threads, a.threads == 1 ? "" : "s",
        a.shuffle ? ", points in random order" : "", a.avx2 ? ", AVX2" : "");
    if (is_alone(a))
        std::printf("Wanted besides: a build of a million photons %g times as fast as the fastest peer's%s, %g bytes "
                    "per photon at most, %g times the speed on two threads.\n\n",
            least_build, a.avx2 ? " (not with AVX2)" : "", most_bytes, least_by_two);
    std::printf("| set | photons | k | grid | photongrid, 1000/s | fastest peer, 1000/s | which | ratio | wanted | "
                "build, ms | fastest peer's build over it | bytes per photon |%s k-th distances that differ | "
                "|\n|---|---|---|---|---|---|---|---|---|---|---|---|%s---|---|\n",
        is_alone(a) ? " two threads over one |" : "", is_alone(a) ? "---|" : "");
}

int run_search(const arguments& a)
{
    if (a.avx2) {
        hwy::DisableTargets(HWY_AVX3 | HWY_AVX3_DL);
        const auto left = hwy::SupportedAndGeneratedTargets();
        if (std::find(left.begin(), left.end(), HWY_AVX2) == left.end())
            throw std::runtime_error(
                "--avx2: this machine has none, or the program is compiled for a better one alone");
    }
    print_head(a);
    const auto all = [&](auto&& b) {
        int worst = 0;
        for (int number = 1; number <= 5; ++number)
            if (a.sets.find(static_cast<char>('0' + number)) != std::string::npos)
                worst = std::max(worst, measure(b, number, a));
        return worst;
    };
    return a.backend == "cpu"   ? all(cpu_backend(a.threads))
        : a.backend == "vulkan" ? all(vulkan_backend())
                                : all(gl_backend());
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_search(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    verb.add_option("--backend", a->backend)->check(CLI::IsMember({"cpu", "vulkan", "gl"}));
    verb.add_option("--threads", a->threads, "of cpu and the peers; other devices take what they take")
        ->check(CLI::PositiveNumber);
    verb.add_option("--sets", a->sets, "their numbers");
    verb.add_option("--seconds", a->seconds, "that a peer takes for a set, about")->check(CLI::PositiveNumber);
    verb.add_flag("--shuffle", a->shuffle, "points in random order; half of each ratio wanted");
    verb.add_flag("--avx2", a->avx2, "no AVX-512 on our side; half of each ratio wanted");
    return [a] { return run_search(*a); };
}
