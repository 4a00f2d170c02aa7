// Every number of a scene, made bad one at a time: the scene is refused, and the message names the part. And every
// setting just outside of its range. The file is long because it lists all of them.
#include "test_scenes.hpp"

#include <photongrid/scene/setting_table.hpp>
#include <photongrid/trace/device_scene.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace photongrid::testing {
namespace {

    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

    /// A number of a scene, and how to find it in a copy.
    struct number {
        std::string part; ///< "spheres[1]"
        std::string name; ///< "center", as the message should have it
        std::function<double&(scene&)> in;
        quantity of = quantity::point;
    };

    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of, const dvec3&,
        const std::function<dvec3&(scene&)>& in)
    {
        for (int c = 0; c < 3; ++c)
            all.push_back({part, name, [in, c](scene& s) -> double& { return in(s)[c]; }, of});
    }
    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of, double,
        const std::function<double&(scene&)>& in)
    {
        all.push_back({part, name, in, of});
    }
    void add_numbers(std::vector<number>& all, const std::string& part, const char* name, quantity of,
        const std::vector<dvec3>& points, const std::function<std::vector<dvec3>&(scene&)>& in)
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int c = 0; c < 3; ++c)
                all.push_back({part, name, [in, i, c](scene& s) -> double& { return in(s)[i][c]; }, of});
    }

    template <class List>
    void add_parts(std::vector<number>& all, List& list, const auto& kind, const auto& find)
    {
        for (std::size_t i = 0; i < list.size(); ++i)
            for_each_field(kind.fields, [&](const auto& f) {
                using value = std::remove_cvref_t<decltype(list[i].*f.member)>;
                add_numbers(all, std::string(kind.list) + "[" + std::to_string(i) + "]", f.name, f.of,
                    list[i].*f.member,
                    std::function<value&(scene&)>([find, i, f](scene& of) -> value& { return find(of)[i].*f.member; }));
            });
    }

    /// Every number of shapes and lights.
    std::vector<number> numbers_of(scene& s)
    {
        std::vector<number> all;
        for_each_shape(s, [&]<class List>(List& list, auto kind) {
            add_parts(all, list, kind, [](scene& of) -> List& { return std::get<List&>(shape_lists(of)); });
        });
        for_each_light(s, [&]<class List>(List& list, auto kind) {
            add_parts(all, list, kind, [](scene& of) -> List& { return std::get<List&>(light_lists(of)); });
        });
        return all;
    }

    /// What check() says; empty: nothing.
    std::string refusal_of(const scene& s)
    {
        try {
            check(s);
            return {};
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
    }

    void expect_refused(const scene& good, const number& n, double bad)
    {
        auto s = good;
        n.in(s) = bad;
        const auto said = refusal_of(s);
        EXPECT_NE(said, "") << n.part << "." << n.name << " = " << bad;
        EXPECT_NE(said.find(n.part), std::string::npos) << said;
        EXPECT_THROW(lay_out(s), std::invalid_argument);
    }

    TEST(bad_scenes, no_number_may_be_nan_or_infinite)
    {
        auto s = all_shapes();
        ASSERT_EQ(refusal_of(s), "");
        const auto numbers = numbers_of(s);
        EXPECT_GE(numbers.size(), 100u);
        for (const auto& n : numbers)
            for (const double bad : {nan, infinity, -infinity})
                expect_refused(s, n, bad);
    }

    TEST(bad_scenes, lengths_are_positive_and_powers_not_negative)
    {
        auto s = all_shapes();
        int lengths = 0, powers = 0;
        for (const auto& n : numbers_of(s)) {
            if (n.of == quantity::length) {
                ++lengths;
                for (const double bad : {0.0, -0.0, -1.0, -1e-300})
                    expect_refused(s, n, bad);
            } else if (n.of == quantity::power) {
                ++powers;
                expect_refused(s, n, -1e-300);
                expect_refused(s, n, -1.0);
            }
        }
        EXPECT_GE(lengths, 6);
        EXPECT_EQ(powers, 6);
    }

    TEST(bad_scenes, directions_and_edges_have_a_length)
    {
        auto s = all_shapes();
        const auto expect = [&](const char* what, const std::function<void(scene&)>& spoil, const char* part) {
            auto bad = s;
            spoil(bad);
            const auto said = refusal_of(bad);
            EXPECT_NE(said.find(part), std::string::npos) << what << ": " << said;
        };
        expect(
            "lamp without area", [](scene& x) { x.rectangle_lights[0].edge_u = dvec3(0); }, "rectangle_lights[0]");
        expect(
            "lamp with one direction", [](scene& x) { x.rectangle_lights[0].edge_v = x.rectangle_lights[0].edge_u; },
            "rectangle_lights[0]");
        expect(
            "skew lamp", [](scene& x) { x.rectangle_lights[0].edge_v.x += 0.01; }, "rectangle_lights[0]");
        expect(
            "dark lamp", [](scene& x) { x.rectangle_lights[0].power = dvec3(0); }, "rectangle_lights[0]");
        expect(
            "dark bulb", [](scene& x) { x.point_lights[0].power = dvec3(0); }, "point_lights[0]");
        expect(
            "disk without a normal", [](scene& x) { x.disks[0].normal = dvec3(0); }, "disks[0]");
        expect(
            "polygon of two corners", [](scene& x) { x.polygons[1].vertices.pop_back(); }, "polygons[1]");
        expect(
            "material that is not there", [](scene& x) { x.cones[0].material = 99; }, "cones[0].material");
        expect(
            "no axis", [](scene& x) { x.cylinders[0].top = x.cylinders[0].base; }, "cylinders[0]");
        expect(
            "no axis", [](scene& x) { x.cones[0].apex = x.cones[0].base; }, "cones[0]");
        expect(
            "no axis", [](scene& x) { x.paraboloids[0].rim = x.paraboloids[0].vertex; }, "paraboloids[0]");
        expect(
            "flat box", [](scene& x) { x.boxes[0].edge_w = dvec3(0); }, "boxes[0]");
        expect(
            "skew box", [](scene& x) { x.boxes[0].edge_w = x.boxes[0].edge_u; }, "boxes[0]");
        expect(
            "polygon that is not flat", [](scene& x) { x.polygons[0].vertices[2].y += 0.5; }, "polygons[0]");
        expect(
            "polygon without area",
            [](scene& x) {
                x.polygons[1].vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
            },
            "polygons[1]");
    }

    TEST(bad_scenes, materials_and_cameras_are_checked)
    {
        const auto good = all_shapes();
        const auto refused = [&](const char* part, const std::function<double&(scene&)>& number, double bad) {
            auto s = good;
            number(s) = bad;
            const auto said = refusal_of(s);
            EXPECT_NE(said.find(part), std::string::npos) << bad << ": " << said;
        };
        for (std::size_t m = 0; m < good.materials.size(); ++m)
            for (int c = 0; c < 3; ++c)
                for (const double bad : {nan, infinity, -infinity, -1e-300, 1 + 1e-15})
                    refused(("materials[" + std::to_string(m) + "].reflectance").c_str(),
                        [m, c](scene& s) -> double& { return s.materials[m].reflectance[c]; }, bad);
        for (const double bad : {nan, infinity, -infinity, 0.0, 1 - 1e-15, 10 + 1e-14})
            refused(
                "materials[2].index_of_refraction",
                [](scene& s) -> double& { return s.materials[2].index_of_refraction; }, bad);
        for (int c = 0; c < 3; ++c)
            for (const double bad : {nan, infinity, -infinity}) {
                refused(
                    "position", [c](scene& s) -> double& { return s.camera.position[c]; }, bad);
                refused(
                    "look_at", [c](scene& s) -> double& { return s.camera.look_at[c]; }, bad);
                refused(
                    "up", [c](scene& s) -> double& { return s.camera.up[c]; }, bad);
            }
        for (const double bad : {nan, infinity, -infinity, 0.0, -1.0, 179.0})
            refused(
                "vertical_fov", [](scene& s) -> double& { return s.camera.vertical_fov; }, bad);
    }

    // Settings: the ends of each range serve, and what lies beyond them is refused by the setting's name.

    void expect_setting(const auto& row, const auto& change, bool good)
    {
        render_settings s;
        change(row.of(s));
        std::string said;
        try {
            check(s);
        } catch (const std::invalid_argument& e) {
            said = e.what();
        }
        if (good)
            EXPECT_EQ(said, "") << row.name;
        else
            EXPECT_EQ(said.find(std::string(row.name) + ":"), 0u) << row.name << " is accepted, or: " << said;
    }

    TEST(bad_settings, each_is_refused_outside_of_its_range)
    {
        int rows = 0;
        for_each_setting([&](const auto& row) {
            namespace t = setting_table;
            using values = std::remove_cvref_t<decltype(row.values)>;
            const auto is = [&](auto value, bool good) {
                expect_setting(
                    row, [&](auto& v) { v = static_cast<std::remove_cvref_t<decltype(v)>>(value); }, good);
            };
            ++rows;
            if constexpr (std::is_same_v<values, t::whole_range>) {
                is(row.values.least, true);
                is(row.values.most, true);
                if (row.values.least > 0)
                    is(row.values.least - 1, false);
                if (row.values.most < 0xFFFFFFFFu)
                    is(row.values.most + 1, false);
            } else if constexpr (std::is_same_v<values, t::real_or_auto>) {
                const auto& range = row.values.range;
                is(std::optional<double>(), true);
                is(std::optional(range.least), true);
                is(std::optional(range.most), true);
                for (const double bad : {std::nextafter(range.least, -infinity), std::nextafter(range.most, infinity),
                         nan, infinity, -infinity})
                    is(std::optional(bad), false);
            } else if constexpr (std::is_same_v<values, t::any_length>) {
                is(1e-9, true);
                for (const double bad : {0.0, -1.0, nan, infinity, -infinity})
                    is(bad, false);
            } else if constexpr (std::is_same_v<values, t::cells>) {
                is(glm::uvec3(0), true);
                is(glm::uvec3(1), true);
                is(glm::uvec3(row.values.most_per_axis, 1, 1), true);
                is(glm::uvec3(2048, 1024, 1024), true);
                is(glm::uvec3(2048, 1025, 1024), false);
                for (int axis = 0; axis < 3; ++axis) {
                    glm::uvec3 v(1);
                    v[axis] = row.values.most_per_axis + 1;
                    is(v, false);
                    v[axis] = 0;
                    is(v, false);
                }
            } else if constexpr (std::is_same_v<values, t::pixels>) {
                for (const auto member : {&output_settings::width, &output_settings::height})
                    for (const std::uint32_t n : {0u, 1u, row.values.most, row.values.most + 1})
                        expect_setting(
                            row, [&](auto& v) { v.*member = n; }, n >= 1 && n <= row.values.most);
            } else if constexpr (std::is_same_v<values, t::policies>) {
                for (const auto member : {&leak_policy::min_cosine, &leak_policy::flattening})
                    for (const float bad : {std::nanf(""), static_cast<float>(infinity), -static_cast<float>(infinity)})
                        expect_setting(
                            row, [&](auto& v) { v.*member = bad; }, false);
                expect_setting(
                    row, [&](auto& v) { v.min_cosine = 1.0001f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.min_cosine = -1.0001f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.flattening = 0.9999f; }, false);
                expect_setting(
                    row, [&](auto& v) { v.flattening = 1.1e6f; }, false);
            } else {
                for (const auto& n : row.values.values)
                    if (row.name != std::string("edge_correction"))
                        is(n.value, true);
                is(100, false);
            }
        });
        EXPECT_GE(rows, 20);
    }

    TEST(bad_settings, edge_correction_needs_min_cosine)
    {
        render_settings s;
        s.estimate.edges = edge_correction::polygons;
        s.estimate.leaks.min_cosine = 0.5f;
        EXPECT_NO_THROW(check(s));
        s.estimate.leaks.min_cosine = 0;
        EXPECT_THROW(check(s), std::invalid_argument);
    }

} // namespace
} // namespace photongrid::testing
