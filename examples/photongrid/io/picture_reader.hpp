// Reads the pictures of a scene file: environments and textures.
#pragma once

#include <photongrid/io/surface_reader.hpp>

namespace photongrid {

/// A scene file's values, and those that make a mesh, an environment or a texture.
class picture_reader : public surface_reader {
public:
    using surface_reader::surface_reader;

    /// The map and the rotation of an environment.
    void read_environment(const json_value& v, environment_light& l)
    {
        if (const auto* file = v.find("file")) {
            l.file = file_name(*file);
            l.map = from_file(*file, [&] { return files_.environment(l.file); });
        }
        if (const auto* rotate = v.find("rotate")) {
            const auto turn = turn_in(*rotate);
            l.axis = turn.axis;
            l.degrees = turn.degrees;
        }
    }

    /// A texture: the name of its file, or an object.
    texture_use texture_in(const json_value& v) { return texture_in(v, texture_holds::colour); }

    /// The same, of numbers in a channel.
    texture_use number_texture_in(const json_value& v) { return texture_in(v, texture_holds::numbers); }

private:
    texture_use texture_in(const json_value& v, texture_holds holds)
    {
        const auto texels_in
            = [&](const json_value& file) { return from_file(file, [&] { return files_.texture(file.text, holds); }); };
        texture_use t;
        if (v.kind != json_kind::object) {
            t.file = file_name(v);
            t.map = texels_in(v);
            return t;
        }
        open(v, holds == texture_holds::colour ? "texture" : "number_texture");
        t.file = file_name(at(v, "file"));
        t.map = texels_in(at(v, "file"));
        if (const auto* channel = v.find("channel")) {
            const auto& names = texture_channel_names;
            const auto& name = one_of(*channel, {names.begin(), names.end()});
            t.channel = static_cast<texture_channel>(std::find(names.begin(), names.end(), name) - names.begin());
        }
        if (const auto* wrap = v.find("wrap"))
            t.wrap = one_of(*wrap, {"repeat", "clamp"}) == "clamp" ? texture_wrap::clamp : texture_wrap::repeat;
        if (const auto* scale = v.find("scale"))
            t.scale = two(*scale);
        if (const auto* offset = v.find("offset"))
            t.offset = two(*offset);
        return t;
    }
};

} // namespace photongrid
