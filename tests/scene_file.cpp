// The reader of scene files: what it takes, and the place and words of every kind of refusal.
#include "scene_file.hpp"
#include "scene_writer.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace photongrid {
namespace {

    const std::string scenes = PHOTONGRID_SCENES;

    /// A scene of which every line is known: 4 camera, 6 and 7 materials, 9 and 10 shapes, 12 light, 13 render.
    const std::vector<std::string> good = {
        R"({"photongrid": 1,)",
        R"( "name": "small",)",
        R"( "units": {"length": "m", "power": "W"},)",
        R"( "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0], "vertical_fov": 40},)",
        R"( "materials": {)",
        R"(  "white": {"type": "lambertian", "reflectance": [0.7, 0.6, 0.5]},)",
        R"(  "clear": {"type": "glass", "index_of_refraction": 1.5}},)",
        R"( "shapes": [)",
        R"(  {"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "clear"},)",
        R"(  {"type": "polygon", "vertices": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], "material": "white"}],)",
        R"( "lights": [)",
        R"(  {"type": "point", "name": "lamp", "position": [0, 3, 0], "power": [10, 20, 30]}],)",
        R"( "render": {"size": [64, 48], "photons": 1000, "k": 20, "grid": [4, 1, 4], "max_radius": 0.25}})",
    };

    std::string text(const std::vector<std::string>& lines)
    {
        std::string all;
        for (const auto& l : lines)
            all += l + "\n";
        return all;
    }

    /// What the reader says of `content`, or "" when it takes it.
    std::string refusal(const std::string& content)
    {
        try {
            parse_scene("s.json", content);
            return "";
        } catch (const scene_error& e) {
            return e.what();
        }
    }

    /// What it says of `good` with `from` replaced by `to` in one line (counted from 1).
    std::string refusal(std::size_t line, const std::string& from, const std::string& to)
    {
        auto lines = good;
        auto& l = lines[line - 1];
        const auto at = l.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        l.replace(at, from.size(), to);
        return refusal(text(lines));
    }

    void expect_refusal(const std::string& said, const std::string& place, std::initializer_list<const char*> words)
    {
        EXPECT_EQ(said.substr(0, place.size() + 16), "s.json:" + place + ": error: ") << said;
        for (const auto* w : words)
            EXPECT_NE(said.find(w), std::string::npos) << "\"" << w << "\" in: " << said;
    }

    TEST(scene_file, takes_a_grid_that_fits_the_photons)
    {
        auto lines = good;
        auto& render = lines[12];
        render.replace(render.find("[4, 1, 4]"), 9, "\"auto\"");
        EXPECT_EQ(parse_scene("s.json", text(lines)).render.grid, glm::uvec3(0));
    }

    TEST(scene_file, reads_every_part)
    {
        const auto s = parse_scene("s.json", text(good));
        EXPECT_EQ(s.name, "small");
        ASSERT_EQ(s.materials.size(), 2u);
        EXPECT_EQ(s.materials[0].reflectance, dvec3(0.7, 0.6, 0.5));
        EXPECT_EQ(s.materials[1].kind, material_kind::glass);
        EXPECT_EQ(s.materials[1].reflectance, dvec3(1));
        ASSERT_EQ(s.spheres.size(), 1u);
        EXPECT_EQ(s.spheres[0].material, 1u);
        EXPECT_EQ(s.spheres[0].radius, 0.5);
        ASSERT_EQ(s.polygons.size(), 1u);
        EXPECT_EQ(s.polygons[0].vertices[2], dvec3(1, 0, 1));
        ASSERT_EQ(s.point_lights.size(), 1u);
        EXPECT_EQ(s.point_lights[0].power, dvec3(10, 20, 30));
        EXPECT_EQ(s.point_lights[0].name, "lamp");
        EXPECT_EQ(s.camera.up, dvec3(0, 1, 0));
        EXPECT_EQ(s.render.width, 64u);
        EXPECT_EQ(s.render.height, 48u);
        EXPECT_EQ(s.render.photons, 1000u);
        EXPECT_EQ(s.render.grid, glm::uvec3(4, 1, 4));
        EXPECT_EQ(s.render.max_radius, 0.25);
        EXPECT_NO_THROW(check(s));
    }

    TEST(scene_file, reads_every_shape_material_and_light)
    {
        auto lines = good;
        lines[5]
            = R"("white": {"type": "lambertian", "reflectance": 0.5, "comment": "x"}, "m": {"type": "mirror"}, "gold": {"type": "metal", "reflectance": [1, 0.8, 0.3]},)";
        lines[8]
            = R"({"type": "cylinder", "base": [0,0,0], "top": [0,1,0], "radius": 1, "material": "m"}, {"type": "cone", "base": [0,0,0], "apex": [0,2,0], "radius": 1, "material": "gold"},
          {"type": "paraboloid", "vertex": [0,0,0], "rim": [0,1,0], "radius": 2, "material": "white"}, {"type": "disk", "center": [0,0,0], "normal": [0,0,2], "radius": 1, "material": "white"},
          {"type": "triangle", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "material": "white"},)";
        lines[11] = R"({"type": "rectangle", "corner": [0,2,0], "edge_u": [1,0,0], "edge_v": [0,0,1], "power": 5}],)";
        const auto s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.cylinders.size(), 1u);
        EXPECT_EQ(s.cones.size(), 1u);
        EXPECT_EQ(s.cones[0].apex, dvec3(0, 2, 0));
        EXPECT_EQ(s.paraboloids.size(), 1u);
        EXPECT_EQ(s.disks.size(), 1u);
        EXPECT_EQ(s.polygons.size(), 2u);
        ASSERT_EQ(s.rectangle_lights.size(), 1u);
        EXPECT_EQ(s.rectangle_lights[0].power, dvec3(5));
        EXPECT_EQ(s.rectangle_lights[0].name, "lights[0]");
        EXPECT_EQ(s.materials[2].kind, material_kind::metal);
        EXPECT_EQ(s.materials[0].reflectance, dvec3(0.5));
    }

    TEST(scene_file, converts_units)
    {
        auto lines = good;
        lines[2] = R"( "units": {"length": "cm", "power": "mW"},)";
        auto s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.spheres[0].radius, 0.005);
        EXPECT_EQ(s.camera.position, dvec3(0, 0.01, 0.05));
        EXPECT_EQ(s.point_lights[0].power, dvec3(0.01, 0.02, 0.03));
        EXPECT_EQ(s.render.max_radius, 0.0025);
        lines[2] = R"( "units": {"length": "mm", "power": "kW"},)";
        s = parse_scene("s.json", text(lines));
        EXPECT_EQ(s.polygons[0].vertices[2], dvec3(0.001, 0, 0.001));
        EXPECT_EQ(s.point_lights[0].power, dvec3(10'000, 20'000, 30'000));
    }

    TEST(scene_file, reads_what_kind_of_estimate_is_wanted)
    {
        const auto with = [](const std::string& more) {
            auto lines = good;
            lines[12].insert(lines[12].find(", \"k\""), more);
            return parse_scene("s.json", text(lines)).render;
        };
        const auto plain = with("");
        EXPECT_EQ(plain.search, search_kind::exact_k);
        EXPECT_EQ(plain.kernel, filter_kernel::silverman);
        EXPECT_EQ(plain.bias, bias_kind::unbiased);
        EXPECT_EQ(plain.edges, edge_correction::none);
        EXPECT_TRUE(plain.leaks.side);
        EXPECT_EQ(plain.leaks.min_cosine, -1);
        EXPECT_EQ(plain.leaks.compression, 1);
        EXPECT_EQ(with(R"(, "search": "at_least_k")").search, search_kind::at_least_k);
        EXPECT_EQ(with(R"(, "search": "exact_k")").search, search_kind::exact_k);
        EXPECT_EQ(with(R"(, "search": "fixed_radius")").search, search_kind::fixed_radius);
        EXPECT_EQ(with(R"(, "kernel": "constant")").kernel, filter_kernel::constant);
        EXPECT_EQ(with(R"(, "kernel": "cone")").kernel, filter_kernel::cone);
        EXPECT_EQ(with(R"(, "kernel": "epanechnikov")").kernel, filter_kernel::epanechnikov);
        EXPECT_EQ(with(R"(, "kernel": "silverman")").kernel, filter_kernel::silverman);
        EXPECT_EQ(with(R"(, "bias": "paper")").bias, bias_kind::paper);
        EXPECT_EQ(with(R"(, "bias": "unbiased")").bias, bias_kind::unbiased);
        EXPECT_EQ(with(R"(, "edge_correction": "none")").edges, edge_correction::none);
        EXPECT_EQ(
            with(R"(, "edge_correction": "polygons", "leaks": {"normals": 0.5})").edges, edge_correction::polygons);
        EXPECT_FALSE(with(R"(, "leaks": {})").leaks.needs_any());
        EXPECT_FALSE(with(R"(, "leaks": {"comment": 1, "side": false})").leaks.needs_any());
        const auto all = with(R"(, "leaks": {"side": true, "normals": 0.25, "disc": 4})").leaks;
        EXPECT_TRUE(all.side);
        EXPECT_EQ(all.min_cosine, 0.25f);
        EXPECT_EQ(all.compression, 4);
        EXPECT_FALSE(with(R"(, "leaks": {"normals": -0.5})").leaks.side) << "what is not named is off";
        EXPECT_EQ(with(R"(, "leaks": {"normals": 1, "disc": 1e6})").leaks.compression, 1e6f);
    }

    TEST(scene_file, refuses_unknown_kinds_of_estimates)
    {
        const auto said = [](const std::string& more) { return refusal(13, "\"k\": 20", more + ", \"k\": 20"); };
        expect_refusal(said(R"("search": "exact")"), "13:58",
            {"found the text \"exact\"", R"(expected "at_least_k", "exact_k" or "fixed_radius")"});
        expect_refusal(said(R"("search": 1)"), "13:58", {"found the number 1", "\"fixed_radius\""});
        expect_refusal(said(R"("kernel": "gauss")"), "13:58",
            {"found the text \"gauss\"", R"(expected "constant", "cone", "epanechnikov" or "silverman")"});
        expect_refusal(said(R"("bias": true)"), "13:56", {"found true", R"(expected "paper" or "unbiased")"});
        expect_refusal(said(R"("edge_correction": "disks")"), "13:67",
            {"found the text \"disks\"", R"(expected "none" or "polygons")"});
        expect_refusal(said(R"("edge_correction": "polygons")"), "13:67",
            {"edge_correction: photons of adjoining walls would count",
                "needs the leak policy normals with a cosine above 0"});
        expect_refusal(said(R"("edge_correction": "polygons", "leaks": {"side": true, "normals": 0})"), "13:67",
            {"needs the leak policy normals"});
        expect_refusal(said(R"("leaks": "none")"), "13:57",
            {"found the text \"none\"", R"("side", "normals" or "disc"; {} for no policy)"});
        expect_refusal(said(R"("leaks": ["side"])"), "13:57", {"found an array of 1", "expected an object"});
        expect_refusal(said(R"("leaks": {"normal": 0.5})"), "13:58",
            {"unknown key \"normal\" in \"leaks\"", "expected \"normals\"?"});
        expect_refusal(said(R"("leaks": {"side": 1})"), "13:66", {"found the number 1", "expected true or false"});
        expect_refusal(said(R"("leaks": {"normals": 1.01})"), "13:69",
            {"found the number 1.01", "expected a cosine from -1 to 1"});
        expect_refusal(said(R"("leaks": {"normals": true})"), "13:69", {"found true"});
        expect_refusal(said(R"("leaks": {"disc": 0.5})"), "13:66",
            {"found the number 0.5", "expected a compression from 1 to 1e6"});
        expect_refusal(said(R"("leaks": {"disc": 1000001})"), "13:66", {"found the number 1000001"});
        expect_refusal(
            said(R"("serach": "exact_k")"), "13:48", {"unknown key \"serach\" in \"render\"", "expected \"search\"?"});
        // What a picture shows is not the scene's.
        expect_refusal(said(R"("only": "caustic")"), "13:48", {"unknown key \"only\""});
        expect_refusal(said(R"("aov": true)"), "13:48", {"unknown key \"aov\""});
    }

    TEST(scene_file, says_where_json_is_broken)
    {
        expect_refusal(refusal(""), "1:1", {"unexpected end of input"});
        expect_refusal(refusal("{\n  \"photongrid\" 1}"), "2:16", {"unexpected number literal", "expected ':'"});
        expect_refusal(refusal(text(good) + " x"), "14:2", {"expected end of input"});
        expect_refusal(refusal(4, "[0, 1, 5]", "[0, 1, 5"), "4:44", {"expected ']'"}); // the colon
        expect_refusal(refusal(4, "40", "NaN"), "4:74", {"invalid literal"});
        expect_refusal(refusal("{\"name\": \"\xff\"}"), "1:11", {"UTF-8"});
        // Found by fuzzing: the text itself holds the words after which nlohmann's message goes on.
        EXPECT_EQ(refusal("\"'; expected \x7f\x1b"), refusal("\"_; expected \x7f\x1b"));
    }

    TEST(scene_file, columns_count_characters)
    {
        expect_refusal(refusal("{\"comment\": \"äöü\", \"nam\": 1}"), "1:20", {"unknown key \"nam\"", "\"name\""});
    }

    TEST(scene_file, refuses_unknown_and_doubled_keys)
    {
        expect_refusal(refusal(9, "\"center\"", "\"centre\""), "9:22",
            {"unknown key \"centre\" in \"sphere\"", "expected \"center\"?"});
        expect_refusal(refusal(9, "\"center\"", "\"xyzzy\""), "9:22", {"unknown key \"xyzzy\"", "\"radius\""});
        expect_refusal(refusal(9, "\"radius\": 0.5", "\"radius\": 0.5, \"radius\": 0.5"), "9:58",
            {"key \"radius\" is given twice"});
        expect_refusal(refusal(6, "white", "clear"), "7:3", {"key \"clear\" is given twice"});
        EXPECT_EQ(refusal(9, "\"radius\"", "\"comment\": [1, {}], \"radius\""), "");
    }

    TEST(scene_file, refuses_missing_keys)
    {
        expect_refusal(refusal(9, ", \"radius\": 0.5", ""), "9:3", {"\"sphere\" lacks the key \"radius\""});
        expect_refusal(
            refusal(9, "\"type\": \"sphere\", ", ""), "9:3", {"a shape lacks the key \"type\"", "\"sphere\""});
        expect_refusal(refusal(2, "\"name\": \"small\",", "\"name\": \"small\""), "3:2", {"unexpected string literal"});
        expect_refusal(refusal("{\"photongrid\": 1}"), "1:1", {"lacks the key \"units\""});
    }

    TEST(scene_file, refuses_wrong_types)
    {
        expect_refusal(refusal(9, "0.5", "\"big\""), "9:53", {"found the text \"big\"", "expected a length"});
        expect_refusal(refusal(9, "[0, 1, 0]", "[0, 1]"), "9:32", {"found an array of 2", "expected a point"});
        expect_refusal(refusal(9, "[0, 1, 0]", "[0, null, 0]"), "9:36", {"found null"});
        expect_refusal(refusal(13, "1000", "1000.5"), "13:42", {"found the number 1000.5", "expected a whole number"});
        expect_refusal(refusal(13, "1000", "true"), "13:42", {"found true"});
        expect_refusal(refusal("[1]"), "1:1", {"found an array of 1", "expected an object"});
        expect_refusal(refusal(1, "\"photongrid\": 1", "\"photongrid\": 2"), "1:16", {"version, 1"});
        expect_refusal(
            refusal(9, "\"sphere\"", "\"spehre\""), "9:12", {"found the text \"spehre\"", "\"sphere\", \"cylinder\""});
    }

    TEST(scene_file, refuses_numbers_out_of_range)
    {
        expect_refusal(refusal(9, "0.5", "1e400"), "9:53", {"number 1e400 is out of range"});
        expect_refusal(refusal(9, "0.5", "-1e400"), "9:53", {"number -1e400 is out of range"});
        expect_refusal(refusal(9, "0.5", "1e300"), "9:53", {"found the number 1e300", "1e9 m"});
        expect_refusal(refusal(9, "0.5", "0"), "9:53", {"found the number 0"});
        expect_refusal(refusal(9, "0.5", "-1"), "9:53", {"found the number -1"});
        expect_refusal(refusal(6, "0.7", "1.25"), "6:51", {"found the number 1.25", "from 0 to 1"});
        expect_refusal(refusal(7, "1.5", "0.5"), "7:53", {"found the number 0.5", "1 to 10"});
        expect_refusal(
            refusal(13, "1000", "99999999999999999999"), "13:42", {"expected a whole number from 1 to 134217728"});
        expect_refusal(refusal(13, "1000", "-1"), "13:42", {"found the number -1"});
        expect_refusal(refusal(13, "[4, 1, 4]", "[100000, 1000, 1000]"), "13:65", {"2^31 cells"});
        expect_refusal(refusal(13, "[4, 1, 4]", "\"fit\""), "13:65", {"a grid: [x, y, z] cells, or \"auto\""});
        expect_refusal(refusal(4, "40", "180"), "4:74", {"degrees"});
    }

    TEST(scene_file, refuses_what_cannot_be_drawn)
    {
        expect_refusal(
            refusal(10, "[1, 0, 1], [0, 0, 1]", "[2, 0, 0]"), "10:35", {"vertices: the polygon has no area"});
        expect_refusal(refusal(10, "[1, 0, 1]", "[1, 0.5, 1]"), "10:35", {"off the plane"});
        expect_refusal(refusal(10, "[1, 0, 1], [0, 0, 1]", "[0, 0, 1], [1, 0, 1]"), "10:35", {"polygon"});
        expect_refusal(refusal(4, "[0, 0, 0]", "[0, 1, 5]"), "4:25", {"position and look_at"});
        expect_refusal(refusal(12, "[10, 20, 30]", "[0, 0, 0]"), "12:69", {"the light is black"});
        expect_refusal(refusal(9, R"({"type": "sphere", "center": [0, 1, 0], "radius": 0.5,)",
                           R"({"type": "cone", "base": [0, 1, 0], "apex": [0, 1, 0], "radius": 0.5,)"),
            "9:28", {"base and apex", "no axis"});
        expect_refusal(refusal(12, R"("point", "name": "lamp", "position": [0, 3, 0])",
                           R"("rectangle", "corner": [0,0,0], "edge_u": [1,0,0], "edge_v": [1,1,0])"),
            "12:54", {"right angles"});
    }

    TEST(scene_file, refuses_missing_lights_and_unknown_materials)
    {
        auto lines = good;
        lines[11] = "],";
        expect_refusal(refusal(text(lines)), "11:12", {"lights: the scene has none"});
        expect_refusal(refusal(9, "\"clear\"", "\"claer\""), "9:70", {"found the text \"claer\"", "perhaps \"clear\""});
        expect_refusal(refusal(9, "\"clear\"", "7"), "9:70", {"found the number 7", "the name of a material"});
    }

    TEST(scene_file, refuses_unknown_units)
    {
        expect_refusal(refusal(3, "\"m\"", "\"inch\""), "3:22", {"found the text \"inch\"", "\"m\", \"cm\" or \"mm\""});
        expect_refusal(refusal(3, "\"W\"", "\"lm\""), "3:36", {"found the text \"lm\"", "\"kW\""});
        expect_refusal(refusal(3, ", \"power\": \"W\"", ""), "3:11", {"lacks the key \"power\""});
    }

    TEST(scene_file, has_limits)
    {
        expect_refusal(refusal(std::string(100'000, '[')), "1:33", {"deeper than 32"});
        std::string deep;
        for (int i = 0; i < 100'000; ++i)
            deep += "{\"a\":";
        expect_refusal(refusal(deep), "1:161", {"deeper than 32"});
        std::string many = "[0";
        for (int i = 0; i < 1'000'000; ++i)
            many += ",0";
        EXPECT_NE(refusal(many + "]").find("values"), std::string::npos);
        EXPECT_EQ(
            refusal(std::string((16u << 20) + 1, ' ')), "s.json: error: larger than 16 MiB; expected a scene file");
        EXPECT_NE(refusal(std::string(16u << 20, ' ')).find("unexpected end of input"), std::string::npos)
            << "16 MiB are read";
        EXPECT_THROW(read_scene("/dev/zero"), scene_error);
    }

    // As many as the limit are taken, one more is refused at its own place. Each part stands on a line of its own.
    TEST(scene_file, limits_the_number_of_parts)
    {
        const auto times = [](std::size_t n, const auto& one) {
            std::string all;
            for (std::size_t i = 0; i < n; ++i)
                all += (i > 0 ? ",\n" : "") + one(i);
            return all;
        };
        const auto shapes = [&](std::size_t n) {
            auto lines = good;
            lines[8] = times(n, [](std::size_t) {
                return std::string(R"({"type":"sphere","center":[0,1,0],"radius":0.5,"material":"clear"})");
            }) + "],";
            lines[9] = "";
            return refusal(text(lines));
        };
        EXPECT_EQ(shapes(65'536), "");
        expect_refusal(shapes(65'537), "65545:1", {"65537 shapes", "at most 65536"});
        const auto materials = [&](std::size_t n) { // with the two that are there
            auto lines = good;
            lines[4] += times(n - 2, [](std::size_t i) {
                return "\"m" + std::to_string(i) + R"(": {"type": "mirror"})";
            }) + ",";
            return refusal(text(lines));
        };
        EXPECT_EQ(materials(4'096), "");
        expect_refusal(materials(4'097), "4101:3", {"4097 materials", "at most 4096"});
        const auto lights = [&](std::size_t n) {
            auto lines = good;
            lines[11] = times(n, [](std::size_t) {
                return std::string(R"({"type": "point", "position": [0, 3, 0], "power": 1})");
            }) + "],";
            return refusal(text(lines));
        };
        EXPECT_EQ(lights(1'024), "");
        expect_refusal(lights(1'025), "1036:1", {"1025 lights", "at most 1024"});
        const auto vertices = [&](std::size_t n) { // of a regular polygon
            return refusal(10, "[[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]", "[" + times(n, [&](std::size_t i) {
                const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
                return "[" + std::to_string(100 * std::cos(angle)) + ", 0, " + std::to_string(100 * std::sin(angle))
                    + "]";
            }) + "]");
        };
        EXPECT_EQ(vertices(1'024), "");
        expect_refusal(vertices(1'025), "10:35", {"found an array of 1025", "3 to 1024 points"});
        EXPECT_EQ(refusal(12, "lamp", std::string(100, 'n')), "");
        expect_refusal(refusal(12, "lamp", std::string(101, 'n')), "12:29", {"a name: text of 1 to 100 bytes"});
    }

    // Found by fuzzing: a material's name went to the terminal as it was, in "perhaps …".
    TEST(scene_file, refuses_names_that_upset_a_terminal)
    {
        for (const auto* bad : {"wh\x7Fte", "wh\\u001b[2Jte", "", "wh\\nte"}) {
            expect_refusal(refusal(6, "white", bad), "6:3",
                {"found the key \"", "a material's name of 1 to 100 bytes without control characters"});
            expect_refusal(refusal(12, "lamp", bad), "12:29", {"a name"});
        }
        expect_refusal(refusal(6, "white", std::string(101, 'w')), "6:3", {"a material's name"});
    }

    // Found by fuzzing: normals and axes of parts this small came out as no unit vectors.
    TEST(scene_file, refuses_parts_too_small_to_have_a_direction)
    {
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("cylinder", "base": [0, 0, 0], "top": [0, 1e-160, 0], "radius": 0.5)"),
            "9:3", {"less than 1e-9 m apart"});
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("cone", "base": [0, 0, 0], "apex": [0, 9e-10, 0], "radius": 0.5)"),
            "9:3", {"less than 1e-9 m apart"});
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("paraboloid", "vertex": [0, 0, 0], "rim": [0, 9e-10, 0], "radius": 0.5)"),
            "9:3", {"less than 1e-9 m apart"});
        EXPECT_EQ(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                      R"("cone", "base": [0, 0, 0], "apex": [0, 1.1e-9, 0], "radius": 0.5)"),
            "");
        expect_refusal(refusal(10, "[1, 0, 0], [1, 0, 1], [0, 0, 1]", "[1e-80, 0, 0], [0, 1e-80, 0]"), "10:3",
            {"less than 1e-9 m apart"});
        expect_refusal(refusal(12, R"("point", "name": "lamp", "position": [0, 3, 0])",
                           R"("rectangle", "corner": [0,0,0], "edge_u": [1,0,0], "edge_v": [0,1e-70,0])"),
            "12:3", {"less than 1e-9 m apart"});
        expect_refusal(refusal(4, "[0, 0, 0]", "[0, 1, 5.0000000000001]"), "4:12", {"less than 1e-9 m apart"});
        expect_refusal(refusal(4, "\"vertical_fov\"", "\"up\": [0, 1e-160, 0], \"vertical_fov\""), "4:64",
            {"a direction shorter than 1e-9"});
        expect_refusal(
            refusal(9, R"("sphere", "center": [0, 1, 0],)", R"("disk", "center": [0, 1, 0], "normal": [0, 0, 0],)"),
            "9:51", {"a direction shorter than 1e-9"});
    }

    TEST(scene_file, says_why_a_file_cannot_be_read)
    {
        try {
            read_scene("/no/such.json");
            FAIL();
        } catch (const scene_error& e) {
            EXPECT_STREQ(e.what(), "/no/such.json: error: the file cannot be read: No such file or directory");
        }
        EXPECT_THROW(read_scene("/tmp"), scene_error);
    }

    // Whatever is cut off or changed, the reader answers with a scene or a scene_error.
    TEST(scene_file, survives_damage)
    {
        const auto whole = text(good);
        for (std::size_t n = 0; n < whole.size() - 2; ++n)
            EXPECT_NE(refusal(whole.substr(0, n)), "") << n;
        std::uint32_t state = 1;
        for (int i = 0; i < 20'000; ++i) {
            auto damaged = whole;
            for (int changes = 0; changes < 3; ++changes) {
                state = state * 1664525u + 1013904223u;
                damaged[(state >> 8) % damaged.size()] = "0-9e.,:[]{}\"\\ntx\x00\xff"[(state >> 4) % 18];
            }
            refusal(damaged);
        }
    }

    // Table 1 of the paper.
    TEST(scene_file, the_papers_scenes)
    {
        struct row {
            const char* name;
            glm::uvec2 size;
            std::uint32_t light_samples, photons, k;
            glm::uvec3 grid;
        };
        for (const auto& r : {row{"glass_ball", {512, 384}, 4, 5'000, 32, {250, 1, 250}},
                 row{"ring", {512, 384}, 1, 16'000, 64, {250, 1, 250}},
                 row{"cornell_box", {512, 512}, 32, 65'000, 500, {25, 25, 50}},
                 row{"cornell_blocks", {512, 512}, 32, 65'000, 500, {25, 25, 50}}}) {
            SCOPED_TRACE(r.name);
            const auto s = read_scene(scenes + "/" + r.name + ".json");
            EXPECT_NO_THROW(check(s));
            EXPECT_EQ(s.name, r.name);
            EXPECT_EQ(glm::uvec2(s.render.width, s.render.height), r.size);
            EXPECT_EQ(s.render.light_samples, r.light_samples);
            EXPECT_EQ(s.render.spp, 1u);
            EXPECT_EQ(s.render.photons, r.photons);
            EXPECT_EQ(s.render.k, r.k);
            EXPECT_EQ(s.render.grid, r.grid);
            EXPECT_EQ(s.render.search, render_settings().search) << "they leave the kind of estimate to the library";
            EXPECT_EQ(s.render.bias, render_settings().bias);
            EXPECT_EQ(s.render.edges, render_settings().edges);
            EXPECT_EQ(s.render.leaks.side, render_settings().leaks.side);
        }
        EXPECT_EQ(read_scene(scenes + "/ring.json").point_lights.size(), 1u);
        const auto box = read_scene(scenes + "/cornell_box.json");
        ASSERT_EQ(box.rectangle_lights.size(), 1u);
        const auto& lamp = box.rectangle_lights[0];
        EXPECT_LT(glm::cross(lamp.edge_u, lamp.edge_v).y, 0) << "the lamp shines down";
        EXPECT_DOUBLE_EQ(lamp.corner.y, 0.5487) << "a little under the ceiling";
        EXPECT_EQ(box.spheres.size(), 2u);
        EXPECT_EQ(read_scene(scenes + "/cornell_blocks.json").polygons.size(), 16u);
    }

    // Every object of the schema has the keys that the reader knows, and requires those that it requires.
    TEST(scene_file, the_schema_agrees)
    {
        const auto schema = nlohmann::json::parse(std::ifstream(scenes + "/photongrid-scene.schema.json"));
        std::set<std::string> objects;
        for (const auto& [name, definition] : schema.at("$defs").items())
            if (definition.contains("properties"))
                objects.insert(name);
        for (const auto& o : known_objects()) {
            SCOPED_TRACE(o.name);
            EXPECT_EQ(objects.erase(o.name), 1u);
            std::set<std::string> keys{"comment"}, required;
            for (const auto& k : o.keys) {
                keys.insert(k.name);
                if (k.required)
                    required.insert(k.name);
            }
            const auto& definition = schema["$defs"][o.name];
            std::set<std::string> schema_keys;
            for (const auto& [key, about] : definition.at("properties").items())
                schema_keys.insert(key);
            EXPECT_EQ(schema_keys, keys);
            EXPECT_EQ(definition.at("required").get<std::set<std::string>>(), required);
            EXPECT_EQ(definition.at("additionalProperties"), false);
        }
        EXPECT_TRUE(objects.empty()) << *objects.begin();
    }

    TEST(scene_writer, what_it_writes_reads_as_the_same_scene)
    {
        std::size_t scenes_read = 0;
        for (const auto& folder : {scenes, std::string(PHOTONGRID_SCENE_CORPUS)})
            for (const auto& f : std::filesystem::directory_iterator(folder)) {
                if (f.path().extension() != ".json" || f.path().filename() == "photongrid-scene.schema.json")
                    continue;
                scene s;
                try {
                    s = read_scene(f.path().string());
                } catch (const scene_error&) {
                    continue;
                }
                ++scenes_read;
                const auto text = scene_text(s, s.render);
                const auto again = parse_scene("again.json", text);
                EXPECT_TRUE(again == s) << f.path() << " is written as\n" << text;
                EXPECT_EQ(scene_text(again, again.render), text);
            }
        EXPECT_GE(scenes_read, 20u);
    }

    TEST(scene_writer, materials_are_told_apart)
    {
        auto s = parse_scene("s.json", text(good));
        s.name.clear();
        s.materials[0].name.clear();
        s.materials.push_back(s.materials[1]); // "clear", twice
        s.materials[2].index_of_refraction = 1.7;
        s.materials.push_back({"material 2", material_kind::mirror, dvec3(0.1, 1.0 / 3, 0.9)});
        s.spheres.push_back({{5, 1, 0}, 0.1, 2});
        s.spheres.push_back({{7, 1, 0}, 0.1, 3});
        const auto again = parse_scene("again.json", scene_text(s, s.render));
        ASSERT_EQ(again.materials.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(again.materials[i].kind, s.materials[i].kind);
            EXPECT_EQ(again.materials[i].reflectance, s.materials[i].reflectance);
        }
        EXPECT_EQ(again.spheres, s.spheres);
        EXPECT_EQ(again.materials[2].index_of_refraction, 1.7);
    }

} // namespace
} // namespace photongrid
