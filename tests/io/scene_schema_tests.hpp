// Damage, the paper's scenes, the schema, and written scenes.
#pragma once

#include "scene_texts.hpp"

#include <photongrid/io/setting_texts.hpp>

namespace photongrid {
namespace {

    // For any truncated or changed file the reader returns a scene or throws a scene_error.
    TEST(scene_file, survives_damage)
    {
        const auto whole = text(good);
        for (std::size_t n = 0; n < whole.size() - 2; ++n)
            EXPECT_NE(refusal(whole.substr(0, n)), "") << n;
        std::uint32_t state = 1;
        for (int i = 0; i < 20'000; ++i)
            refusal(damaged(whole, {"0-9e.,:[]{}\"\\ntx\x00\xff", 18}, state));
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
            const auto paper = as_paper(s);
            EXPECT_EQ(glm::uvec2(paper.output.width, paper.output.height), r.size);
            EXPECT_EQ(paper.view.light_samples, r.light_samples);
            EXPECT_EQ(paper.view.spp, 1u);
            EXPECT_EQ(paper.map.photons, r.photons);
            EXPECT_EQ(paper.map.grid, r.grid);
            EXPECT_EQ(paper.estimate, as_paper(paper).estimate);
            EXPECT_EQ(paper.estimate.k, r.k);
            EXPECT_TRUE(paper.map.has_given_grid());
            EXPECT_FALSE(is_automatic(paper));
            auto left = s.render;
            left.output = automatic_settings().output;
            EXPECT_EQ(left, automatic_settings()) << "they leave all numbers to the renderer";
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

    // The schema has the kinds of materials and the ranges of their members.
    TEST(scene_file, the_schema_has_the_materials)
    {
        const auto schema = nlohmann::json::parse(std::ifstream(scenes + "/photongrid-scene.schema.json"));
        const auto& objects = schema["$defs"];
        std::vector<std::string> kinds, names;
        for (const auto& kind : objects["scene"]["properties"]["materials"]["additionalProperties"]["oneOf"])
            kinds.push_back(kind["$ref"]);
        for (const auto& m : material_kinds) {
            names.push_back(std::string("#/$defs/") + m.name);
            EXPECT_EQ(objects[m.name]["properties"]["type"]["const"], m.name);
            for (const auto& f : m.fields) {
                SCOPED_TRACE(std::string(m.name) + "." + f.key);
                const auto& value = objects[m.name]["properties"][f.key];
                if (std::holds_alternative<double material::*>(f.member)) {
                    EXPECT_EQ(value["minimum"], f.range.least);
                    EXPECT_EQ(value["maximum"], f.range.most);
                } else {
                    const bool is_share = f.range.ends() == "0 to 1";
                    EXPECT_EQ(value["$ref"], is_share ? "#/$defs/fraction" : "#/$defs/per_metre");
                    EXPECT_EQ(f.range.most, is_share ? 1 : 1e9);
                }
            }
        }
        EXPECT_EQ(kinds, names);
    }

    // The words and values of settings in the schema and on the page are those of the table.
    TEST(setting_table, schema_and_page_are_made_from_it)
    {
        const auto text_of = [](const std::string& path) {
            std::ifstream in(path, std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(in), {});
        };
        const auto expect_made = [&](const std::string& path, std::string (*make)(const std::string&)) {
            const auto text = text_of(path);
            EXPECT_TRUE(make(text) == text) << path << " differs from setting_table.hpp: run photongrid_setting_texts";
        };
        expect_made(scenes + "/photongrid-scene.schema.json", schema_with_settings);
        expect_made(PHOTONGRID_SETTINGS_PAGE, page_with_settings);
        EXPECT_THROW(page_with_settings("no marks"), std::runtime_error);
    }

    // Each name in backticks is a setting's, each value between asterisks one of its own or another's, and a section of
    // the page is there.
    TEST(setting_table, words_name_what_there_is)
    {
        std::set<std::string> names, values{"side", "min_cosine", "flattening"}, anchors{""};
        for_each_setting([&](const auto& row) {
            names.insert(row.name);
            if constexpr (requires { row.values.find(""); })
                for (const auto& n : row.values.values)
                    values.insert(n.name);
        });
        std::ifstream page(PHOTONGRID_SETTINGS_PAGE);
        for (std::string line; std::getline(page, line);)
            if (line.starts_with("## ")) {
                auto anchor = line.substr(3);
                for (auto& c : anchor)
                    c = c == ' ' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
                anchors.insert(anchor);
            }
        for_each_setting([&](const auto& row) {
            SCOPED_TRACE(row.name);
            const auto words = std::string(row.words.what) + " " + row.words.more;
            for (const auto& [mark, known] : {std::pair('`', &names), std::pair('*', &values)}) {
                std::size_t at = 0;
                for (auto open = words.find(mark); open != std::string::npos; open = words.find(mark, at)) {
                    const auto close = words.find(mark, open + 1);
                    ASSERT_NE(close, std::string::npos);
                    EXPECT_EQ(known->count(words.substr(open + 1, close - open - 1)), 1u) << words.substr(open);
                    at = close + 1;
                }
            }
            EXPECT_EQ(anchors.count(row.words.section), 1u) << row.words.section;
            EXPECT_EQ(help_of_setting(row.words).find_first_of("`*"), std::string::npos);
            EXPECT_EQ(tooltip_of_setting(row.words).back(), '.');
        });
        EXPECT_EQ(
            help_of_setting(setting_table::max_radius.words), "largest search radius; with fixed_radius, the radius");
        EXPECT_EQ(help_of_setting(setting_table::caustic_photons.words),
            "caustic photons stored in a map of their own; 0: they are among --photons");
    }

    // A row that for_each_setting leaves out would be no key, no option and no check.
    TEST(setting_table, every_row_is_visited)
    {
        std::ifstream header(PHOTONGRID_SETTING_TABLE);
        std::set<std::string> rows, visited;
        const std::regex row(R"re(^ *inline constexpr setting (\w+)\{.*)re");
        std::smatch found;
        for (std::string line; std::getline(header, line);)
            if (std::regex_match(line, found, row))
                rows.insert(found[1]);
        for_each_setting([&](const auto& r) { visited.insert(r.name); });
        EXPECT_EQ(rows, visited);
        EXPECT_GE(rows.size(), 20u);
    }

    TEST(scene_writer, what_it_writes_reads_as_the_same_scene)
    {
        std::size_t scenes_read = 0;
        for (const auto& folder : {scenes, std::string(PHOTONGRID_SCENE_CORPUS) + "/photongrid"})
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
                const auto again = parse_scene((f.path().parent_path() / "again.json").string(), text);
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
        s.materials[2].roughness = 0.25;
        s.materials[2].energy = facet_bounces::single;
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
        EXPECT_EQ(again.materials[1].roughness, 0);
        EXPECT_EQ(again.materials[2].index_of_refraction, 1.7);
        EXPECT_EQ(again.materials[2].roughness, 0.25);
        EXPECT_EQ(again.materials[1].energy, facet_bounces::multiple);
        EXPECT_EQ(again.materials[2].energy, facet_bounces::single);
    }

} // namespace
} // namespace photongrid
