// What scene files are refused for, and how.
#pragma once

#include "scene_texts.hpp"

namespace photongrid {
namespace {

    TEST(scene_file, says_where_json_is_broken)
    {
        expect_refusal(refusal(""), "1:1", {"unexpected end of input"});
        expect_refusal(refusal("{\n  \"photongrid\" 1}"), "2:16", {"unexpected number literal", "expected ':'"});
        expect_refusal(refusal(text(good) + " x"), "14:2", {"expected end of input"});
        expect_refusal(refusal(4, "[0, 1, 5]", "[0, 1, 5"), "4:44", {"expected ',' or ']'"}); // the colon
        expect_refusal(refusal(4, "40", "NaN"), "4:74", {"invalid literal"});
        expect_refusal(refusal("{\"name\": \"\xff\"}"), "1:11", {"UTF-8"});
        // Found by fuzzing: the text itself holds the words after which nlohmann's message goes on.
        EXPECT_EQ(refusal("\"'; expected \x7f\x1b"), refusal("\"_; expected \x7f\x1b"));
    }

    TEST(scene_file, columns_count_characters)
    {
        expect_refusal(refusal("{\"comment\": \"äöü\", \"nam\": 1}"), "1:20", {"unknown key \"nam\"", "\"name\""});
    }

    TEST(scene_file, rejects_unknown_and_doubled_keys)
    {
        expect_refusal(refusal(9, "\"center\"", "\"centre\""), "9:22",
            {"unknown key \"centre\" in \"sphere\"", "expected \"center\"?"});
        expect_refusal(refusal(9, "\"center\"", "\"xyzzy\""), "9:22", {"unknown key \"xyzzy\"", "\"radius\""});
        expect_refusal(refusal(9, "\"radius\": 0.5", "\"radius\": 0.5, \"radius\": 0.5"), "9:58",
            {"key \"radius\" is given twice"});
        expect_refusal(refusal(6, "white", "clear"), "7:3", {"key \"clear\" is given twice"});
        EXPECT_EQ(refusal(9, "\"radius\"", "\"comment\": [1, {}], \"radius\""), "");
    }

    TEST(scene_file, rejects_missing_keys)
    {
        expect_refusal(refusal(9, ", \"radius\": 0.5", ""), "9:3", {"\"sphere\" lacks the key \"radius\""});
        expect_refusal(
            refusal(9, "\"type\": \"sphere\", ", ""), "9:3", {"a shape lacks the key \"type\"", "\"sphere\""});
        expect_refusal(refusal(2, "\"name\": \"small\",", "\"name\": \"small\""), "3:2",
            {"unexpected string literal", "expected ',' or '}'"});
        expect_refusal(
            refusal(9, "[0, 1, 0]", "[0 1, 0]"), "9:35", {"unexpected number literal", "expected ',' or ']'"});
        expect_refusal(refusal("{\"photongrid\": 1}"), "1:1", {"lacks the key \"units\""});
    }

    TEST(scene_file, rejects_what_only_all_shapes_show)
    {
        // render() refuses the same without a line.
        expect_refusal(
            refusal(10, "{\"type\": \"polygon\"",
                R"({"type": "sphere", "center": [0, 1.5, 0], "radius": 0.5, "material": "clear"}, {"type": "polygon")"),
            "10:3", {"overlaps shapes[0]", "move them apart"});
    }

    TEST(scene_file, rejects_wrong_types)
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

    TEST(scene_file, rejects_numbers_out_of_range)
    {
        expect_refusal(refusal(9, "0.5", "1e400"), "9:53", {"number 1e400 is out of range"});
        expect_refusal(refusal(9, "0.5", "-1e400"), "9:53", {"number -1e400 is out of range"});
        expect_refusal(refusal(9, "0.5", "1e300"), "9:53", {"found the number 1e300", "1e9 m"});
        expect_refusal(refusal(9, "0.5", "0"), "9:53", {"found the number 0"});
        expect_refusal(refusal(9, "0.5", "-1"), "9:53", {"found the number -1"});
        expect_refusal(refusal(6, "0.7", "1.25"), "6:51", {"found the number 1.25", "from 0 to 1"});
        expect_refusal(refusal(7, "1.5", "0.05"), "7:53", {"found the number 0.05", "0.1 to 10"});
        expect_refusal(
            refusal(13, "1000", "99999999999999999999"), "13:42", {"expected a whole number from 1 to 134217728"});
        expect_refusal(refusal(13, "1000", "-1"), "13:42", {"found the number -1"});
        expect_refusal(refusal(13, "[4, 1, 4]", "[100000, 1000, 1000]"), "13:65", {"2^31 cells"});
        expect_refusal(refusal(13, "[4, 1, 4]", "\"fit\""), "13:65", {"a grid: [x, y, z] cells, or \"auto\""});
        expect_refusal(refusal(4, "40", "180"), "4:74", {"degrees"});
    }

    TEST(scene_file, rejects_what_cannot_be_drawn)
    {
        expect_refusal(
            refusal(10, "[1, 0, 1], [0, 0, 1]", "[2, 0, 0]"), "10:35", {"vertices: the polygon has no area"});
        expect_refusal(refusal(10, "[1, 0, 1]", "[1, 0.5, 1]"), "10:35", {"off the plane"});
        expect_refusal(refusal(10, "[1, 0, 1], [0, 0, 1]", "[0, 0, 1], [1, 0, 1]"), "10:35", {"polygon"});
        expect_refusal(refusal(4, "[0, 0, 0]", "[0, 1, 5]"), "4:25", {"position and look_at"});
        expect_refusal(refusal(12, "[10, 20, 30]", "[0, 0, 0]"), "12:69", {"a light needs a channel above 0"});
        expect_refusal(refusal(9, R"({"type": "sphere", "center": [0, 1, 0], "radius": 0.5,)",
                           R"({"type": "cone", "base": [0, 1, 0], "apex": [0, 1, 0], "radius": 0.5,)"),
            "9:28", {"base and apex", "must be different points"});
        expect_refusal(refusal(12, R"("point", "name": "lamp", "position": [0, 3, 0])",
                           R"("rectangle", "corner": [0,0,0], "edge_u": [1,0,0], "edge_v": [1,1,0])"),
            "12:54", {"right angles"});
    }

    TEST(scene_file, rejects_missing_lights_and_unknown_materials)
    {
        auto lines = good;
        lines[11] = "],";
        expect_refusal(refusal(text(lines)), "11:12", {"lights: the scene has none"});
        expect_refusal(refusal(9, "\"clear\"", "\"claer\""), "9:70", {"found the text \"claer\"", "perhaps \"clear\""});
        expect_refusal(refusal(9, "\"clear\"", "7"), "9:70", {"found the number 7", "the name of a material"});
    }

    TEST(scene_file, rejects_unknown_units)
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

    // The limit is accepted, one more is rejected at its own line. Each part is on a line of its own.
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
            lines[8] = times(n, [](std::size_t i) { // a row of glass balls that nearly touch, and one that is matte
                return R"({"type":"sphere","center":[)" + std::to_string(i) + R"(,1,0],"radius":0.499,"material":")"
                    + (i == 0 ? "white" : "clear") + "\"}";
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
    TEST(scene_file, rejects_names_with_control_characters)
    {
        for (const auto* bad : {"wh\x7Fte", "wh\\u001b[2Jte", "", "wh\\nte"}) {
            expect_refusal(refusal(6, "white", bad), "6:3",
                {"found the key \"", "a material's name of 1 to 100 bytes without control characters"});
            expect_refusal(refusal(12, "lamp", bad), "12:29", {"a name"});
        }
        expect_refusal(refusal(6, "white", std::string(101, 'w')), "6:3", {"a material's name"});
    }

    // Found by fuzzing: normals and axes of parts this small came out as no unit vectors.
    TEST(scene_file, rejects_parts_too_small_to_have_a_direction)
    {
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("cylinder", "base": [0, 0, 0], "top": [0, 1e-160, 0], "radius": 0.5)"),
            "9:3", {"is smaller than 1e-9 m; check \"units\""});
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("cone", "base": [0, 0, 0], "apex": [0, 9e-10, 0], "radius": 0.5)"),
            "9:3", {"is smaller than 1e-9 m; check \"units\""});
        expect_refusal(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                           R"("paraboloid", "vertex": [0, 0, 0], "rim": [0, 9e-10, 0], "radius": 0.5)"),
            "9:3", {"is smaller than 1e-9 m; check \"units\""});
        EXPECT_EQ(refusal(9, R"("sphere", "center": [0, 1, 0], "radius": 0.5)",
                      R"("cone", "base": [0, 0, 0], "apex": [0, 1.1e-9, 0], "radius": 0.5)"),
            "");
        expect_refusal(refusal(10, "[1, 0, 0], [1, 0, 1], [0, 0, 1]", "[1e-80, 0, 0], [0, 1e-80, 0]"), "10:3",
            {"is smaller than 1e-9 m; check \"units\""});
        expect_refusal(refusal(12, R"("point", "name": "lamp", "position": [0, 3, 0])",
                           R"("rectangle", "corner": [0,0,0], "edge_u": [1,0,0], "edge_v": [0,1e-70,0])"),
            "12:3", {"is smaller than 1e-9 m; check \"units\""});
        expect_refusal(refusal(4, "[0, 0, 0]", "[0, 1, 5.0000000000001]"), "4:12",
            {"position and look_at are less than 1e-9 m apart; check \"units\""});
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

} // namespace
} // namespace photongrid
