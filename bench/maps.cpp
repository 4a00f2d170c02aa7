// Which map suits photons in clusters (clustered_sets.hpp) on each backend: searches for the k nearest in a grid map
// whose grid fits the photons, in a block map, and in the one that fitted_map chooses. docs/reference/measures.md.
//
// A map takes every n-th run of 64 points so that it ends within S seconds, or all if it ends within 4 S seconds. The
// maps of a row are searched in turn, three times each, and medians are compared. Exits 1 where the chosen map is more
// than 1.2 times as slow as the better one.
#include "backends.hpp"
#include "clustered_sets.hpp"
#include "device_searches.hpp"
#include "point_runs.hpp"

#include <photongrid/map/map_builders.hpp>

#include <algorithm>
#include <cstdio>

namespace {

using namespace photongrid;
using namespace photongrid::bench;
using std::size_t;

constexpr double slowest_choice = 1.2; // times the better map's time

struct arguments {
    std::vector<std::string> sets, backends{"cpu", "gl", "vulkan"};
    std::vector<uint> k{10, 50};
    uint photons = 65536;
    double seconds = 0.2;
    bool few_points = false;
};

/// A map's searches, at as many of the points as take the given time.
template <backend B>
class timed_map {
public:
    timed_map(B& b, map_buffers<B> map, const std::vector<vec4>& points, const knn_settings& s, double seconds)
        : b_(b), map_(std::move(map)), settings_(s), seconds_(seconds)
    {
        std::optional<knn_estimates<B>> compiled; // kernels compile the first time
        const auto uploaded_of = [&](const point_runs& runs) {
            std::vector<vec4> taken;
            for (size_t r = 0; r < runs.count(); ++r)
                taken.insert(taken.end(), points.begin() + static_cast<std::ptrdiff_t>(runs.begin(r)),
                    points.begin() + static_cast<std::ptrdiff_t>(runs.end(r)));
            return b.upload(std::span<const vec4>(taken));
        };
        const auto some = uploaded_of({std::min<size_t>(points.size(), 64), 1});
        compiled = knn_grid_estimate(b, map_, some, settings_);
        b.finish();
        const auto runs = fitting_runs(points.size(), seconds, 4 * seconds, [&](const point_runs& r) {
            const auto taken = uploaded_of(r);
            return seconds_of([&] {
                compiled = knn_grid_estimate(b, map_, taken, settings_);
                b.finish();
            });
        });
        points_ = uploaded_of(runs);
        last_ = std::move(compiled);
    }
    void search() { rates_.push_back(points_per_second(b_, map_, points_, settings_, seconds_ / 4, last_)); }
    double rate() const { return median(rates_); }
    const map_buffers<B>& map() const { return map_; }

private:
    B& b_;
    map_buffers<B> map_;
    knn_settings settings_;
    double seconds_;
    buffer_of<B, vec4> points_;
    std::optional<knn_estimates<B>> last_;
    std::vector<double> rates_;
};

/// Prints a backend's rows. Returns whether every choice was good.
template <backend B>
bool measure(B& b, const arguments& a)
{
    bool all_good = true;
    for (const auto& which : clustered_sets()) {
        if (!is_asked_for(a.sets, which))
            continue;
        auto s = make_clustered_set(which, a.photons);
        if (a.few_points)
            search_at_few_points(s);
        else
            search_at_photons(s);
        for (const uint k : a.k) {
            const knn_settings settings{.k = k, .max_radius = 1e18f};
            auto photons_of_grid = upload_photons(b, s);
            const grid g = fitting_grid(b, photons_of_grid, k, b.caps().cells_per_radius);
            timed_map<B> in_grid(b, sorted_map(b, std::move(photons_of_grid), g), s.points, settings, a.seconds),
                in_blocks(b, block_map(b, upload_photons(b, s)), s.points, settings, a.seconds),
                chosen(b, fitted_map(b, upload_photons(b, s), k), s.points, settings, a.seconds);
            for (int i = 0; i < 3; ++i)
                for (auto* map : {&in_grid, &in_blocks, &chosen})
                    map->search();
            // The same map can be slower by chance only, so the chosen kind is what counts.
            const bool chose_blocks = chosen.map().has_blocks();
            const double better = std::max(in_grid.rate(), in_blocks.rate()),
                         kind = chose_blocks ? in_blocks.rate() : in_grid.rate();
            const bool good = std::max(kind, chosen.rate()) * slowest_choice >= better;
            all_good = all_good && good;
            std::printf("| %s | %s | %u | %.4g | %.4g | %.3g | %s | %.4g | %.2f | %s |\n", b.caps().backend.c_str(),
                which.name, k, in_grid.rate() / 1000, in_blocks.rate() / 1000, in_blocks.rate() / in_grid.rate(),
                chose_blocks ? "blocks" : "grid", chosen.rate() / 1000, better / kind, good ? "PASS" : "FAIL");
            std::fflush(stdout);
        }
    }
    return all_good;
}

int run_maps(const arguments& a)
{
    std::printf("%u photons in each set, searches at %s\n\n", a.photons,
        a.few_points ? "65,536 points, half of them photons" : "each photon, or every n-th run of 64");
    std::printf(
        "| backend | set | k | grid, 1000/s | blocks, 1000/s | blocks over grid | chosen | chosen, 1000/s | "
        "time of the chosen kind over the better's | at most %.1f |\n|---|---|---|---|---|---|---|---|---|---|\n",
        slowest_choice);
    bool all_good = true;
    for (const auto& name : a.backends)
        all_good = on_backend(name, [&](auto&& b) { return measure(b, a); }) && all_good;
    return all_good ? 0 : 1;
}

} // namespace

photongrid::bench::verb_run photongrid::bench::add_maps(CLI::App& verb)
{
    const auto a = std::make_shared<arguments>();
    add_set_options(verb, a->sets, a->k, a->photons, a->seconds, a->few_points);
    verb.add_option("--backends", a->backends, "with commas")->delimiter(',')->check(CLI::IsMember(backend_names));
    return [a] { return run_maps(*a); };
}
