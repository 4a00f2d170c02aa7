// One query at a time on one thread, as a path tracer asks: photon_map and nanoflann, 1,000,000 points, queries in
// random order. Seconds are CPU time of the thread; rounds take turns and the least time counts.
//
//   single_query [POINTS [QUERIES [ROUNDS]]]
#include <photongrid/backends/serial/serial.hpp>
#include <photongrid/photon_map.hpp>

#include <nanoflann.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>

namespace {

struct host_photon {
    glm::vec3 position;
    float power;
};

struct cloud {
    const std::vector<host_photon>& points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i].position[static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

double cpu_seconds()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Random points on the six walls of a room, where photons and path vertices lie.
std::vector<host_photon> on_walls(std::size_t n, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<host_photon> points(n);
    for (auto& p : points) {
        p = {{unit(random), unit(random), unit(random)}, 1.0f};
        const int wall = static_cast<int>(6 * unit(random)) % 6;
        p.position[wall / 2] = static_cast<float>(wall % 2);
    }
    return points;
}

} // namespace

int main(int argc, char** argv)
{
    const auto number = [&](int i, std::size_t otherwise) {
        return argc > i ? static_cast<std::size_t>(std::strtoull(argv[i], nullptr, 10)) : otherwise;
    };
    const std::size_t n = number(1, 1000000), queries = number(2, 100000), rounds = number(3, 5);
    const auto points = on_walls(n, 1), query_points = on_walls(queries, 2);
    const cloud data{points};
    using tree_type
        = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3, unsigned>;
    tree_type tree(3, data, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    tree.buildIndex();
    std::printf(
        "| k | nanoflann, us | for_each_nearest, us | times as fast | irradiance, us |\n|---|---|---|---|---|\n");
    for (const photongrid::uint k : {10u, 100u}) {
        photongrid::serial_backend device;
        const photongrid::photon_map map(device, points, {.k = k});
        photongrid::query_scratch scratch;
        std::vector<unsigned> ids(k);
        std::vector<float> distances2(k);
        double best[3] = {1e9, 1e9, 1e9};
        double check[3] = {};
        for (std::size_t round = 0; round < rounds; ++round) {
            double begin = cpu_seconds();
            check[0] = 0;
            for (const auto& p : query_points) {
                nanoflann::KNNResultSet<float, unsigned> result(k);
                result.init(ids.data(), distances2.data());
                tree.findNeighbors(result, &p.position.x, nanoflann::SearchParams());
                check[0] += static_cast<double>(distances2[k - 1]);
            }
            best[0] = std::min(best[0], cpu_seconds() - begin);
            begin = cpu_seconds();
            check[1] = 0;
            for (const auto& p : query_points) {
                float last = 0;
                map.for_each_nearest(
                    p.position, k, scratch, [&](photongrid::photon_id, float distance2) { last = distance2; });
                check[1] += static_cast<double>(last);
            }
            best[1] = std::min(best[1], cpu_seconds() - begin);
            begin = cpu_seconds();
            for (const auto& p : query_points)
                check[2] += static_cast<double>(map.irradiance(p.position, glm::vec3(0), scratch).value.x);
            best[2] = std::min(best[2], cpu_seconds() - begin);
        }
        const double to_us = 1e6 / static_cast<double>(queries);
        std::printf("| %u | %.2f | %.2f | %.2f | %.2f |\n", k, best[0] * to_us, best[1] * to_us, best[0] / best[1],
            best[2] * to_us);
        if (std::abs(check[0] - check[1]) > 1e-5 * check[0] || !(check[2] > 0)) {
            std::printf("FAIL: distances add up to %g and %g\n", check[0], check[1]);
            return 1;
        }
    }
}
