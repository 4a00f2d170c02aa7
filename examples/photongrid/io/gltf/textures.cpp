#include <photongrid/io/gltf/textures.hpp>
#include <photongrid/io/gltf/uri.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::gltf {

namespace {
    /// The ways in which a texture goes on beyond its edges.
    enum wrap : std::size_t { clamp_to_edge = 33071, mirrored_repeat = 33648, repeat = 10497 };

    /// KHR_texture_transform: of a column (u, v, 1).
    glm::dmat3 transform_of(const part& info)
    {
        const auto t = info.extension("KHR_texture_transform");
        if (!t)
            return glm::dmat3(1);
        const auto offset = t->numbers<2>("offset", -1e6, 1e6).value_or(std::array{0.0, 0.0}),
                   scale = t->numbers<2>("scale", -1e6, 1e6).value_or(std::array{1.0, 1.0});
        const double angle = t->number("rotation", 0, -1e6, 1e6), c = std::cos(angle), s = std::sin(angle);
        return {dvec3(c * scale[0], -s * scale[0], 0), dvec3(s * scale[1], c * scale[1], 0),
            dvec3(offset[0], offset[1], 1)};
    }

    bool is_turned(const glm::dmat3& m) { return m[0][1] != 0 || m[1][0] != 0; }
} // namespace

std::optional<texture_use> texture_reader::texture(const part& of, std::string_view key, texture_holds holds)
{
    const auto info = of.object(key);
    if (!info)
        return std::nullopt;
    const auto index = info->index("index", "textures");
    if (!index)
        info->fail("a texture has an \"index\"");
    auto made = picture(*info, *index, holds);
    if (made)
        use_coordinates(*info, *made);
    return made;
}

std::optional<texture_use> texture_reader::picture(const part& info, std::size_t index, texture_holds holds)
{
    auto& builder = all_.builder();
    const auto t = all_.element("textures", index);
    const auto source = t.index("source", "images");
    if (!source) {
        builder.note(info.place(), owner_ + ": a texture in a format that photongrid does not read is left out");
        return std::nullopt;
    }
    const auto i = all_.element("images", *source);
    texture_use made;
    try {
        const auto uri = i.text("uri");
        const auto name = "data:image " + std::to_string(*source); // no file has this name, which "data:" would begin
        if (const auto data = uri ? data_of(i.at("uri"), *uri) : std::nullopt) {
            made.map = builder.files().texture_of(name, *data, holds);
        } else if (uri) {
            const auto file = builder.texture(i.at("uri").place(), file_name(*uri), holds);
            if (!file)
                return std::nullopt;
            made = *file;
        } else if (const auto view = i.index("bufferView", "bufferViews")) {
            const auto bytes = all_.view(*view);
            made.map = builder.files().texture_of(name, {bytes.data, bytes.size}, holds);
        } else {
            i.fail("an image has a \"uri\" or a \"bufferView\"");
        }
    } catch (const file_error& e) {
        builder.note(i.place(), std::string("0.5 in the place of a texture: ") + e.what());
        return std::nullopt;
    }
    if (const auto sampler = t.index("sampler", "samplers")) {
        const auto s = all_.element("samplers", *sampler);
        const auto across = s.whole("wrapS").value_or(repeat), down = s.whole("wrapT").value_or(repeat);
        if (across == mirrored_repeat || down == mirrored_repeat || across != down)
            builder.note(s.place(),
                owner_
                    + ": a texture that is mirrored beyond its edges, or continued differently in "
                      "both directions: it is repeated");
        else if (across == clamp_to_edge)
            made.wrap = texture_wrap::clamp;
    }
    return made;
}

void texture_reader::use_coordinates(const part& info, texture_use& t)
{
    auto transform = transform_of(info);
    const auto moved = info.extension("KHR_texture_transform");
    const auto set
        = (moved ? moved->whole("texCoord", 15) : std::nullopt).value_or(info.whole("texCoord", 15).value_or(0));
    if (!coordinates_.is_used) {
        coordinates_ = {set, is_turned(transform) ? transform : glm::dmat3(1), true};
    } else if (set != coordinates_.set) {
        all_.builder().note(info.place(),
            owner_ + ": a texture with another set of coordinates has those of TEXCOORD_"
                + std::to_string(coordinates_.set));
    }
    if (is_turned(coordinates_.transform)) { // vertices have turned coordinates then
        if (transform != coordinates_.transform)
            all_.builder().note(
                info.place(), owner_ + ": a texture is turned and scaled as the material's first one is");
        return;
    }
    if (is_turned(transform)) {
        all_.builder().note(info.place(), owner_ + ": the rotation of a texture is left out");
        const double across = glm::length(transform[0]), down = glm::length(transform[1]);
        transform[0] = dvec3(across, 0, 0);
        transform[1] = dvec3(0, down, 0);
    }
    // In the file v goes downwards, here upwards: 1 - (scale (1 - v) + offset).
    t.scale = {transform[0][0], transform[1][1]};
    t.offset = {transform[2][0], 1 - transform[1][1] - transform[2][1]};
}

channel_range channel_range_of(const texture& t, texture_channel channel)
{
    channel_range r;
    for (const auto& texel : t.texels) {
        const double v = texel[static_cast<int>(channel)] / 65535.0;
        r.low = std::min(r.low, v);
        r.high = std::max(r.high, v);
    }
    return r;
}

glm::dvec4 mean_of(const texture& t)
{
    glm::dvec4 sum(0);
    for (const auto& texel : t.texels)
        sum += glm::dvec4(texel) / 65535.0;
    return sum / static_cast<double>(t.texels.size());
}

} // namespace photongrid::gltf
