// Reads the pictures of a scene file: environments and textures.
#pragma once

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/surface_reader.hpp>

namespace photongrid {

/// A scene file's values, and those that make a mesh, an environment or a texture.
class picture_reader : public surface_reader {
public:
    using surface_reader::surface_reader;

    /// The map and the rotation of an environment.
    void read_environment(const json_value& v, environment_light& l) const
    {
        if (const auto* file = v.find("file")) {
            l.file = file_name(*file);
            l.map = map_in(l.file, *file);
        }
        if (const auto* rotate = v.find("rotate")) {
            const auto turn = turn_in(*rotate);
            l.axis = turn.axis;
            l.degrees = turn.degrees;
        }
    }

    /// A texture: the name of its file, or an object. A file that several materials name is read once.
    texture_use texture_in(const json_value& v) { return texture_in(v, holds::colour); }

    /// The same, of numbers in a channel.
    texture_use number_texture_in(const json_value& v) { return texture_in(v, holds::numbers); }

private:
    enum class holds { colour, numbers };

    texture_use texture_in(const json_value& v, holds what)
    {
        texture_use t;
        if (v.kind != json_kind::object) {
            t.file = file_name(v);
            t.map = texels_in(t.file, v, what);
            return t;
        }
        open(v, what == holds::colour ? "texture" : "number_texture");
        t.file = file_name(at(v, "file"));
        t.map = texels_in(t.file, at(v, "file"), what);
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

    static texture read_texture(const std::string& path, holds what)
    {
        const auto picture = read_channels(path);
        texture made{picture.width, picture.height, {}};
        made.texels.reserve(picture.pixels.size());
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const glm::vec4 p = what == holds::numbers ? picture.pixels[i] : glm::vec4(linear_pixel(picture, i), 1.0f);
            if (std::isnan(p.x) || std::isnan(p.y) || std::isnan(p.z) || std::isnan(p.w))
                throw std::invalid_argument("a pixel is not a number");
            made.texels.emplace_back(glm::vec4(0.5f) + glm::clamp(p, 0.0f, 1.0f) * 65535.0f);
        }
        return made;
    }

    std::shared_ptr<const texture> texels_in(const std::string& name, const json_value& v, holds what)
    {
        auto& map = textures_[{name, what}];
        if (!map) {
            try {
                auto made = read_texture(path_of(name), what);
                texture_use use;
                use.map = map = std::make_shared<const texture>(std::move(made));
                check(use);
            } catch (const file_error& e) {
                fail(v.place, e.what());
            } catch (const std::invalid_argument& e) {
                fail(v.place, path_of(name) + ": " + e.what());
            }
        }
        return map;
    }

    std::shared_ptr<const environment_map> map_in(const std::string& name, const json_value& v) const
    {
        try {
            auto picture = read_linear_image(path_of(name));
            environment_map map{picture.width, picture.height, std::move(picture.pixels)};
            check(map);
            return std::make_shared<const environment_map>(std::move(map));
        } catch (const file_error& e) {
            fail(v.place, e.what());
        } catch (const std::invalid_argument& e) {
            fail(v.place, path_of(name) + ": " + std::string(e.what()).substr(5)); // without "map: "
        }
    }

    /// By the names of their files and what they hold.
    std::map<std::pair<std::string, holds>, std::shared_ptr<const texture>> textures_;
};

} // namespace photongrid
