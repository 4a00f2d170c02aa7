// Bad input at the interface: each line of the table is a call, the exception that it is documented to throw, and the
// words that name the argument. On every backend, in every build type.
#include "../map/photon_sets.hpp"
#include "wanted_device_tests.hpp"

#include <backends_under_test.hpp>

#include <photongrid/estimate/knn_grid_estimate.hpp>
#include <photongrid/estimate/knn_neighbours.hpp>
#include <photongrid/map/bitonic_sort.hpp>
#include <photongrid/map/map_file.hpp>
#include <photongrid/map/own_photons.hpp>
#include <photongrid/map/pair_value.kernel.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace photongrid::testing {

enum class thrown { nothing, invalid_argument, backend_error, map_file_error, other };

struct bad_call {
    std::string name;
    thrown expected;
    std::string words; ///< in the exception's text
    std::function<void()> call;
};

std::string name_of(thrown t)
{
    constexpr const char* names[]
        = {"nothing", "std::invalid_argument", "backend_error", "map_file_error", "another exception"};
    return names[static_cast<int>(t)];
}

void expect_all(const std::vector<bad_call>& table)
{
    for (const auto& c : table) {
        thrown what = thrown::nothing;
        std::string text;
        try {
            c.call();
        } catch (const map_file_error& e) {
            what = thrown::map_file_error;
            text = e.what();
        } catch (const backend_error& e) {
            what = thrown::backend_error;
            text = e.what();
        } catch (const std::invalid_argument& e) {
            what = thrown::invalid_argument;
            text = e.what();
        } catch (const std::exception& e) {
            what = thrown::other;
            text = e.what();
        }
        EXPECT_EQ(name_of(what), name_of(c.expected)) << c.name << ": " << text;
        EXPECT_NE(text.find(c.words), std::string::npos) << c.name << ": no \"" << c.words << "\" in: " << text;
    }
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
const glm::vec3 zero(0), one(1);

/// A map and query points without mistakes, on a device of their own.
template <class B>
struct good_map {
    B b;
    const photon_set set = make_photons(distribution::uniform, 100, {4, 4, 4}, 1);
    const buffer_of<B, glm::vec4> points = b.upload(std::span<const glm::vec4>(make_points(set, 10, 1)));
    const map_buffers<B> map = sorted_map(b, upload_photons(b, set), set.g);

    /// After mistakes all is as before.
    void expect_that_searches_work()
    {
        EXPECT_EQ(b.download(knn_grid_estimate(b, map, points, {.k = 5}).used)[0].x, 5u);
    }
};

template <class B>
class bad_input : public ::testing::Test {
};
TYPED_TEST_SUITE(bad_input, backends_under_test<::testing::Types>);

TEST(bad_grids, are_named)
{
    expect_all({
        {"a grid of no cells", thrown::invalid_argument, "make_grid: resolution",
            [&] {
                (void)make_grid(zero, one, {0, 4, 4});
            }},
        {"a grid of too many cells", thrown::invalid_argument, "make_grid: resolution",
            [&] {
                (void)make_grid(zero, one, {4096, 4096, 4096});
            }},
        {"a grid upside down", thrown::invalid_argument, "make_grid: low, high: axis 0",
            [&] {
                (void)make_grid(one, zero, {4, 4, 4});
            }},
        {"a grid at NaN", thrown::invalid_argument, "make_grid: low, high",
            [&] {
                (void)make_grid(glm::vec3(nan), one, {4, 4, 4});
            }},
        {"an infinite grid", thrown::invalid_argument, "make_grid: low, high",
            [&] {
                (void)make_grid(zero, glm::vec3(inf), {4, 4, 4});
            }},
    });
}

TYPED_TEST(bad_input, of_passes_and_routing_is_named)
{
    good_map<TypeParam> good;
    auto& b = good.b;
    const auto& set = good.set;
    auto few = b.template make<uint>(3);
    auto pairs = b.template make<glm::uvec2>(8);
    expect_all({
        {"a buffer larger than any device", thrown::backend_error, "elements",
            [&] { (void)b.template make<glm::vec4>(std::size_t{1} << 60); }},
        {"more elements than a pass has", thrown::invalid_argument, "launch: elements",
            [&] { (void)launch(std::size_t{1} << 33); }},
        {"a pass past the end of its output", thrown::invalid_argument, "buffer 'value'",
            [&] { b.template run<kernels::pair_value>(8, {}, reads(pairs), writes(few)); }},
        {"no slots", thrown::invalid_argument, "stencil_route: m: 0",
            [&] { (void)stencil_route(b, upload_photons(b, set), set.g, 0); }},
        {"too many slots", thrown::invalid_argument, "stencil_route: m: 17",
            [&] { (void)routed_map(b, upload_photons(b, set), set.g, 17); }},
        {"a grid too large for the device", thrown::backend_error, "stencil_route: 1000000000 cells",
            [&] {
                (void)routed_map(b, upload_photons(b, set), make_grid(zero, one, {1000, 1000, 1000}), 16);
            }},
    });
    good.expect_that_searches_work();
}

TYPED_TEST(bad_input, of_searches_is_named)
{
    good_map<TypeParam> good;
    auto& b = good.b;
    const auto& map = good.map;
    const auto& points = good.points;
    const auto search
        = [&](const knn_settings& s) { return [&b, &map, &points, s] { (void)knn_grid_estimate(b, map, points, s); }; };
    const auto fixed = [](float r) {
        knn_settings s{.max_radius = r};
        s.search = search_kind::fixed_radius;
        return s;
    };
    knn_settings no_passes{.k = 5, .max_radius = 1};
    no_passes.visits_per_pass = 0;
    expect_all({
        {"k = 0", thrown::invalid_argument, "k: 0", search({.k = 0, .max_radius = 1})},
        {"k = 0, the paper's search", thrown::invalid_argument, "k: 0",
            search(as_paper(knn_settings{.k = 0, .max_radius = 1}))},
        {"a radius of NaN", thrown::invalid_argument, "max_radius", search({.k = 5, .max_radius = nan})},
        {"a least radius of NaN", thrown::invalid_argument, "min_radius",
            search({.k = 5, .max_radius = 1, .min_radius = nan})},
        {"all photons within infinity", thrown::invalid_argument, "max_radius: infinite", search(fixed(inf))},
        {"no visits in a pass", thrown::invalid_argument, "visits_per_pass", search(no_passes)},
        {"a flattening below 1", thrown::invalid_argument, "leaks: flattening",
            search({.k = 5, .max_radius = 1, .leaks = {.flattening = 0.5f}})},
        {"a flattening of NaN", thrown::invalid_argument, "leaks: flattening",
            search({.k = 5, .max_radius = 1, .leaks = {.flattening = nan}})},
        {"a cosine above 1", thrown::invalid_argument, "min_cosine",
            search({.k = 5, .max_radius = 1, .leaks = {.min_cosine = 1.5f}})},
        {"a policy without normals of points", thrown::invalid_argument, "normal of every query point",
            search({.k = 5, .max_radius = 1, .leaks = {.side = true}})},
        {"a policy without directions of photons", thrown::invalid_argument, "photons' directions",
            [&] {
                (void)knn_grid_estimate(b, map, points, points, {.k = 5, .max_radius = 1, .leaks = {.side = true}});
            }},
        {"a policy without normals of photons", thrown::invalid_argument, "photons' surface normals",
            [&] {
                (void)knn_grid_estimate(
                    b, map, points, points, {.k = 5, .max_radius = 1, .leaks = {.min_cosine = 0.5f}});
            }},
        {"lists of 0", thrown::invalid_argument, "k: 0",
            [&] { (void)knn_neighbours(b, map, points, {.k = 0, .max_radius = 1}); }},
        {"lists of too many", thrown::invalid_argument, "k: 4000000000",
            [&] { (void)knn_neighbours(b, map, points, {.k = 4000000000u, .max_radius = 1}); }},
        {"lists of another search", thrown::invalid_argument, "search",
            [&] { (void)knn_neighbours(b, map, points, fixed(1)); }},
    });
    good.expect_that_searches_work();
}

TYPED_TEST(bad_input, of_map_files_is_named)
{
    good_map<TypeParam> good;
    auto& b = good.b;
    const auto& map = good.map;
    expect_all({
        {"a map to nowhere", thrown::map_file_error, "/no/such/folder/map",
            [&] { save_map(b, map, "/no/such/folder/map"); }},
        {"a map from nowhere", thrown::map_file_error, "/no/such/map", [&] { (void)load_map(b, "/no/such/map"); }},
    });
    good.expect_that_searches_work();
}

TYPED_TEST(bad_input, that_is_empty_is_no_mistake)
{
    TypeParam b;
    auto nothing = b.template make<glm::uvec2>(0);
    EXPECT_EQ(bitonic_sort(b, nothing).passes, 0u);
    const auto g = make_grid(glm::vec3(0), glm::vec3(1), {2, 2, 2});
    const auto empty = sorted_map(b, upload_photons(b, photon_set{{}, {}, g}), g);
    EXPECT_EQ(empty.photons.size(), 0u);
    EXPECT_EQ(fitted_map(b, upload_photons(b, photon_set{{}, {}, g}), 5).photons.size(), 0u);
    EXPECT_EQ(routed_map(b, upload_photons(b, photon_set{{}, {}, g}), g, 4).photons.size(), 0u);
    const auto one = upload_points(b, std::vector<glm::vec3>{{0.5f, 0.5f, 0.5f}});
    EXPECT_EQ(
        b.download(knn_grid_estimate(b, empty, one, {.k = 5, .max_radius = 1}).irradiance)[0], glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(b.download(knn_neighbours(b, empty, one, {.k = 2}).ids), (std::vector<uint>{no_id, no_id}));
    const auto none = upload_points(b, std::vector<glm::vec3>{});
    EXPECT_EQ(knn_grid_estimate(b, empty, none, {.k = 5}).irradiance.size(), 0u);
    EXPECT_EQ(knn_neighbours(b, empty, none, {.k = 5}).ids.size(), 0u);
}

/// Backends that have a device each: what one made is not the other's.
TYPED_TEST(bad_input, of_another_backends_buffers_is_refused_or_cannot_be)
{
    TypeParam mine, other;
    const std::vector<glm::uvec2> pairs{{3, 0}, {1, 1}};
    const auto theirs = other.upload(std::span<const glm::uvec2>(pairs));
    auto ids = mine.template make<uint>(2);
    const auto mix = [&] { mine.template run<kernels::pair_value>(2, {}, reads(theirs), writes(ids)); };
    if (mine.caps().backend == "serial" || mine.caps().backend == "cpu") { // all memory is the host's
        mix();
        EXPECT_EQ(mine.download(ids), (std::vector<uint>{0, 1}));
        return;
    }
    auto their_ids = other.template make<uint>(2);
    expect_all({
        {"reading another's buffer", thrown::invalid_argument, "buffer 'pairs' belongs to another backend", mix},
        {"writing another's buffer", thrown::invalid_argument, "buffer 'value' belongs to another backend",
            [&] {
                mine.template run<kernels::pair_value>(
                    2, {}, reads(mine.upload(std::span<const glm::uvec2>(pairs))), writes(their_ids));
            }},
        {"downloading another's buffer", thrown::invalid_argument, "download: b", [&] { (void)mine.download(theirs); }},
    });
}

INSTANTIATE_TYPED_TEST_SUITE_P(all, wanted_device, backends_under_test<::testing::Types>);

} // namespace photongrid::testing
