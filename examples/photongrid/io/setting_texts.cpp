#include "setting_texts.hpp"

#include "scene_file.hpp"
#include "scene_writer.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace photongrid {

namespace {
    using json = nlohmann::ordered_json;

    std::string with(std::string text, char from, char to)
    {
        std::replace(text.begin(), text.end(), from, to);
        return text;
    }

    std::string itself(const std::string& word) { return word; }

    /// `words` with name(x) for each setting x in backticks, and value(x) for each value between asterisks.
    template <class Name, class Value>
    std::string marked(const std::string& words, const Name& name, const Value& value)
    {
        std::string all;
        for (std::size_t at = 0;;) {
            const auto open = words.find_first_of("`*", at);
            all += words.substr(at, open - at);
            if (open == std::string::npos)
                return all;
            const auto close = words.find(words[open], open + 1);
            const auto inside = words.substr(open + 1, close - open - 1);
            all += words[open] == '`' ? name(inside) : value(inside);
            at = close + 1;
        }
    }

    std::string all_of(const setting_words& w)
    {
        return std::string(w.what) + (w.more[0] != '\0' ? std::string(". ") + w.more : "");
    }

    /// The settings of a scene that gives none, in JSON.
    json defaults()
    {
        const json scene = {{"photongrid", 1}, {"units", {{"length", "m"}, {"power", "W"}}},
            {"camera", {{"position", {0, 0, 1}}, {"look_at", {0, 0, 0}}, {"vertical_fov", 40}}},
            {"materials", {{"m", {{"type", "lambertian"}, {"reflectance", 0.5}}}}},
            {"shapes", {{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 0.1}, {"material", "m"}}}},
            {"lights", {{{"type", "point"}, {"position", {0, 1, 0}}, {"power", 1}}}}};
        return json::parse(settings_text(parse_scene("defaults.json", scene.dump()).render));
    }

    /// Whole numbers without a point.
    json number(double v) { return v == std::floor(v) && std::abs(v) < 1e15 ? json(std::int64_t(v)) : json(v); }
    json numbers(std::size_t n, json item)
    {
        return {{"type", "array"}, {"items", std::move(item)}, {"minItems", n}, {"maxItems", n}};
    }

    // What the schema says of a setting's values.
    json schema_of(const setting_table::whole_range& r)
    {
        return {{"type", "integer"}, {"minimum", r.least}, {"maximum", r.most}};
    }
    json schema_of(const real_range& r)
    {
        return {{"type", "number"}, {"minimum", number(r.least)}, {"maximum", number(r.most)}};
    }
    template <class Value, std::size_t N>
    json schema_of(const setting_table::one_of<Value, N>& choice)
    {
        json words = json::array();
        for (const auto& n : choice.values)
            words.push_back(n.name);
        return {{"enum", words}};
    }
    json or_auto(json value)
    {
        json both = json::array();
        both.push_back({{"const", "auto"}});
        both.push_back(std::move(value));
        return {{"anyOf", both}};
    }
    json schema_of(const setting_table::real_or_auto& r) { return or_auto(schema_of(r.range)); }
    json schema_of(const setting_table::whole_or_auto& r) { return or_auto(schema_of(r.range)); }
    json schema_of(const setting_table::length_or_auto&) { return or_auto({{"$ref", "#/$defs/length"}}); }
    json schema_of(const setting_table::cells& c)
    {
        return or_auto(numbers(3, schema_of(setting_table::whole_range{1, c.most_per_axis})));
    }
    json schema_of(const setting_table::pixels& p)
    {
        return numbers(2, schema_of(setting_table::whole_range{1, p.most}));
    }
    json schema_of(const setting_table::policies&) { return {{"$ref", "#/$defs/leaks"}}; }

    // What the page says of them.
    std::string quoted(const std::string& word) { return "`\"" + word + "\"`"; }
    std::string page_of(const setting_table::whole_range& r)
    {
        return std::to_string(r.least) + " to " + std::to_string(r.most);
    }
    std::string page_of(const real_range& r) { return r.ends(); }
    template <class Value, std::size_t N>
    std::string page_of(const setting_table::one_of<Value, N>& choice)
    {
        std::string words;
        for (const auto& n : choice.values)
            words += (words.empty() ? "" : ", ") + quoted(n.name);
        return words;
    }
    std::string page_of(const setting_table::real_or_auto& r) { return page_of(r.range) + ", or " + quoted("auto"); }
    std::string page_of(const setting_table::whole_or_auto& r) { return page_of(r.range) + ", or " + quoted("auto"); }
    std::string page_of(const setting_table::length_or_auto&) { return "a length, or " + quoted("auto"); }
    std::string page_of(const setting_table::cells& c)
    {
        return "`[x, y, z]`, each 1 to " + std::to_string(c.most_per_axis) + ", or " + quoted("auto");
    }
    std::string page_of(const setting_table::pixels& p)
    {
        return "`[width, height]`, each 1 to " + std::to_string(p.most);
    }
    std::string page_of(const setting_table::policies&) { return "an object"; }

    /// In one line, with spaces as people write them.
    std::string spaced(const json& j)
    {
        std::string all;
        if (j.is_object()) {
            for (const auto& [key, value] : j.items())
                all += (all.empty() ? "" : ", ") + json(key).dump() + ": " + spaced(value);
            return "{" + all + "}";
        }
        if (j.is_array()) {
            for (const auto& value : j)
                all += (all.empty() ? "" : ", ") + spaced(value);
            return "[" + all + "]";
        }
        return j.is_number_float() ? number(j.get<double>()).dump() : j.dump();
    }

    /// `text` with `inside` after the line `before` and ahead of the line `after`.
    std::string replaced(
        const std::string& text, const std::string& before, const std::string& inside, const std::string& after)
    {
        const auto from = text.find("\n" + before + "\n");
        const auto to = from == std::string::npos ? from : text.find("\n" + after + "\n", from);
        if (to == std::string::npos)
            throw std::runtime_error("no line \"" + before + "\" with a line \"" + after + "\" below it");
        return text.substr(0, from + before.size() + 2) + inside + text.substr(to + 1);
    }

    std::string schema_object(const std::string& description, const std::string& properties)
    {
        return "      \"type\": \"object\",\n      \"description\": " + json(description).dump()
            + ",\n      \"properties\": {\n" + properties
            + "        \"comment\": true\n      },\n      \"required\": [],\n      \"additionalProperties\": false\n   "
              " },\n";
    }
} // namespace

std::string option_of_setting(const std::string& name) { return "--" + with(name, '_', '-'); }
std::string label_of_setting(const std::string& name) { return with(name, '_', ' '); }

std::string help_of_setting(const setting_words& words) { return marked(words.what, option_of_setting, itself); }

std::string tooltip_of_setting(const setting_words& words)
{
    auto all = marked(all_of(words), label_of_setting, itself);
    all[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(all[0])));
    return all.back() == '.' ? all : all + ".";
}

std::string schema_with_settings(const std::string& text)
{
    const auto by_default = defaults();
    std::string all, of_paper;
    for_each_setting([&](const auto& row) {
        if (row.use == in_scenes::never)
            return;
        auto about = marked(row.words.what, itself, itself);
        const auto& v = by_default.at(row.name);
        about += "; default " + (v.is_string() ? v.template get<std::string>() : spaced(v));
        auto property = schema_of(row.values);
        property["description"] = about;
        const auto key = "        " + json(row.name).dump() + ": ";
        all += key + spaced(property) + ",\n";
        of_paper += key + spaced({{"$ref", "#/$defs/render/properties/" + std::string(row.name)}}) + ",\n";
    });
    return replaced(text, "    \"render\": {",
        schema_object("how to render; its settings are written by photongrid_setting_texts", all)
            + "    \"as_paper\": {\n"
            + schema_object("settings for the paper's method (render --as-paper) where they differ from those of "
                            "\"render\" with the paper's estimate and one eye ray per pixel",
                of_paper),
        "    \"scene\": {");
}

std::string page_with_settings(const std::string& text)
{
    const auto by_default = defaults();
    // Those that scenes do not have are named as options.
    const auto name_of = [](const std::string& name) {
        bool has_key = true;
        for_each_setting([&](const auto& row) { has_key &= row.name != name || row.use != in_scenes::never; });
        return "`" + (has_key ? name : option_of_setting(name)) + "`";
    };
    std::string rows = "| key | values | | default |\n|---|---|---|---|\n";
    for (std::size_t group = 0; group < std::size(setting_groups); ++group) {
        rows += std::string("| **") + setting_groups[group] + "** | | | |\n";
        for_each_setting([&](const auto& row) {
            if (row.words.group != setting_group(group))
                return;
            const std::string key = name_of(row.name), section = row.words.section;
            const auto& v = by_default.at(row.name);
            rows += "| " + (section.empty() ? key : "[" + key + "](#" + section + ")") + " | " + page_of(row.values)
                + " | " + marked(all_of(row.words), name_of, quoted) + " | "
                + (v.is_string()        ? v.template get<std::string>()
                        : v.is_object() ? "`" + spaced(v) + "`"
                                        : spaced(v))
                + " |\n";
        });
    }
    return replaced(text, "<!-- settings -->", rows, "<!-- /settings -->");
}

} // namespace photongrid
