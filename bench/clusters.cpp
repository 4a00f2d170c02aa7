// The k nearest photons against CGAL, FLANN and nanoflann where photons lie in clusters (clustered_sets.hpp), on the
// cpu backend: docs/reference/measures.md. As in search.cpp, all are exact, at the same number of threads, and k-th
// squared distances are compared. Exits 1 where a map is slower than wanted, 3 where distances differ.
//
// A peer takes every n-th run of 64 points so that it ends within S seconds. photongrid takes all points if it ends
// within 10 S seconds, otherwise runs for S seconds. Distances are compared wherever both have searched.
#include "clustered_sets.hpp"
#include "map_search.hpp"
#include "median.hpp"
#include "peers.hpp"
#include "verbs.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/map/map_builders.hpp>

#include <algorithm>
#include <cstdio>

namespace {

using namespace photongrid;
using namespace photongrid::bench;
using std::size_t;

/// How a kind of map is built for searches for the k nearest.
struct map_kind {
    const char* name;
    map_buffers<cpu_backend> (*build)(cpu_backend& b, photons<cpu_backend> p, uint k);
    bool is_wanted_fast; ///< whether it must reach what `wanted` says
};

constexpr map_kind map_kinds[] = {
    {"grid",
        [](cpu_backend& b, photons<cpu_backend> p, uint k) {
            const grid g = fitting_grid(b, p, k, b.caps().cells_per_radius);
            return sorted_map(b, std::move(p), g);
        },
        false},
    {"blocks", [](cpu_backend& b, photons<cpu_backend> p, uint) { return block_map(b, std::move(p)); }, false},
    {"auto", [](cpu_backend& b, photons<cpu_backend> p, uint k) { return fitted_map(b, std::move(p), k); }, true},
};

/// How many times as fast as the fastest peer a map must be.
struct floor_of_ratios {
    double search = 0;
    double both = 0; ///< a build and a search at every point, together
};

floor_of_ratios wanted(const map_kind& kind, const clustered_set& which)
{
    if (!kind.is_wanted_fast)
        return {};
    return which.has_equal_gaps ? floor_of_ratios{1, 1} : floor_of_ratios{4, 2};
}

struct arguments {
    std::vector<std::string> sets, maps;
    std::vector<uint> k{1, 10, 50, 500};
    uint photons = 1000000;
    unsigned threads = 1;
    double seconds = 0.5;
    bool few_points = false, shuffle = false;
    std::string data;
};

bool has(const std::vector<std::string>& names, const char* name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// A map in one row of the table, or a peer.
struct measured {
    std::vector<double> rates, builds; ///< points per second; s
    double rate() const { return median(rates); }
    double build() const { return median(builds); }
    /// Seconds of a build and a search at every point.
    double both(size_t points) const { return build() + static_cast<double>(points) / rate(); }
};

/// The peers' best in each respect.
struct best_of_peers {
    double rate = 0, build = 1e30, both = 1e30; ///< points per second; s; s
    std::string fastest;
};

best_of_peers best_of(const std::vector<peer>& peers, const std::vector<measured>& of_peers, size_t points)
{
    best_of_peers best;
    for (size_t i = 0; i < peers.size(); ++i) {
        const measured& m = of_peers[i];
        if (m.rate() > best.rate) {
            best.rate = m.rate();
            best.fastest = peers[i].name;
        }
        best.build = std::min(best.build, m.build());
        best.both = std::min(best.both, m.both(points));
    }
    return best;
}

/// Prints rows of the table, and the same as data.
class table {
public:
    explicit table(const std::string& data) : data_(data.empty() ? nullptr : std::fopen(data.c_str(), "w"), &close)
    {
        std::printf("| set | k | map | photongrid, 1000/s | fastest peer, 1000/s | which | ratio | build, ms | fastest "
                    "peer's build over it | build and search, ratio | bytes per photon | k-th distances that differ, "
                    "of those compared | wanted | |\n"
                    "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        if (data_)
            std::fprintf(
                data_.get(), "set\tk\tmap\tphotongrid\tpeer\tratio\tbuild_ms\tbuild_ratio\tboth_ratio\tbytes\n");
        else if (!data.empty())
            throw std::runtime_error("--data: cannot write " + data);
    }

    /// Returns the exit code.
    int row(const clustered_set& which, uint k, const map_kind& kind, const measured& m, const best_of_peers& best,
        size_t points, double bytes, const map_search::comparison& c)
    {
        const double ratio = m.rate() / best.rate, both = best.both / m.both(points);
        const auto least = wanted(kind, which);
        const bool pass = ratio >= least.search && both >= least.both && c.wrong == 0;
        std::printf("| %s | %u | %s | %.4g | %.4g | %s | %.3g | %.1f | %.2g | %.3g | %.0f | %zu of %zu |", which.name,
            k, kind.name, m.rate() / 1000, best.rate / 1000, best.fastest.c_str(), ratio, m.build() * 1000,
            best.build / m.build(), both, bytes, c.wrong, c.compared);
        if (kind.is_wanted_fast)
            std::printf(" %g, both %g |", least.search, least.both);
        else
            std::printf(" |");
        std::printf(" %s |\n", pass ? kind.is_wanted_fast ? "PASS" : "" : "FAIL");
        std::fflush(stdout);
        if (data_)
            std::fprintf(data_.get(), "%s\t%u\t%s\t%g\t%g\t%g\t%g\t%g\t%g\t%g\n", which.name, k, kind.name, m.rate(),
                best.rate, ratio, m.build() * 1000, best.build / m.build(), both, bytes);
        return c.wrong > 0 ? 3 : pass ? 0 : 1;
    }

private:
    static void close(std::FILE* file)
    {
        if (file != nullptr)
            std::fclose(file);
    }
    std::unique_ptr<std::FILE, void (*)(std::FILE*)> data_;
};

/// Measures all asked kinds of map for one set and k. Returns the exit code.
int measure(cpu_backend& b, const clustered_set& which, const data_set& s, uint k, const std::vector<peer>& peers,
    const arguments& a, table& t)
{
    kth_distances known(s.points.size());
    size_t peers_differ = 0;
    std::vector<peer_search> peer_searches;
    for (const auto& p : peers)
        peer_searches.emplace_back(p, s, k, a.threads, a.seconds);
    std::vector<measured> of_peers(peers.size());
    struct asked_map {
        const map_kind& kind;
        map_search search;
        measured m{};
        double bytes = 0; ///< per photon, after the build
        map_search::comparison compared{};
    };
    std::vector<asked_map> maps;
    for (const auto& kind : map_kinds)
        if (a.maps.empty() || has(a.maps, kind.name))
            maps.push_back({kind, map_search(b, s, k, a.seconds)});
    for (int repetition = 0; repetition < 3; ++repetition) {
        for (size_t i = 0; i < peers.size(); ++i) {
            of_peers[i].rates.push_back(peer_searches[i].rate(known, peers_differ));
            of_peers[i].builds.push_back(peers[i].build_seconds);
        }
        for (auto& each : maps) {
            const auto before = b.bytes();
            auto p = upload_photons(b, s);
            map_buffers<cpu_backend> map;
            each.m.builds.push_back(seconds_of([&] {
                map = each.kind.build(b, std::move(p), k);
                b.finish();
            }));
            each.bytes = static_cast<double>(b.bytes() - before) / static_cast<double>(s.positions.size());
            each.m.rates.push_back(each.search.rate(map));
            if (repetition == 0)
                each.compared = each.search.compared_with(known);
        }
    }
    const auto best = best_of(peers, of_peers, s.points.size());
    int worst = 0;
    for (auto& each : maps) {
        each.compared.wrong += peers_differ;
        worst = std::max(worst, t.row(which, k, each.kind, each.m, best, s.points.size(), each.bytes, each.compared));
    }
    return worst;
}

void print_head(const arguments& a)
{
    std::printf("cpu, %u thread%s, %u photons, a search at %s%s\n\n", a.threads, a.threads == 1 ? "" : "s", a.photons,
        a.few_points ? "65536 points, half of them photons" : "each photon",
        a.shuffle ? ", points in random order" : "");
    for (const auto& which : clustered_sets())
        if (is_asked_for(a.sets, which))
            std::printf("- %s: %s\n", which.name, which.what);
    std::printf("\n");
}

int run_clusters(const arguments& a)
{
    cpu_backend b(a.threads);
    print_head(a);
    table t(a.data);
    int worst = 0;
    std::string left_out;
    for (const auto& which : clustered_sets()) {
        if (!is_asked_for(a.sets, which))
            continue;
        auto s = make_clustered_set(which, a.photons);
        if (a.few_points)
            search_at_few_points(s);
        else
            search_at_photons(s);
        if (a.shuffle) {
            std::mt19937 engine(2);
            std::shuffle(s.points.begin(), s.points.end(), engine);
        }
        const auto peers = all_peers(s);
        if (!is_for_cgal(s))
            left_out += std::string(left_out.empty() ? "" : ", ") + which.name;
        for (const uint k : a.k)
            worst = std::max(worst, measure(b, which, s, k, peers, a, t));
    }
    if (!left_out.empty())
        std::printf("\nWithout CGAL, which cannot hold so many equal points: %s\n", left_out.c_str());
    return worst;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_clusters(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    add_set_options(verb, a->sets, a->k, a->photons, a->seconds, a->few_points);
    std::set<std::string> maps;
    for (const auto& kind : map_kinds)
        maps.insert(kind.name);
    verb.add_option("--maps", a->maps, "with commas; all unless given")->delimiter(',')->check(CLI::IsMember(maps));
    verb.add_option("--threads", a->threads)->check(CLI::PositiveNumber);
    verb.add_flag("--shuffle", a->shuffle, "points in random order");
    verb.add_option("--data", a->data, "a file that gets a row for each set, k and map");
    return [a] { return run_clusters(*a); };
}
