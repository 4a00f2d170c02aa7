#include <photongrid/io/mitsuba/values.hpp>
#include <photongrid/io/mitsuba/xml_values.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::mitsuba {

namespace {
    dvec3 texel_color(glm::u16vec4 texel) { return dvec3(texel.x, texel.y, texel.z) / 65535.0; }

    glm::u16vec4 texel_of(const dvec3& color)
    {
        const auto step = [](double c) { return c > 0 ? std::min(c, 1.0) * 65535 + 0.5 : 0; }; // 0 of what is no number
        return {step(color.x), step(color.y), step(color.z), 65535};
    }

    double luminance(const dvec3& c) { return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)); } // Rec. 709
} // namespace

varying changed(const varying& v, const std::function<dvec3(const dvec3&)>& change)
{
    auto made = v;
    made.factor = change(v.factor);
    if (!v.texture.map)
        return made;
    auto map = *v.texture.map;
    for (auto& t : map.texels)
        t = texel_of(change(v.factor * texel_color(t)));
    made.factor = dvec3(1);
    made.texture.map = std::make_shared<const photongrid::texture>(std::move(map));
    made.texture.file.clear(); // it is not what the file has any more
    return made;
}

dvec3 mean_of(const varying& v)
{
    if (!v.texture.map)
        return v.factor;
    dvec3 sum(0);
    for (const auto& t : v.texture.map->texels)
        sum += texel_color(t);
    return v.factor * sum / static_cast<double>(v.texture.map->texels.size());
}

varying value_reader::texture(const child& c, meaning m)
{
    const auto& o = *c.target;
    if (const auto before = textures_.find({&o, m}); before != textures_.end())
        return before->second;
    if (o.tag != "texture" && o.tag != "spectrum")
        fail_at(c.place, "found the " + o.said() + " as " + shown_word(c.name) + "; expected a texture");
    if (within_.size() > 100 || !within_.insert(&o).second)
        fail_at(c.place, "the texture is made of itself, or of more than 100 within each other");
    auto made = o.tag == "spectrum" ? spectrum_object(o, m) : made_texture(o, m);
    if (m == meaning::number && made.texture.map) // each channel has the number
        made = changed(made, [](const dvec3& color) { return dvec3(luminance(color)); });
    o.note_unused(builder_.log());
    within_.erase(&o);
    textures_.emplace(std::pair{&o, m}, made);
    return made;
}

/// `<spectrum type="...">` of Mitsuba 3.
varying value_reader::spectrum_object(const object& o, meaning m)
{
    if (o.type == "blackbody") {
        const double temperature = o.number("temperature", 0);
        if (!(temperature > 0))
            fail_at(o.place, o.said() + " lacks a temperature, K, above 0");
        property p{.is = property_kind::blackbody, .tag = o.tag, .name = o.type, .place = o.place};
        p.numbers = {temperature, o.number("scale", 1)};
        return {constant(p, m), {}};
    }
    if (o.type == "uniform" || o.type == "d65" || o.type == "srgb" || o.type == "rawconstant") {
        const auto* name = o.type == "srgb" || o.type == "d65" ? "color" : "value";
        const auto v = value(o, name, m).value_or(varying{});
        return {v.factor * o.number("scale", 1), {}};
    }
    if (o.type == "irregular" || o.type == "regular") {
        const auto values = numbers_of(o.place, o.text("values", ""));
        std::vector<double> wavelengths;
        if (o.type == "irregular") {
            wavelengths = numbers_of(o.place, o.text("wavelengths", ""));
        } else {
            const double low = o.number("wavelength_min", 360), high = o.number("wavelength_max", 830);
            for (std::size_t i = 0; i < values.size(); ++i)
                wavelengths.push_back(values.size() == 1
                        ? low
                        : low + (high - low) * static_cast<double>(i) / static_cast<double>(values.size() - 1));
        }
        return {of_samples(samples_of(o.place, std::move(wavelengths), values), m), {}};
    }
    builder_.note(o.place, o.said() + ": 0.5 in its place");
    return {dvec3(0.5), {}};
}

varying value_reader::made_texture(const object& o, meaning m)
{
    if (o.type == "bitmap")
        return bitmap(o, m);
    if (o.type == "checkerboard")
        return checkerboard(o, m);
    if (o.type == "scale")
        return scaled(o, m);
    if (o.type == "vertexcolors" || (o.type == "mesh_attribute" && o.text("name", "") == "vertex_color"))
        return {dvec3(o.number("scale", 1)), {}, true};
    builder_.note(o.place, o.said() + ": drawn as 0.5 everywhere");
    return {dvec3(0.5), {}};
}

/// In Mitsuba v = 0 is the first row of a picture, here v = 1, and surfaces get texture coordinates with v reversed.
void value_reader::map_coordinates(const object& o, texture_use& t)
{
    const double both = o.number("uvscale", 1); // of Mitsuba 0.6
    glm::dvec2 scale(o.number("uscale", both), o.number("vscale", both)),
        offset(o.number("uoffset", 0), o.number("voffset", 0));
    if (const auto* p = o.find("to_uv")) {
        const auto m = o.transform("to_uv");
        if (m[0][1] != 0 || m[1][0] != 0 || m[2][0] != 0 || m[2][1] != 0) {
            builder_.note(p->place, o.said() + ": \"to_uv\" that turns or skews is left out");
        } else {
            offset = scale * glm::dvec2(m[3]) + offset;
            scale *= glm::dvec2(m[0][0], m[1][1]);
        }
    }
    t.scale = scale;
    t.offset = {offset.x, 1 - scale.y - offset.y};
    const auto wrap = o.text("wrap_mode", "repeat"), wrap_u = o.text("wrap_mode_u", wrap),
               wrap_v = o.text("wrap_mode_v", wrap);
    if (wrap_u == "clamp")
        t.wrap = texture_wrap::clamp;
    if ((wrap_u != "repeat" && wrap_u != "clamp") || wrap_u != wrap_v)
        builder_.note(o.place,
            o.said() + ": wrap mode " + shown_word(wrap_u == "clamp" || wrap_u == "repeat" ? wrap_v : wrap_u)
                + ": drawn as " + (t.wrap == texture_wrap::clamp ? "\"clamp\"" : "\"repeat\""));
    try {
        check(t);
    } catch (const std::invalid_argument& e) {
        fail_at(o.place, e.what());
    }
}

varying value_reader::bitmap(const object& o, meaning)
{
    const auto* file = o.find("filename");
    const auto name = o.text("filename", "");
    if (file == nullptr)
        fail_at(o.place, o.said() + " lacks \"filename\"");
    for (const auto* only_speed : {"filter_type", "max_anisotropy", "cache", "format", "accel"}) // eye rays filter
        o.find(only_speed);
    bool raw = o.truth("raw", false);
    if (const auto gamma = o.number("gamma")) {
        raw = *gamma == 1;
        if (*gamma != 1 && *gamma != -1 && std::abs(*gamma - 2.2) > 1e-6)
            builder_.note(o.place, o.said() + ": its gamma: read as the file says");
    }
    varying made;
    auto t = builder_.texture(file->place, name, raw ? texture_holds::numbers : texture_holds::colour);
    if (t)
        made.texture = *t;
    else
        made.factor = dvec3(0.5);
    map_coordinates(o, made.texture);
    return made;
}

varying value_reader::checkerboard(const object& o, meaning m)
{
    constexpr std::uint32_t side = 256; // of a square: its edge is as blurred as a 256th of it
    const auto first = value(o, "color0", m).value_or(varying{dvec3(0.4), {}}),
               second = value(o, "color1", m).value_or(varying{dvec3(0.2), {}});
    if (first.texture.map || second.texture.map)
        builder_.note(o.place, o.said() + " of textures: drawn with the mean of each");
    const auto a = texel_of(mean_of(first)), b = texel_of(mean_of(second));
    photongrid::texture map{2 * side, 2 * side, {}};
    for (std::uint32_t row = 0; row < map.height; ++row)
        for (std::uint32_t column = 0; column < map.width; ++column)
            map.texels.push_back((column < side) == (row < side) ? a : b); // the first row is v = 0 in Mitsuba
    varying made;
    made.texture.map = std::make_shared<const photongrid::texture>(std::move(map));
    map_coordinates(o, made.texture);
    return made;
}

/// A texture of Mitsuba 0.6, times a colour.
varying value_reader::scaled(const object& o, meaning m)
{
    const auto scale = value(o, "scale", m).value_or(varying{});
    const auto inner = o.all_of("texture");
    auto v = !inner.empty() && inner[0]->name != "scale" ? texture(*inner[0], m)
                                                         : value(o, "value", m).value_or(varying{});
    if (scale.texture.map)
        builder_.note(o.place, o.said() + " by a texture: its mean is used");
    const auto by = mean_of(scale);
    if (v.texture.map && !(by.x <= 1 && by.y <= 1 && by.z <= 1))
        return changed(v, [&](const dvec3& c) { return by * c; });
    v.factor *= by;
    return v;
}

} // namespace photongrid::mitsuba
