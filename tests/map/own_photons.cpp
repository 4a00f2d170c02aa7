// Photons of a caller's own types, with the caller's own vectors.
#include "../backends/serial_algorithms.hpp"

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/map/map_builders.hpp>
#include <photongrid/map/own_photons.hpp>

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace foreign {

struct vector {
    double x, y, z;
};
/// Names that photongrid looks for, vectors of every kind.
struct hit {
    int id;
    vector position;
    std::array<float, 3> power;
    glm::vec3 direction;
    float normal[3];
    bool caustic;
};
/// Names that it does not know.
struct particle {
    double where[3];
    float mass;
};
/// One number in place of three.
struct grey {
    float position[3];
    float power;
};
struct stranger {
    int i;
};

} // namespace foreign

template <>
struct photongrid::photon_reader<foreign::particle> {
    static auto position(const foreign::particle& p) { return std::span(p.where); }
    static float power(const foreign::particle& p) { return p.mass; }
};

namespace photongrid::testing {

static_assert(own_photon<foreign::hit> && own_photon<foreign::particle> && own_photon<foreign::grey>);
static_assert(!own_photon<foreign::stranger> && !own_photon<int> && !own_photon<std::string>);

TEST(own_photons, keep_every_attribute_in_its_place)
{
    serial_backend b;
    const std::vector<foreign::hit> own{{7, {1, 2, 3}, {4, 5, 6}, {0, 1, 0}, {0, 0, 1}, true},
        {8, {-1, -2, -3}, {7, 8, 9}, {1, 0, 0}, {0, 1, 0}, false}};
    const auto p = upload_photons(b, own);
    using vectors = std::vector<glm::vec4>;
    EXPECT_EQ(b.download(p.positions), (vectors{{1, 2, 3, 1}, {-1, -2, -3, 0}}));
    EXPECT_EQ(b.download(p.powers), (vectors{{4, 5, 6, 0}, {7, 8, 9, 0}}));
    EXPECT_EQ(b.download(p.directions), (vectors{{0, 1, 0, 0}, {1, 0, 0, 0}}));
    EXPECT_EQ(b.download(p.normals), (vectors{{0, 0, 1, 0}, {0, 1, 0, 0}}));
    EXPECT_EQ(upload_photons(b, std::vector<foreign::hit>{}).size(), 0u);
}

TEST(own_photons, come_back_by_their_places_in_the_callers_range)
{
    serial_backend b;
    std::array<foreign::particle, 100> own;
    for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = {{static_cast<double>(i * 37 % 100) / 100, 0.5, 0.5}, static_cast<float>(i)};
    auto p = upload_photons(b, std::span<const foreign::particle>(own));
    EXPECT_EQ(p.directions.size() + p.normals.size(), 0u);
    const auto map = sorted_map(b, std::move(p), make_grid(glm::vec3(0), glm::vec3(1), {10, 1, 1}));
    const auto list = b.download(map.list);
    const auto positions = b.download(map.photons.positions);
    for (std::size_t i = 0; i < list.size(); ++i)
        EXPECT_EQ(positions[i].x, static_cast<float>(own[list[i]].where[0]));
    // Mass within 0.025 of 0.5: the particles at 0.48 to 0.52.
    double mass = 0;
    for (const auto& o : own)
        mass += std::abs(o.where[0] - 0.5) < 0.025 ? static_cast<double>(o.mass) : 0.0;
    const std::vector<glm::vec4> points{{0.5f, 0.5f, 0.5f, 1.0f}};
    knn_settings s{.max_radius = 0.025f};
    s.search = search_kind::fixed_radius;
    const auto e = knn_grid_estimate(b, map, b.upload(std::span<const glm::vec4>(points)), s);
    EXPECT_EQ(b.download(e.used)[0].x, 5u);
    EXPECT_NEAR(b.download(e.irradiance)[0].y, mass / (M_PI * 0.025 * 0.025), 1e-5 * mass / (M_PI * 0.025 * 0.025));
}

} // namespace photongrid::testing
