// Density and nearest neighbours of a point cloud that has nothing to do with photons: a forest of 200,000 trees, 500
// per hectare in the west and 150 in the east, where they are taller.
#include "forest.hpp"

#include <photongrid/backends/serial/serial.hpp>

#include <cstdio>
#include <random>

int main()
{
    std::mt19937 random(2003);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<tree> trees;
    while (trees.size() < 200000) {
        const tree t{2500 * unit(random), 2500 * unit(random), 0};
        const bool west = t.east < 1250;
        if (unit(random) < (west ? 1.0 : 0.3))
            trees.push_back(
                {t.east, t.north, static_cast<float>(west ? 12 + 4 * unit(random) : 22 + 8 * unit(random))});
    }
    photongrid::serial_backend device; // change this line to survey it on another backend
    const std::vector<glm::vec3> queries{{400, 1200, 0}, {1100, 300, 0}, {2000, 700, 0}};
    const auto surveys = survey_forest(device, trees, queries, 200);
    for (std::size_t p = 0; p < queries.size(); ++p) {
        const auto& s = surveys[p];
        std::printf("%4.0f m east, %4.0f m north: %3.0f +- %2.0f trees per hectare, %4.1f m high; the nearest is tree "
                    "%6u, %.1f m away\n",
            static_cast<double>(queries[p].x), static_cast<double>(queries[p].y),
            static_cast<double>(s.trees_per_hectare), static_cast<double>(s.standard_error),
            static_cast<double>(s.mean_height), s.nearest[0], static_cast<double>(s.distances[0]));
    }
}
