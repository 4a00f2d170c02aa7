// What routing into buckets of a virtual grid (4.4) saves and costs: memory against that of a stored grid, photons
// dropped, and the error of irradiance estimates against those of all photons, with the error that sampling theory
// predicts. Prints a table per data set of data_sets.hpp.
//
//   hashed_routing [--quick]
#include "device_searches.hpp"

#include <photongrid/backends/cpu/cpu.hpp>
#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/block_map.hpp>
#include <photongrid/map/hashed_route.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

namespace {

using namespace photongrid;
using bench::data_set;
using bench::upload_photons;
using glm::vec4;

double sum_of(const vec4& v) { return static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z); }

/// The estimates of one map at the points, all channels together.
struct estimates {
    std::vector<double> irradiance, squared_error; ///< W/m^2; the squared standard error that the estimate reports
};
estimates estimated(
    cpu_backend& b, const map_buffers<cpu_backend>& map, const buffer_of<cpu_backend, vec4>& points, float radius)
{
    const auto e = knn_grid_estimate(b, map, points,
        {.max_radius = radius, .search = search_kind::fixed_radius, .filter = filter_kind::constant, .errors = true});
    estimates r;
    for (const auto& v : b.download(e.irradiance))
        r.irradiance.push_back(sum_of(v));
    for (const auto& v : b.download(e.standard_error))
        r.squared_error.push_back(static_cast<double>(v.w) * static_cast<double>(v.w));
    return r;
}

/// Per point: the variance that thinning adds to the irradiance by hash (hashed_route.hpp).
std::vector<double> predicted(const data_set& s, const std::vector<vec4>& points, const virtual_grid& g,
    const std::vector<uint>& arrived, uint capacity, float radius)
{
    std::vector<uint> bucket; // per photon, as hashed_bucket.glsl
    for (const auto& p : s.positions) {
        const auto c = kernels::cell_coordinates(g.axes, p);
        bucket.push_back(kernels::scrambled(kernels::scrambled(kernels::scrambled(c.x) + c.y) + c.z)
            % static_cast<uint>(arrived.size()));
    }
    const double per_area = 1 / (3.14159265358979 * static_cast<double>(radius) * static_cast<double>(radius));
    std::vector<double> variance, y(arrived.size()), y2(arrived.size());
    for (const auto& point : points) {
        std::vector<uint> met; // buckets with photons within the radius
        for (std::size_t i = 0; i < s.positions.size(); ++i) {
            const glm::vec3 d = glm::vec3(s.positions[i]) - glm::vec3(point);
            if (d.x * d.x + d.y * d.y + d.z * d.z > radius * radius)
                continue;
            const double irradiance = per_area * sum_of(s.powers[i]);
            met.push_back(bucket[i]);
            y[bucket[i]] += irradiance;
            y2[bucket[i]] += irradiance * irradiance;
        }
        double all = 0;
        for (const uint at : met) {
            const auto n = static_cast<double>(arrived[at]), k = std::min(n, static_cast<double>(capacity));
            if (n > k)
                all += n * n * (1 - k / n) / k * (y2[at] - y[at] * y[at] / n) / (n - 1);
            y[at] = y2[at] = 0; // a bucket that is met again adds nothing
        }
        variance.push_back(all);
    }
    return variance;
}

void measure(cpu_backend& b, const data_set& s, std::size_t most_points, uint seeds)
{
    const auto n = static_cast<uint>(s.positions.size());
    std::vector<vec4> points;
    for (std::size_t i = 0; i < most_points; ++i)
        points.push_back(s.points[i * s.points.size() / most_points]);
    const auto at = b.upload(std::span<const vec4>(points));
    const float radius = std::sqrt(static_cast<float>(s.k) / static_cast<float>(n)); // about 3 k photons per m^2
    const auto exact = estimated(b, block_map(b, upload_photons(b, s)), at, radius);
    const auto relative = [&](const std::vector<double>& squares) { // as relMSE: the mean over points
        double sum = 0;
        for (std::size_t q = 0; q < squares.size(); ++q)
            sum += squares[q] / (exact.irradiance[q] * exact.irradiance[q] + 1e-12);
        return sum / static_cast<double>(squares.size());
    };
    const auto row = [&](uint cells, hashed_route_settings settings) {
        const auto g = make_virtual_grid(glm::vec3(0), glm::vec3(1), glm::uvec3(cells));
        const bool ranked = settings.kind == bucket_kind::rank;
        const uint capacity = route_capacity(settings.m);
        std::vector<double> squares(points.size()), errors(points.size()), variance;
        std::size_t buckets = 0;
        double dropped = 0;
        for (uint seed = 0; seed < seeds; ++seed) {
            settings.seed = seed;
            auto r = hashed_route(b, upload_photons(b, s), g, settings);
            buckets = r.arrived.size();
            dropped = static_cast<double>(r.dropped) / n;
            if (!ranked && variance.empty())
                variance = predicted(s, points, g, b.download(r.arrived), capacity, radius);
            const auto e = estimated(b, block_map(b, std::move(r.photons)), at, radius);
            for (std::size_t q = 0; q < points.size(); ++q) {
                const double off = e.irradiance[q] - exact.irradiance[q];
                squares[q] += off * off / seeds;
                errors[q] += e.squared_error[q] / seeds;
            }
        }
        const double per_bucket = 4.0 * capacity + (ranked ? 190 : 80); // hashed_route.hpp
        char theory[32] = "";
        if (!ranked)
            std::snprintf(theory, sizeof theory, "%.2e", relative(variance));
        std::printf("| %u | %s | %u | %zu | %.2f | %.3g | %.1f %% | %.2e | %s | %.2e |\n", cells,
            ranked ? "rank" : "hash", settings.m, buckets, static_cast<double>(buckets) * per_bucket / (1 << 20),
            static_cast<double>(cell_count(g)) * 4.0 * capacity / (1 << 30), 100 * dropped, relative(squares), theory,
            relative(errors));
    };
    std::printf("%s: %s. Radius %.3g m; relative squared standard error of all photons %.2e\n\n"
                "| cells an axis | buckets by | m | number | MiB of buckets | GiB of a stored grid's slots | dropped "
                "| relMSE of %u seeds | predicted | its own squared standard error |\n"
                "|---|---|---|---|---|---|---|---|---|---|\n",
        s.name.c_str(), s.what.c_str(), static_cast<double>(radius), relative(exact.squared_error), seeds);
    for (const uint m : {1u, 2u, 4u}) {
        for (const uint cells : {1000u, 200u, 50u})
            row(cells, {.kind = bucket_kind::rank, .m = m});
        const uint room = n / route_capacity(m); // buckets that hold all photons if all are full
        for (const uint buckets : {0u, room, room / 2, room / 8})
            row(1000, {.kind = bucket_kind::hash, .m = m, .buckets = buckets});
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
try {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    cpu_backend b;
    for (const int set : quick ? std::vector<int>{1} : std::vector<int>{1, 2, 3})
        measure(b, bench::make_data_set(set), quick ? 20 : 300, quick ? 3 : 50);
} catch (const std::exception& e) {
    std::fprintf(stderr, "hashed_routing: %s\n", e.what());
    return 2;
}
