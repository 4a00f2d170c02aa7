#include <photongrid/io/pbrt/version_3.hpp>

#include <array>
#include <initializer_list>
#include <utility>

namespace photongrid::pbrt {

namespace {
    struct renamed_parameter {
        std::string_view old, now;
    };
    struct default_number {
        std::string_view name;
        double value;
    };
    /// A material: its names, and the numbers that pbrt-v3 took where pbrt-v4 takes others.
    struct old_material {
        std::string_view old, now;
        std::array<renamed_parameter, 2> renamed{};
        std::array<default_number, 2> defaults{};
    };
    constexpr std::array old_materials{
        old_material{"matte", "diffuse", {{{"Kd", "reflectance"}}}},
        old_material{
            "plastic", "coateddiffuse", {{{"Kd", "reflectance"}}}, {{{"reflectance", 0.25}, {"roughness", 0.1}}}},
        old_material{"uber", "coateddiffuse", {{{"Kd", "reflectance"}, {"index", "eta"}}},
            {{{"reflectance", 0.25}, {"roughness", 0.1}}}},
        old_material{
            "substrate", "coateddiffuse", {{{"Kd", "reflectance"}}}, {{{"uroughness", 0.1}, {"vroughness", 0.1}}}},
        old_material{"mirror", "conductor", {{{"Kr", "reflectance"}}}, {{{"reflectance", 0.9}}}},
        old_material{"metal", "conductor", {}, {{{"roughness", 0.01}}}},
        old_material{"glass", "dielectric", {{{"index", "eta"}}}},
        old_material{"translucent", "diffusetransmission", {{{"Kd", "reflectance"}}}},
        old_material{"kdsubsurface", "subsurface", {{{"Kd", "reflectance"}}}},
    };

    parameter number(const entity& e, std::string_view name, double value)
    {
        const bool is_colour = name == "reflectance";
        return {.type = is_colour ? "rgb" : "float",
            .name = std::string(name),
            .place = e.place,
            .numbers = std::vector<double>(is_colour ? 3 : 1, value)};
    }

    bool is_old_mixture(entity& e)
    {
        auto& p = e.parameters;
        const auto *first = p.find("namedmaterial1"), *second = p.find("namedmaterial2");
        if (e.type != "mix" || first == nullptr || second == nullptr || first->texts.size() != 1
            || second->texts.size() != 1)
            return false;
        p.add({.type = "string", .name = "materials", .place = e.place, .texts = {first->texts[0], second->texts[0]}});
        // It is the first material's there, the second one's in pbrt-v4.
        if (auto* amount = p.change("amount"); amount != nullptr && !amount->numbers.empty()) {
            double sum = 0;
            for (const double n : amount->numbers)
                sum += n;
            amount->numbers = {1 - sum / static_cast<double>(amount->numbers.size())};
            amount->type = "float";
        }
        return true;
    }

    bool is_old_light(entity& e)
    {
        auto& p = e.parameters;
        const bool has_map = e.type == "infinite" && p.change("mapname") != nullptr;
        auto* scale = p.change("scale");
        if (scale == nullptr || scale->type != "rgb" || scale->numbers.size() != 3)
            return has_map;
        // pbrt-v4's is one number: what differs goes to the light's colour.
        const auto s = scale->numbers;
        scale->type = "float";
        scale->numbers = {1};
        for (const auto* name : {"L", "I"})
            if (auto* colour = p.change(name);
                colour != nullptr && colour->type == "rgb" && colour->numbers.size() == 3) {
                for (std::size_t c = 0; c < 3; ++c)
                    colour->numbers[c] *= s[c];
                return true;
            }
        p.add({.type = "rgb",
            .name = e.type == "infinite" || e.type == "distant" || e.type == "diffuse" ? "L" : "I",
            .place = e.place,
            .numbers = s});
        return true;
    }
} // namespace

bool to_version_4(entity& e, std::string_view kind)
{
    if (kind == "light")
        return is_old_light(e);
    if (is_old_mixture(e))
        return true;
    for (const auto& m : old_materials) {
        if (m.old != e.type)
            continue;
        e.type = m.now;
        auto& p = e.parameters;
        for (const auto& r : m.renamed)
            if (auto* old = r.old.empty() ? nullptr : p.change(r.old); old != nullptr)
                old->name = r.now;
        for (const auto& d : m.defaults)
            if (!d.name.empty() && p.change(d.name) == nullptr)
                p.add(number(e, d.name, d.value));
        return true;
    }
    return false;
}

} // namespace photongrid::pbrt
