#include <photongrid/io/import/token_reader.hpp>
#include <photongrid/io/pbrt/values.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::pbrt {

namespace {
    constexpr double sodium = 587.6; ///< nm, at which indices of refraction are given

    bool is_in_range(const dvec3& v) { return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x <= 1 && v.y <= 1 && v.z <= 1; }

    dvec3 color_of(glm::u16vec4 texel) { return dvec3(texel.x, texel.y, texel.z) / 65535.0; }

    struct named_glass {
        std::string_view name;
        double index;
    };
    /// At 587.6 nm, by their makers.
    constexpr named_glass glasses[] = {{"glass-BK7", 1.5168}, {"glass-BAF10", 1.6700}, {"glass-FK51A", 1.4866},
        {"glass-LASF9", 1.8503}, {"glass-F5", 1.6034}, {"glass-F10", 1.6228}, {"glass-F11", 1.6206},
        {"glass-SF5", 1.6727}, {"glass-SF10", 1.7283}, {"glass-SF11", 1.7847}};

    /// "Cu" of the spectrum "metal-Cu-eta" (copper is what pbrt takes if there is none); "" of another one.
    std::string metal_symbol(const parameter* p, std::string_view ending)
    {
        if (p == nullptr)
            return "Cu";
        std::string_view name = p->texts.empty() ? "" : std::string_view(p->texts[0]);
        if (!name.starts_with("metal-") || !name.ends_with(ending))
            return "";
        name.remove_prefix(6);
        name.remove_suffix(ending.size());
        return std::string(name);
    }

    bool is_daylight(std::string_view name) { return name == "stdillum-D65"; }

    /// The spectrum of a file: pairs of a wavelength and a value.
    sampled_spectrum samples_of(const source_place& place, const std::vector<double>& numbers)
    {
        if (numbers.empty() || numbers.size() % 2 != 0)
            fail_at(place,
                "found a spectrum of " + std::to_string(numbers.size())
                    + " numbers; expected pairs of a wavelength, nm, and a value");
        sampled_spectrum s;
        for (std::size_t i = 0; i < numbers.size(); i += 2) {
            if (i > 0 && !(numbers[i] > s.wavelengths.back()))
                fail_at(place, "the wavelengths of a spectrum do not ascend");
            s.wavelengths.push_back(numbers[i]);
            s.values.push_back(numbers[i + 1]);
        }
        return s;
    }
} // namespace

std::optional<sampled_spectrum> value_reader::spectrum(const parameter& p) const
{
    if (p.type != "spectrum")
        return std::nullopt;
    if (p.texts.empty())
        return samples_of(p.place, p.numbers);
    std::string text;
    try {
        text = builder_.files().bytes_of(p.texts[0]);
    } catch (const file_error& e) {
        fail_at(p.place,
            "the spectrum " + shown_word(p.texts[0]) + " is neither one of pbrt's that is known here nor a file ("
                + e.what() + ")");
    }
    token_reader t(std::make_shared<const std::string>(builder_.files().path_of(p.texts[0])), text);
    std::vector<double> numbers;
    while (t.peek())
        numbers.push_back(t.number("a number"));
    return samples_of(p.place, numbers);
}

dvec3 value_reader::constant_reflectance(const entity& e, const parameter& p) const
{
    if (p.type == "rgb") {
        if (p.numbers.size() != 3)
            fail_at(p.place, "found an rgb of " + std::to_string(p.numbers.size()) + " numbers; expected 3");
        return glm::max(to_rec709(*e.colors) * dvec3(p.numbers[0], p.numbers[1], p.numbers[2]), dvec3(0));
    }
    if (p.type == "float" && p.numbers.size() == 1)
        return dvec3(p.numbers[0]);
    if (const auto s = spectrum(p))
        return reflected_rgb(*s);
    fail_at(p.place, "found a " + p.type + "; expected rgb, spectrum or texture");
}

varying value_reader::reflectance(const entity& e, std::string_view name, const dvec3& if_absent)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr)
        return {if_absent, {}};
    auto v = p->type == "texture" && p->texts.size() == 1 ? texture(p->place, p->texts[0], false)
                                                          : varying{constant_reflectance(e, *p), {}};
    if (!is_in_range(v.factor)) {
        builder_.note(p->place, "a reflectance is limited to 0 to 1");
        v.factor = glm::clamp(v.factor, dvec3(0), dvec3(1));
    }
    return v;
}

varying value_reader::number(const entity& e, std::string_view name, double if_absent)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr)
        return {dvec3(if_absent), {}};
    if (p->type == "texture" && p->texts.size() == 1)
        return texture(p->place, p->texts[0], true);
    return {dvec3(e.parameters.number(name, if_absent)), {}};
}

dvec3 value_reader::emission(const entity& e, std::string_view name)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr || (!p->texts.empty() && is_daylight(p->texts[0])))
        return dvec3(1);
    if (p->type == "rgb")
        return constant_reflectance(e, *p);
    if (p->type == "blackbody") {
        if (p->numbers.size() != 1 || !(p->numbers[0] > 0))
            fail_at(p->place, "found a blackbody without one temperature, K, above 0");
        return blackbody_rgb(p->numbers[0]);
    }
    if (!p->texts.empty() && p->texts[0].starts_with("stdillum-")) {
        if (p->texts[0] == "stdillum-A")
            return blackbody_rgb(2855.5);
        builder_.note(p->place, "the spectrum " + shown_word(p->texts[0]) + ": white light in its place");
        return dvec3(1);
    }
    if (const auto s = spectrum(*p))
        return emitted_rgb(*s);
    fail_at(p->place, "found a " + p->type + "; expected rgb, spectrum or blackbody");
}

dvec3 value_reader::coefficient(const entity& e, std::string_view name)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr)
        return dvec3(0);
    if (p->type == "rgb")
        return constant_reflectance(e, *p);
    if (const auto s = spectrum(*p))
        return {s->at(612), s->at(549), s->at(465)}; // where sRGB's primaries are
    fail_at(p->place, "found a " + p->type + "; expected rgb or spectrum");
}

double value_reader::index_of_refraction(const entity& e, std::string_view name, double if_absent)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr)
        return if_absent;
    if (p->type == "float")
        return e.parameters.number(name, if_absent);
    if (!p->texts.empty())
        for (const auto& g : glasses)
            if (p->texts[0] == g.name) {
                builder_.note(p->place, "dispersion of " + shown_word(g.name) + " is left out; its index at 587.6 nm");
                return g.index;
            }
    const auto s = spectrum(*p);
    if (!s)
        fail_at(p->place, "found a " + p->type + "; expected float or spectrum");
    if (s->values.size() > 1)
        builder_.note(p->place, "dispersion is left out; the index at 587.6 nm is used");
    return s->at(sodium);
}

varying value_reader::conductor(const entity& e, const std::string& prefix)
{
    if (e.parameters.find("reflectance") != nullptr)
        return reflectance(e, "reflectance", dvec3(1));
    const auto *eta = e.parameters.find(prefix + "eta"), *k = e.parameters.find(prefix + "k");
    if (const auto symbol = metal_symbol(eta, "-eta"); !symbol.empty() && symbol == metal_symbol(k, "-k")) {
        if (const auto known = metal_reflectance(symbol))
            return {*known, {}};
        builder_.note(e.place, "the metal " + shown_word(symbol) + ": a reflectance of 0.7 in its place");
        return {dvec3(0.7), {}};
    }
    if (eta == nullptr || k == nullptr)
        fail_at(e.place, "a conductor has both \"eta\" and \"k\", or none of them");
    if (eta->type == "rgb" && k->type == "rgb" && eta->numbers.size() == 3 && k->numbers.size() == 3) {
        dvec3 made;
        for (int c = 0; c < 3; ++c)
            made[c] = conductor_reflectance(
                eta->numbers[static_cast<std::size_t>(c)], k->numbers[static_cast<std::size_t>(c)]);
        return {made, {}};
    }
    const auto any = [&](const parameter& p) -> std::optional<sampled_spectrum> {
        if (p.type == "float" && p.numbers.size() == 1)
            return sampled_spectrum{{sodium}, {p.numbers[0]}};
        return spectrum(p);
    };
    const auto eta_at = any(*eta), k_at = any(*k);
    if (!eta_at || !k_at)
        fail_at(eta->place, "\"eta\" and \"k\" of a conductor must both be rgb, or float or spectrum");
    sampled_spectrum made;
    for (double nm = 380; nm <= 780; nm += 5) {
        made.wavelengths.push_back(nm);
        made.values.push_back(conductor_reflectance(eta_at->at(nm), k_at->at(nm)));
    }
    return {reflected_rgb(made), {}};
}

dvec3 value_reader::mean(const varying& v)
{
    if (!v.texture.map)
        return v.factor;
    dvec3 sum(0);
    for (const auto& t : v.texture.map->texels)
        sum += color_of(t);
    return v.factor * sum / static_cast<double>(v.texture.map->texels.size());
}

// --- textures ---

varying value_reader::texture(const source_place& place, const std::string& name, bool is_float)
{
    const auto key = name + (is_float ? "/float" : "/spectrum");
    if (const auto before = textures_.find(key); before != textures_.end())
        return before->second;
    const auto found = all_.textures.find(key);
    if (found == all_.textures.end())
        fail_at(place,
            "there is no texture " + shown_word(name) + " of " + (is_float ? "float" : "spectrum") + " in the file");
    if (within_.size() > 100 || !within_.insert(key).second)
        fail_at(place, "the texture " + shown_word(name) + " is made of itself, or of more than 100 within each other");
    auto made = made_texture(found->second, is_float);
    found->second.parameters.note_unused(builder_.log(), "texture " + shown_word(name));
    within_.erase(key);
    textures_.emplace(key, made);
    return made;
}

varying value_reader::made_texture(const entity& e, bool is_float)
{
    if (e.type == "constant")
        return input(e, "value", is_float, dvec3(1));
    if (e.type == "imagemap")
        return image_texture(e, is_float);
    if (e.type == "checkerboard")
        return checkerboard(e, is_float);
    if (e.type == "scale" || e.type == "mix")
        return mixed(e, is_float);
    builder_.note(e.place, "texture " + shown_word(e.type) + ": drawn as 0.5 everywhere");
    return {dvec3(0.5), {}};
}

/// A parameter of a texture: a value, or another texture.
varying value_reader::input(const entity& e, std::string_view name, bool is_float, const dvec3& if_absent)
{
    const auto* p = e.parameters.find(name);
    if (p == nullptr)
        return {if_absent, {}};
    if (p->type == "texture" && p->texts.size() == 1)
        return texture(p->place, p->texts[0], is_float);
    return {constant_reflectance(e, *p), {}};
}

void value_reader::map_coordinates(const entity& e, texture_use& t)
{
    const auto& p = e.parameters;
    if (const auto mapping = p.text("mapping", "uv"); mapping != "uv")
        builder_.note(e.place, "texture mapping " + shown_word(mapping) + ": texture coordinates in its place");
    t.scale = {p.number("uscale", 1), p.number("vscale", 1)};
    t.offset = {p.number("udelta", 0), p.number("vdelta", 0)};
    const auto wrap = p.text("wrap", "repeat");
    if (wrap == "clamp")
        t.wrap = texture_wrap::clamp;
    else if (wrap != "repeat")
        builder_.note(e.place, "texture wrap " + shown_word(wrap) + ": drawn as \"repeat\"");
    try {
        check(t);
    } catch (const std::invalid_argument& wrong) {
        fail_at(e.place, wrong.what());
    }
}

/// With each texel changed.
varying value_reader::baked(const varying& v, const std::function<dvec3(const dvec3&)>& change) const
{
    if (!v.texture.map)
        return {change(v.factor), {}};
    auto map = *v.texture.map;
    for (auto& t : map.texels) {
        const auto c = glm::clamp(change(v.factor * color_of(t)), dvec3(0), dvec3(1)) * 65535.0 + 0.5;
        t = glm::u16vec4(c.x, c.y, c.z, 65535);
    }
    varying made{dvec3(1), v.texture};
    made.texture.map = std::make_shared<const photongrid::texture>(std::move(map));
    made.texture.file.clear(); // it is not what the file has any more
    return made;
}

varying value_reader::image_texture(const entity& e, bool is_float)
{
    const auto& p = e.parameters;
    const auto* file = p.find("filename");
    const auto name = p.text("filename", "");
    if (file == nullptr)
        fail_at(e.place, "the texture lacks \"string filename\"");
    p.find("filter"); // eye rays are the filter
    p.find("maxanisotropy");
    const auto encoding = p.text("encoding", "sRGB");
    const auto holds = encoding == "linear" ? texture_holds::numbers : texture_holds::colour;
    if (encoding != "linear" && encoding != "sRGB")
        builder_.note(e.place, "texture encoding " + shown_word(encoding) + ": read as sRGB");
    const double scale = p.number("scale", 1);
    const bool invert = p.truth("invert", false);
    auto t = builder_.texture(file->place, name, holds);
    if (!t) {
        texture_use none;
        map_coordinates(e, none);
        return {dvec3(0.5 * scale), {}};
    }
    map_coordinates(e, *t);
    varying made{dvec3(1), *t};
    if (is_float) // one number a texel, in each channel; scene files do not say that it was decoded
        made = baked(made, [](const dvec3& c) { return dvec3((c.x + c.y + c.z) / 3); });
    if (invert || scale > 1)
        made = baked(made, [&](const dvec3& c) { return invert ? 1.0 - scale * c : scale * c; });
    else
        made.factor *= scale;
    return made;
}

varying value_reader::checkerboard(const entity& e, bool is_float)
{
    if (e.parameters.whole("dimension", 2) != 2) {
        builder_.note(e.place, "a checkerboard in space: drawn as the mean of both colours");
        return {0.5 * (mean(input(e, "tex1", is_float, dvec3(1))) + mean(input(e, "tex2", is_float, dvec3(0)))), {}};
    }
    constexpr std::uint32_t side = 256; // of a square: its edge is as blurred as a 256th of it
    const auto first = input(e, "tex1", is_float, dvec3(1)), second = input(e, "tex2", is_float, dvec3(0));
    if (first.texture.map || second.texture.map)
        builder_.note(e.place, "a checkerboard of textures: drawn with the mean of each");
    const auto a = glm::clamp(mean(first), dvec3(0), dvec3(1)), b = glm::clamp(mean(second), dvec3(0), dvec3(1));
    photongrid::texture map{2 * side, 2 * side, {}};
    for (std::uint32_t row = 0; row < map.height; ++row)
        for (std::uint32_t column = 0; column < map.width; ++column) {
            // The lower left square has the first colour; rows go down.
            const bool is_first = (column < side) == (row >= side);
            const auto c = (is_first ? a : b) * 65535.0 + 0.5;
            map.texels.emplace_back(glm::u16vec4(c.x, c.y, c.z, 65535));
        }
    varying made{dvec3(1), {}};
    made.texture.map = std::make_shared<const photongrid::texture>(std::move(map));
    map_coordinates(e, made.texture);
    made.texture.scale *= 0.5; // a period is two squares
    made.texture.offset *= 0.5;
    return made;
}

/// `scale` and `mix`.
varying value_reader::mixed(const entity& e, bool is_float)
{
    auto first = input(e, e.type == "scale" ? "tex" : "tex1", is_float, dvec3(e.type == "scale" ? 1 : 0));
    auto second = input(e, e.type == "scale" ? "scale" : "tex2", e.type == "scale" || is_float, dvec3(1));
    const auto amount = e.type == "scale" ? dvec3(0) : mean(input(e, "amount", true, dvec3(0.5)));
    const auto of = [&](const dvec3& a, const dvec3& b) { return e.type == "scale" ? a * b : glm::mix(a, b, amount); };
    if (first.texture.map && second.texture.map) {
        builder_.note(e.place, "texture " + shown_word(e.type) + " of two textures: the mean of the second is used");
        second = {mean(second), {}};
    }
    if (second.texture.map)
        return baked(second, [&](const dvec3& b) { return of(first.factor, b); });
    if (e.type == "scale" && first.texture.map && is_in_range(first.factor * second.factor))
        return {first.factor * second.factor, first.texture};
    return baked(first, [&](const dvec3& a) { return of(a, second.factor); });
}

} // namespace photongrid::pbrt
