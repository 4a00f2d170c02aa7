// The k nearest photons against CGAL, FLANN and nanoflann: docs/reference/measures.md. All at the same number of
// threads, same points, same k, unbounded radius, exact; every k-th squared distance is compared. Prints PASS or FAIL
// per data set; exits 1 where one is too slow or takes too much memory, 3 where distances differ. On one thread of the
// cpu backend it also builds maps against trees, and searches on two threads.
//
//   knn_peers [--backend cpu|vulkan|gl] [--threads N] [--sets 12345] [--seconds S] [--shuffle] [--avx2]
//
// A vulkan or gl device takes the threads that it takes: two of llvmpipe and lavapipe on a machine of two cores.
// --threads are the peers' then.
//
// --avx2: no AVX-512 on our side, and half of each ratio wanted, whatever the machine has.
//
// photongrid makes whole estimates (it adds up the photons' flux as well); peers only find. A peer takes every n-th run
// of 64 points so that it ends within S seconds; photongrid takes all.
#include "data_sets.hpp"
#include "median.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/backends/gl/gl.hpp>
#include <photongrid/backends/vulkan/vulkan.hpp>
#include <photongrid/map/fitting_grid.hpp>

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Simple_cartesian.h>
#include <flann/flann.hpp>
#include <hwy/targets.h>
#include <nanoflann.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

namespace {

using namespace photongrid;
using namespace photongrid::bench;
using std::size_t;

double seconds_of(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
/// Median of three.
double median_seconds_of(const std::function<void()>& work)
{
    std::vector<double> all;
    for (int repetition = 0; repetition < 3; ++repetition)
        all.push_back(seconds_of(work));
    return median(all);
}
/// A peer: how long it built, and its search.
struct peer {
    std::string name;
    double build_seconds;
    std::function<float(const vec4& point)> kth; ///< squared distance of the k-th nearest; from any thread
};

using kernel_of_cgal = CGAL::Simple_cartesian<float>;
using cgal_search = CGAL::Orthogonal_k_neighbor_search<CGAL::Search_traits_3<kernel_of_cgal>>;

peer cgal(const data_set& s)
{
    std::vector<kernel_of_cgal::Point_3> points;
    for (const auto& p : s.positions)
        points.emplace_back(p.x, p.y, p.z);
    std::shared_ptr<cgal_search::Tree> tree;
    const double build = median_seconds_of([&] {
        tree = std::make_shared<cgal_search::Tree>(points.begin(), points.end());
        tree->build();
    });
    return {"CGAL", build, [tree, k = s.k](const vec4& q) {
                const cgal_search search(*tree, kernel_of_cgal::Point_3(q.x, q.y, q.z), k);
                float last = 0;
                for (const auto& found : search)
                    last = found.second;
                return last;
            }};
}

peer flann_tree(const data_set& s, int leaf)
{
    auto coordinates = std::make_shared<std::vector<float>>();
    for (const auto& p : s.positions)
        coordinates->insert(coordinates->end(), {p.x, p.y, p.z});
    const flann::Matrix<float> data(coordinates->data(), s.positions.size(), 3);
    std::shared_ptr<flann::KDTreeSingleIndex<flann::L2_Simple<float>>> tree;
    const double build = median_seconds_of([&] {
        tree = std::make_shared<flann::KDTreeSingleIndex<flann::L2_Simple<float>>>(
            data, flann::KDTreeSingleIndexParams(leaf));
        tree->buildIndex();
    });
    return {"FLANN, leaves of " + std::to_string(leaf), build, [coordinates, tree, k = s.k](const vec4& q) {
                thread_local std::vector<size_t> indices;
                thread_local std::vector<float> distances;
                indices.resize(k);
                distances.resize(k);
                float at[3] = {q.x, q.y, q.z};
                flann::Matrix<size_t> i(indices.data(), 1, k);
                flann::Matrix<float> d(distances.data(), 1, k);
                tree->knnSearch(
                    flann::Matrix<float>(at, 1, 3), i, d, k, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
                return distances.back();
            }};
}

/// Points as nanoflann wants them.
struct cloud {
    const std::vector<vec4>& points;
    size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return points[i][static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

peer nanoflann_tree(const data_set& s, size_t leaf)
{
    using tree_type = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3, uint>;
    auto data = std::make_shared<cloud>(cloud{s.positions});
    std::shared_ptr<tree_type> tree;
    const double build = median_seconds_of(
        [&] { tree = std::make_shared<tree_type>(3, *data, nanoflann::KDTreeSingleIndexAdaptorParams(leaf)); });
    return {"nanoflann, leaves of " + std::to_string(leaf), build, [data, tree, k = s.k](const vec4& q) {
                thread_local std::vector<uint> indices;
                thread_local std::vector<float> distances;
                indices.resize(k);
                distances.resize(k);
                const float at[3] = {q.x, q.y, q.z};
                tree->knnSearch(at, k, indices.data(), distances.data());
                return distances.back();
            }};
}

/// Points a second of a peer; every one's k-th squared distance is compared with `known` and counted in `wrong`.
double rate(
    const peer& p, const data_set& s, const std::vector<float>& known, unsigned threads, double seconds, size_t& wrong)
{
    constexpr size_t run = 64;
    const size_t runs = s.points.size() / run;
    const auto search = [&](size_t every) {
        std::atomic<size_t> done = 0, differ = 0;
        const auto one = [&](size_t r) {
            size_t bad = 0;
            for (size_t i = r * every * run; i < r * every * run + run; ++i)
                bad += p.kth(s.points[i]) != known[i] ? 1u : 0u;
            done += run;
            differ += bad;
        };
        const size_t n = std::max<size_t>(runs / every, 1);
        const double t = seconds_of([&] {
            if (threads == 1) {
                for (size_t r = 0; r < n; ++r)
                    one(r);
            } else {
                tbb::task_arena arena(static_cast<int>(threads));
                arena.execute([&] { tbb::parallel_for(size_t{0}, n, one); });
            }
        });
        wrong += differ;
        return static_cast<double>(done) / t;
    };
    const double first = search(std::max<size_t>(runs / 40, 1));
    return search(std::max<size_t>(static_cast<size_t>(static_cast<double>(s.points.size()) / (first * seconds)), 1));
}

struct arguments {
    std::string backend = "cpu";
    unsigned threads = 1;
    std::string sets = "12345";
    double seconds = 1;
    bool shuffle = false, avx2 = false;
};

/// What the table must show: least ratios with AVX-512; with AVX2, half of them, and so for points in random order. 0:
/// whatever it is.
double wanted(const arguments& a, int number)
{
    constexpr double cpu[] = {4, 6, 18, 8, 22};
    if (a.backend == "cpu")
        return cpu[number - 1] * (a.shuffle || a.avx2 ? 0.5 : 1);
    return number != 3 || a.shuffle ? 0 : a.backend == "vulkan" ? 1.8 : 1.1;
}

/// Points a second of whole estimates, all points again and again for as long as a peer gets, after one run to warm up,
/// as a peer has. `e`: the last ones.
template <backend B>
double rate(B& b, const map_buffers<B>& map, const buffer_of<B, vec4>& points, const knn_settings& settings,
    double seconds, std::optional<knn_estimates<B>>& e)
{
    e = knn_grid_estimate(b, map, points, settings);
    double spent = 0, done = 0;
    for (; spent < seconds; done += static_cast<double>(points.size()))
        spent += seconds_of([&] {
            e = knn_grid_estimate(b, map, points, settings);
            b.finish();
        });
    return done / spent;
}

template <backend B>
photons<B> upload_photons(B& b, const data_set& s)
{
    return {b.upload(std::span<const vec4>(s.positions)), b.upload(std::span<const vec4>(s.powers))};
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
        return ::rate(b_, map_, points_, settings, seconds, last_);
    }

private:
    cpu_backend b_{2};
    map_buffers<cpu_backend> map_;
    cpu_backend::buffer<vec4> points_;
    std::optional<knn_estimates<cpu_backend>> last_;
};

constexpr double least_build
    = 8; ///< how many times as fast as the fastest tree's build a million photons' is, on one thread
constexpr double most_bytes = 48;    ///< a photon, after the build
constexpr double least_by_two = 1.8; ///< points a second on two threads over those on one

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
    std::vector<float> known;
    map_buffers<B> map;
    for (int repetition = 0; repetition < 9; ++repetition) {
        auto p = upload_photons(b, s);
        builds.push_back(seconds_of([&] {
            map = sorted_map(b, std::move(p), g);
            b.finish();
        }));
    }
    const auto after = b.bytes();
    std::vector<peer> peers{cgal(s)};
    for (const int leaf : {10, 25, 50}) {
        peers.push_back(flann_tree(s, leaf));
        peers.push_back(nanoflann_tree(s, static_cast<size_t>(leaf)));
    }
    const bool alone = a.backend == "cpu" && a.threads == 1;
    std::optional<two_threads> two;
    if (alone && std::thread::hardware_concurrency() > 1)
        two.emplace(s, g);
    size_t wrong = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
        std::optional<knn_estimates<B>> e;
        searches.push_back(rate(b, map, points, settings, a.seconds, e));
        if (two)
            searches_by_two.push_back(two->rate(settings, a.seconds));
        if (known.empty())
            for (const auto& v : b.download(e->irradiance))
                known.push_back(v.w);
        for (size_t i = 0; i < peers.size(); ++i)
            peer_rates[i].push_back(rate(peers[i], s, known, a.threads, a.seconds, wrong));
    }
    size_t best = 0;
    double best_build = 1e9;
    for (size_t i = 0; i < peers.size(); ++i) {
        if (median(peer_rates[i]) > median(peer_rates[best]))
            best = i;
        best_build = std::min(best_build, peers[i].build_seconds);
    }
    const double ours = median(searches), theirs = median(peer_rates[best]), ratio = ours / theirs;
    const double build_ratio = best_build / median(builds),
                 bytes = static_cast<double>(after - 16 * s.points.size()) / static_cast<double>(s.positions.size());
    const double by_two = two ? median(searches_by_two) / ours : 0;
    const double least = wanted(a, number);
    const bool large = s.positions.size() >= 1000000;
    const bool pass = ratio >= least && wrong == 0
        && (!alone
            || ((!two || by_two >= least_by_two) && bytes <= most_bytes
                && (!large || a.avx2 || build_ratio >= least_build)));
    std::printf("| %s | %s | %u | %u x %u x %u | %.0f | %.1f | %s | %.1f | %g | %.1f | %.1f | %.0f |", s.name.c_str(),
        s.what.c_str(), s.k, g.resolution.x, g.resolution.y, g.resolution.z, ours / 1000, theirs / 1000,
        peers[best].name.c_str(), ratio, least, median(builds) * 1000, build_ratio, bytes);
    if (alone)
        std::printf(" %.2f |", by_two);
    std::printf(" %zu | %s |\n", wrong, pass ? "PASS" : "FAIL");
    std::fflush(stdout);
    return wrong > 0 ? 3 : pass ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
    arguments a;
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0 && i + 1 < argc; };
        if (is("--backend"))
            a.backend = argv[++i];
        else if (is("--threads"))
            a.threads = static_cast<unsigned>(std::max(1, std::atoi(argv[++i])));
        else if (is("--sets"))
            a.sets = argv[++i];
        else if (is("--seconds"))
            a.seconds = std::max(0.01, std::atof(argv[++i]));
        else if (std::strcmp(argv[i], "--shuffle") == 0)
            a.shuffle = true;
        else if (std::strcmp(argv[i], "--avx2") == 0)
            a.avx2 = true;
        else {
            std::fprintf(stderr,
                "knn_peers [--backend cpu|vulkan|gl] [--threads N] [--sets 12345] [--seconds S] [--shuffle] "
                "[--avx2]\n");
            return 2;
        }
    }
    if (a.backend != "cpu" && a.backend != "vulkan" && a.backend != "gl") {
        std::fprintf(stderr, "knn_peers: --backend: '%s'; cpu, vulkan or gl\n", a.backend.c_str());
        return 2;
    }
    if (a.avx2) {
        hwy::DisableTargets(HWY_AVX3 | HWY_AVX3_DL);
        const auto left = hwy::SupportedAndGeneratedTargets();
        if (std::find(left.begin(), left.end(), HWY_AVX2) == left.end()) {
            std::fprintf(stderr,
                "knn_peers: --avx2: this machine has none, or the program is compiled for a better one alone; "
                "knn_peers_portable is not\n");
            return 2;
        }
    }
    std::printf("%s, %u thread%s%s%s\n\n", a.backend.c_str(), a.threads, a.threads == 1 ? "" : "s",
        a.shuffle ? ", points in random order" : "", a.avx2 ? ", AVX2" : "");
    const bool alone = a.backend == "cpu" && a.threads == 1;
    if (alone)
        std::printf("Wanted besides: a build of a million photons %g times as fast as the fastest peer's%s, %g bytes a "
                    "photon at most, %g times the speed on two threads.\n\n",
            least_build, a.avx2 ? " (not with AVX2)" : "", most_bytes, least_by_two);
    std::printf("| set | photons | k | grid | photongrid, 1000/s | fastest peer, 1000/s | which | ratio | wanted | "
                "build, ms | fastest peer's build over it | bytes a photon |%s k-th distances that differ | "
                "|\n|---|---|---|---|---|---|---|---|---|---|---|---|%s---|---|\n",
        alone ? " two threads over one |" : "", alone ? "---|" : "");
    const auto all = [&](auto&& b) {
        int worst = 0;
        for (int number = 1; number <= 5; ++number)
            if (a.sets.find(static_cast<char>('0' + number)) != std::string::npos)
                worst = std::max(worst, measure(b, number, a));
        return worst;
    };
    try {
        return a.backend == "cpu"   ? all(cpu_backend(a.threads))
            : a.backend == "vulkan" ? all(vulkan_backend())
                                    : all(gl_backend());
    } catch (const backend_error& e) {
        std::fprintf(stderr, "knn_peers: %s\n", e.what());
        return 2;
    }
}
