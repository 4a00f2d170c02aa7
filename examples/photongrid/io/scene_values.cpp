#include <photongrid/io/scene_values.hpp>

namespace photongrid {

std::string joined(const std::vector<std::string>& words)
{
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
        all += (i == 0 ? "\"" : i + 1 == words.size() ? " or \"" : ", \"") + words[i] + "\"";
    return all;
}

void scene_values::read_units(const json_value& v)
{
    open(v, "units");
    static const std::map<std::string, unit> lengths{{"m", {}}, {"cm", {1, 100}}, {"mm", {1, 1000}}},
        powers{{"W", {}}, {"mW", {1, 1000}}, {"kW", {1000, 1}}};
    length_ = lengths.at(one_of(at(v, "length"), {"m", "cm", "mm"}));
    power_ = powers.at(one_of(at(v, "power"), {"W", "mW", "kW"}));
}

void scene_values::open(const json_value& v, std::string_view kind) const
{
    if (v.kind != json_kind::object)
        wrong(v, "an object with the keys of \"" + std::string(kind) + "\"");
    const auto objects = known_objects();
    const auto keys
        = std::find_if(objects.begin(), objects.end(), [&](const object_keys& o) { return o.name == kind; })->keys;
    for (const auto& m : v.items) {
        if (m.key == "comment"
            || std::any_of(keys.begin(), keys.end(), [&](const scene_key& k) { return m.key == k.name; }))
            continue;
        const auto near = nearest(m.key, names(keys));
        fail(m.key_place,
            "unknown key " + described({.kind = json_kind::string, .text = m.key}).substr(9) + " in \""
                + std::string(kind) + "\"; expected " + (near.empty() ? joined(names(keys)) : "\"" + near + "\"?"));
    }
    for (const auto& k : keys)
        if (k.required && !v.find(k.name))
            fail(v.place, "\"" + std::string(kind) + "\" lacks the key \"" + k.name + "\"");
}

} // namespace photongrid
