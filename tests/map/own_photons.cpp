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

/// The throw's message, or "".
template <class F>
std::string refusal(const F& f)
{
    try {
        f();
        return {};
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
}

/// 100 x 100 photons on a square, `apart` m from each other.
template <class V>
std::vector<V> square_at(glm::dvec3 corner, double apart)
{
    using number = std::remove_cvref_t<decltype(std::declval<V&>().x)>;
    std::vector<V> all;
    for (int i = 0; i < 10000; ++i)
        all.push_back({static_cast<number>(corner.x + apart * (i % 100)),
            static_cast<number>(corner.y + apart * (i / 100)), static_cast<number>(corner.z)});
    return all;
}

/// Single precision rounds 5,400,000.1 to the next half.
TEST(own_photons, doubles_that_single_precision_would_merge_are_refused)
{
    serial_backend b;
    const glm::dvec3 utm(5e5, 5.4e6, 310);
    const auto photons_of = [](const std::vector<foreign::vector>& places) {
        std::vector<foreign::hit> all;
        for (const auto& p : places)
            all.push_back({0, p, {1, 1, 1}, {0, 0, -1}, {0, 0, 1}, false});
        return all;
    };
    const auto places = square_at<foreign::vector>(utm, 0.1);
    const auto said = refusal([&] { upload_photons(b, photons_of(places)); });
    EXPECT_EQ(said.find("upload_photons: positions: single precision moves coordinates by up to 0.2"), 0u) << said;
    EXPECT_NE(said.find("subtract an origin"), std::string::npos) << said;
    EXPECT_EQ(refusal([&] { upload_points(b, places); }).find("upload_points: points: "), 0u);

    // What loses nothing, or little, is accepted.
    EXPECT_EQ(refusal([&] { upload_points(b, square_at<foreign::vector>(glm::dvec3(0), 0.1)); }), "");
    EXPECT_EQ(refusal([&] { upload_points(b, square_at<foreign::vector>(utm, 0.5)); }), "") << "exact in floats";
    EXPECT_EQ(refusal([&] { upload_points(b, square_at<foreign::vector>(utm, 5.1)); }), "") << "coarse enough";
    EXPECT_EQ(refusal([&] { upload_points(b, square_at<glm::vec3>(utm, 0.1)); }), "") << "floats already";
    EXPECT_EQ(refusal([&] { upload_points(b, square_at<foreign::vector>({3, 4, 5}, 1e-5)); }), "") << "a small thing";
    EXPECT_EQ(refusal([&] { upload_points(b, std::vector<foreign::vector>(100, places[1])); }), "") << "one place";
    EXPECT_EQ(refusal([&] { upload_normals(b, places); }), "") << "no positions";
    auto with_strays = square_at<foreign::vector>(glm::dvec3(0), 0.1);
    with_strays[5000] = {1e12 + 0.1, 1e300, std::numeric_limits<double>::quiet_NaN()};
    with_strays[7000] = {1e12 + 0.1, 1e300, 0};
    EXPECT_EQ(refusal([&] { upload_points(b, with_strays); }), "") << "strays decide nothing";
    with_strays = places;
    for (std::size_t i = 0; i < with_strays.size(); i += 100)
        with_strays[i] = {0, 0, 0};
    EXPECT_NE(refusal([&] { upload_points(b, with_strays); }), "") << "strays decide nothing";
}

} // namespace photongrid::testing
